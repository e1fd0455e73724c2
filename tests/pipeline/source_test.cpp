#include "toolkit/pipeline/source.h"

#include <cmath>

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"

namespace mimetra {
namespace {

using test::bare;
using test::frames_of;
using test::nodding;
using test::Noted;
using test::take;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

/// Coordinates of the patch are below 10 and rotations orthogonal: a motion there and back leaves a
/// few roundings of 1e-15.
constexpr double kRounding = 1e-13;

TEST(SourceRestPose, IsByDefaultTheNeutralWhereThatIsKnown) {
  Noted noted;
  const Source source = prepare_source(take(), {}, {}, noted.context());
  EXPECT_TRUE(source.sequence->rest() == take().rest());
  EXPECT_THAT(noted.notes, IsEmpty());
}

TEST(SourceRestPose, IsOtherwiseTheFirstFrameWithANote) {
  Noted noted;
  const MeshSequence sequence = bare(take());
  const Source source = prepare_source(sequence, {.name = "smile", .head_motion = HeadMotion::none},
                                       {}, noted.context());
  EXPECT_TRUE(source.sequence->rest() == sequence.frame(0));
  ASSERT_EQ(noted.notes.size(), 1U);
  EXPECT_EQ(noted.notes[0].topic, Topic::unknown_neutral);
  EXPECT_EQ(noted.notes[0].text,
            "smile: its neutral is not known, the first frame stands in for it");
}

TEST(SourceRestPose, IsTheOneThatIsAskedForIfItHasTheSourcesVertices) {
  const MeshSequence sequence = take();
  const Positions given = 1.5 * sequence.rest();
  EXPECT_TRUE(prepare_source(sequence, {.rest = SourceRest::neutral}).sequence->rest() ==
              sequence.rest());
  EXPECT_TRUE(prepare_source(sequence, {.rest = SourceRest::first}).sequence->rest() ==
              sequence.frame(0));
  EXPECT_TRUE(prepare_source(sequence, {.rest = SourceRest::mean}).sequence->rest() ==
              mean_pose(sequence));
  EXPECT_TRUE(prepare_source(sequence, {.rest = given}).sequence->rest() == given);
  EXPECT_THROW(prepare_source(sequence, {.rest = Positions(3, 3)}), std::invalid_argument);
}

TEST(SourceRestPose, IsNoNeutralThatNobodyKnows) {
  const auto prepare = [] {
    prepare_source(bare(take()), {.name = "smile", .rest = SourceRest::neutral});
  };
  EXPECT_EQ(test::topic_of(prepare), Topic::unknown_neutral);
  EXPECT_THAT(prepare, ThrowsMessage<MismatchError>("smile: its neutral is not known"));
}

/// As of another face: each vertex is elsewhere, by a tenth of the size.
Positions of_another_face(const Positions& rest) {
  Positions other = rest;
  const double size = 0.1 * (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    other.row(v) +=
        size * Eigen::RowVector3d(std::sin(7.0 * v), std::cos(5.0 * v), std::sin(3.0 * v));
  }
  return other;
}

TEST(SourceRestPose, OfAnotherFaceIsNoted) {
  const MeshSequence sequence = take(150);
  const Positions other = of_another_face(sequence.rest());
  const auto is_noted = [&](const SourceOptions& options) {
    Noted noted;
    prepare_source(sequence, options, {}, noted.context());
    return noted.has(Topic::other_rest);
  };
  EXPECT_TRUE(is_noted({.rest = other}));
  EXPECT_FALSE(is_noted({}));
  EXPECT_FALSE(is_noted({.rest = SourceRest::mean}));
  EXPECT_FALSE(is_noted({.rest = other, .model_driven = true}));
}

TEST(HeadMotion, IsLookedForOnlyWhereTheSourceMayHaveSome) {
  const auto taken_out = [](const MeshSequence& sequence, const SourceOptions& options = {}) {
    return prepare_source(sequence, options).head_motion.how;
  };
  EXPECT_EQ(taken_out(take()), "none");
  EXPECT_EQ(taken_out(bare(take()).slice(0, 1)), "none");
  EXPECT_EQ(taken_out(bare(take()), {.model_driven = true}), "none");
  EXPECT_EQ(taken_out(bare(take())), "stable");
  EXPECT_EQ(taken_out(take(), {.head_motion = HeadMotion::all}), "all");
  EXPECT_EQ(taken_out(bare(take()), {.head_motion = HeadMotion::none}), "none");
  // Whoever gives the neutral knows it.
  EXPECT_EQ(taken_out(bare(take()), {.rest = take().rest()}), "none");
  EXPECT_EQ(taken_out(bare(take()), {.rest = SourceRest::mean}), "stable");
  EXPECT_EQ(taken_out(bare(take()), {.rest = SourceRest::first}), "stable");
  EXPECT_EQ(taken_out(take(), {.rest = SourceRest::first}), "none");
}

TEST(HeadMotion, IsSaidWithItsReasonAndSize) {
  Noted noted;
  const MeshSequence moved = with_motion(bare(take()), nodding(8));
  const Source source = prepare_source(moved, {.name = "nod"}, {}, noted.context());
  EXPECT_EQ(source.head_motion.how, "stable");
  EXPECT_EQ(source.head_motion.why, "the neutral is not known");
  // From the first frame to the last, which nods by 0.7 radians; expressions move the fit a bit.
  EXPECT_NEAR(source.head_motion.angle, 0.7 * 180 / EIGEN_PI, 5);
  ASSERT_GE(noted.notes.size(), 2U);
  EXPECT_THAT(noted.notes[1].text, HasSubstr("nod: a head motion of up to"));
  EXPECT_EQ(prepare_source(take()).head_motion.why, "the neutral is known");
}

TEST(HeadMotion, ThatIsNotTakenOutIsNotedWhereTheHeadTurns) {
  Noted noted;
  const MeshSequence moved = with_motion(bare(take()), nodding(8));
  prepare_source(moved, {.rest = take().rest()}, {}, noted.context());
  EXPECT_TRUE(noted.has(Topic::turning_head));
  noted.notes.clear();
  prepare_source(bare(take()), {.rest = take().rest()}, {}, noted.context());
  prepare_source(moved, {.rest = take().rest(), .head_motion = HeadMotion::none}, {},
                 noted.context());
  EXPECT_FALSE(noted.has(Topic::turning_head));
}

TEST(HeadMotion, ThatIsNotTakenOutIsNotedWhereTheHeadSlidesOrHasAnotherSize) {
  const Positions rest = take().rest();
  const double size = take().diameter();
  Noted noted;
  const auto notes_of = [&](const Positions& given) {
    noted.notes.clear();
    prepare_source(bare(take()), {.name = "a take", .rest = given}, {}, noted.context());
    return noted.notes;
  };
  EXPECT_THAT(notes_of(rest), IsEmpty());
  notes_of(rest.rowwise() + Eigen::RowVector3d(size, 0, 0));
  EXPECT_TRUE(noted.has(Topic::turning_head));
  EXPECT_THAT(noted.notes.front().text, HasSubstr("a take: the head turns by up to"));
  ASSERT_EQ(notes_of(1.5 * rest).size(), 1U);
  EXPECT_THAT(noted.notes.front().text, HasSubstr("times as large as the rest pose"));
}

TEST(HeadMotion, IsMeasuredFromTheRestPoseThatIsGiven) {
  const RigidTransform turn = nodding(4).back();
  const MeshSequence still = take();
  const Positions turned = turn.apply(still.rest());
  const Source source =
      prepare_source(bare(still), {.rest = turned, .head_motion = HeadMotion::stable});
  // The frames stand as the given rest pose does.
  Positions expected = turn.apply(Positions(still.frame(3)));
  EXPECT_LT((FrameBlock(*source.sequence, 3, 1).frame(0) - expected).cwiseAbs().maxCoeff(), 0.1);
}

TEST(HeadMotion, IsTakenOutBeforeAMeanIsTaken) {
  const MeshSequence moved = with_motion(bare(take()), nodding(8));
  const Source source = prepare_source(moved, {.rest = SourceRest::mean});
  EXPECT_TRUE(source.sequence->rest() == mean_pose(align(moved).sequence));
}

TEST(HeadMotion, IsByDefaultTheOneOfWhatMovesLeast) {
  const MeshSequence moved = with_motion(bare(take()), nodding(8));
  const Source source = prepare_source(moved);
  EXPECT_TRUE(frames_of(source.sequence) == align(moved).sequence.positions());
  EXPECT_TRUE(frames_of(source.given) == moved.positions());
}

TEST(HeadMotion, ThatIsGivenIsTakenOutAndGivenBack) {
  const MeshSequence still = take();
  const MeshSequence moved = with_motion(still, nodding(8));
  const Source source = prepare_source(moved, {.head_motion = nodding(8)});
  EXPECT_LT((frames_of(source.sequence) - still.positions()).cwiseAbs().maxCoeff(), kRounding);
  const auto back = with_head_motion(source.sequence, source.motion);
  EXPECT_LT((frames_of(back) - moved.positions()).cwiseAbs().maxCoeff(), kRounding);
}

TEST(HeadMotion, ThatIsGivenBackLeavesNoNeutral) {
  const auto still = std::make_shared<const MeshSequence>(take());
  EXPECT_TRUE(still->rest_is_known());
  EXPECT_FALSE(with_head_motion(still, nodding(8))->rest_is_known());
}

/// A patch that ripples everywhere; its left half keeps still where `half_is_still`.
MeshSequence rippling(bool half_is_still) {
  const MeshSequence sequence = take();
  const Positions& rest = sequence.rest();
  const double middle = rest.col(0).mean();
  Frames frames = sequence.positions();
  for (int f = 0; f < frames.rows(); ++f) {
    for (int v = 0; v < rest.rows(); ++v) {
      const double move = half_is_still && rest(v, 0) < middle
                              ? 0
                              : std::sin(f + rest(v, 0)) + std::cos(0.5 * f * rest(v, 1));
      frames.row(f).segment<3>(3 * v) = rest.row(v) + 0.3 * move * Eigen::RowVector3d(0.3, 0.2, 1);
    }
  }
  return bare(sequence.with_frames(frames));
}

TEST(HeadMotion, ThatNoVertexIsStillEnoughToTellIsNoted) {
  const auto prepared = [](const MeshSequence& sequence, Noted& noted) {
    const SourceOptions options{
        .name = "wave", .rest = take().rest(), .head_motion = HeadMotion::stable};
    return prepare_source(sequence, options, {}, noted.context()).head_motion;
  };
  Noted moving, still;
  EXPECT_TRUE(prepared(rippling(false), moving).is_uncertain());
  ASSERT_TRUE(moving.has(Topic::uncertain_motion));
  EXPECT_THAT(moving.notes.back().text, HasSubstr("wave: no vertex is still enough"));
  const HeadMotionTaken taken = prepared(rippling(true), still);
  EXPECT_FALSE(taken.is_uncertain());
  // Half of the patch locks the fit; kLeastWeight leaves 1e-10 of the motion.
  EXPECT_LT(*taken.stillest, 1e-8);
  EXPECT_FALSE(still.has(Topic::uncertain_motion));
}

TEST(HeadMotion, IsFoundJointlyWhereThatPredictsTwiceAsWell) {
  const auto prepared = [](double of_stable, std::optional<HeadMotion> asked, Noted& noted) {
    SourceOptions options{.rest = SourceRest::first};
    if (asked) options.head_motion = *asked;
    const JointSearch joint = [of_stable](const Source& source, const Context&) {
      return JointMotion{nodding(source.sequence->frames()), HeldOutErrors{of_stable, 0.01}};
    };
    return prepare_source(rippling(false), options, joint, noted.context()).head_motion;
  };
  Noted noted;
  EXPECT_EQ(prepared(0.021, {}, noted).how, "joint");
  EXPECT_TRUE(noted.has(Topic::joint_motion));
  EXPECT_FALSE(noted.has(Topic::uncertain_motion));
  noted.notes.clear();
  EXPECT_EQ(prepared(0.019, {}, noted).how, "stable");
  EXPECT_TRUE(noted.has(Topic::uncertain_motion));
  EXPECT_EQ(prepared(0.021, HeadMotion::stable, noted).how, "stable");
  EXPECT_EQ(prepared(0.001, HeadMotion::joint, noted).how, "joint");
}

TEST(HeadMotion, IsNotFoundJointlyWithoutExpressions) {
  const auto prepare = [] { prepare_source(take(), {.head_motion = HeadMotion::joint}); };
  EXPECT_EQ(test::topic_of(prepare), Topic::no_joint_motion);
}

TEST(HeadMotion, OfAnotherNumberOfFramesIsRefused) {
  EXPECT_THROW(prepare_source(take(), {.head_motion = nodding(3)}), MismatchError);
}

}  // namespace
}  // namespace mimetra
