#include "toolkit/pipeline/solve.h"

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "tests/streams.h"
#include "tests/transfer/seamed_face.h"

namespace mimetra {
namespace {

using test::Noted;
using test::take;
using testing::HasSubstr;
using testing::ThrowsMessage;

class SolveTest : public testing::Test {
 protected:
  const Source source_ = prepare_source(take());
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const BlendshapeModel mesh_{actor_.shared_connectivity(),
                              actor_.neutral(),
                              {{}, Eigen::MatrixXd(3 * actor_.vertices(), 0)}};
  Selection some_{test::half_of(actor_.triangles()), std::vector<bool>(81, true)};
  SolveOptions options_;
};

TEST_F(SolveTest, LooksForWeightsWhereTheTargetHasExpressions) {
  EXPECT_EQ(solve(source_, {"actor", actor_}, some_).weights().cols(), 5);
  EXPECT_EQ(solve(source_, {"mesh", mesh_}, some_).weights().size(), 0);
  options_.space = Space::vertex;
  EXPECT_EQ(solve(source_, {"actor", actor_}, some_, options_).weights().size(), 0);
}

TEST_F(SolveTest, HasTheTargetsNeutralAsRestAndTheSourcesTimes) {
  const auto result = solve(source_, {"mesh", mesh_}, some_).sequence;
  EXPECT_TRUE(result->rest() == mesh_.neutral());
  EXPECT_TRUE(result->times() == source_.sequence->times());
}

TEST_F(SolveTest, RefusesWeightsOfATargetWithoutExpressions) {
  options_.space = Space::blendshape;
  const auto work = [this] { solve(source_, {"mesh", mesh_}, some_, options_); };
  EXPECT_EQ(test::topic_of(work), Topic::no_expressions);
  EXPECT_THAT(work, ThrowsMessage<MismatchError>("mesh: has no expressions"));
}

TEST_F(SolveTest, RefusesAnAnchorThatTheMeshDoesNotHave) {
  options_.anchor = Anchor::vertex;
  options_.anchor_vertex = 81;
  const auto work = [this] { solve(source_, {"mesh", mesh_}, whole(*source_.sequence), options_); };
  EXPECT_EQ(test::topic_of(work), Topic::anchor_vertex);
}

TEST_F(SolveTest, RefusesAnAnchorWhereFixedVerticesHoldTheMesh) {
  for (const Anchor anchor : {Anchor::source_motion, Anchor::centroid}) {
    options_.anchor = anchor;
    EXPECT_EQ(test::topic_of([this] {
                solve(source_, {"mesh", mesh_}, some_, options_);
              }),
              Topic::held_anchor);
  }
}

TEST_F(SolveTest, TakesAnAnchorWhereNothingIsFixed) {
  options_.anchor = Anchor::centroid;
  EXPECT_NO_THROW(solve(source_, {"mesh", mesh_}, whole(*source_.sequence), options_));
  options_.outside = Outside::identity;
  EXPECT_NO_THROW(solve(source_, {"mesh", mesh_}, some_, options_));
}

TEST_F(SolveTest, NotesExpressionsThatTheTrianglesDoNotShow) {
  Noted noted;
  const VertexIndex corner = 0;
  Selection few;
  for (int t = 0; t < actor_.triangles().rows(); ++t) {
    if ((actor_.triangles().row(t).array() == corner).any()) few.triangles.push_back(t);
  }
  ShapeBasis two = test::bumps(actor_.neutral(), 1);
  two.names.push_back("corner");
  two.displacements.conservativeResize(Eigen::NoChange, 2);
  two.displacements.col(1).setZero();
  two.displacements(3 * corner + 2, 1) = 1;
  two.displacements.col(0).head(3 * 20).setZero();
  const BlendshapeModel model(actor_.shared_connectivity(), actor_.neutral(), two);
  solve(source_, {"actor", model}, few, options_, noted.context());
  ASSERT_FALSE(noted.notes.empty());
  EXPECT_EQ(noted.notes[0].text,
            "actor: 1 expressions do not move in the regions and stay 0: shape0");
}

TEST_F(SolveTest, NotesVerticesThatNoTriangleMoves) {
  const Source loose =
      prepare_source(test::with_loose_vertex(take()), {.head_motion = HeadMotion::none});
  const BlendshapeModel mesh(loose.sequence->shared_connectivity(), loose.sequence->rest(),
                             {{}, Eigen::MatrixXd(3 * 82, 0)});
  Noted noted;
  const Solution solution =
      solve(loose, {"mesh", mesh}, whole(*loose.sequence), options_, noted.context());
  EXPECT_THAT(
      noted.notes.front().text,
      "mesh: 1 vertices of no triangle, the first is vertex 81, stay where they are at rest");
  EXPECT_EQ(FrameBlock(*solution.sequence, 3, 1).frame(0).row(81), mesh.neutral().row(81));
}

TEST_F(SolveTest, NotesExpressionsThatLookAlike) {
  ShapeBasis twins = test::bumps(actor_.neutral(), 2);
  // Differences of 1e-4 make a condition number of about 1e8.
  twins.displacements.col(1) = twins.displacements.col(0) + 1e-4 * twins.displacements.col(1);
  const BlendshapeModel model(actor_.shared_connectivity(), actor_.neutral(), twins);
  Noted noted;
  solve(source_, {"twins", model}, whole(*source_.sequence), options_, noted.context());
  EXPECT_TRUE(noted.has(Topic::poor_condition));
}

TEST_F(SolveTest, NotesARestPoseThatIsNotNeutral) {
  const auto performance = source_.sequence;
  const BlendshapeModel model = test::model_on(test::patch(), 5);
  const Source wrong{performance, with_rest(performance, model.pose(Eigen::VectorXd::Ones(5))), {}};
  Noted noted;
  solve(wrong, {"actor", model}, whole(*performance), options_, noted.context());
  EXPECT_TRUE(noted.has(Topic::unneutral_rest));
  noted.notes.clear();
  Source known = wrong;
  known.neutral_is_known = true;
  solve(known, {"actor", model}, whole(*performance), options_, noted.context());
  EXPECT_FALSE(noted.has(Topic::unneutral_rest));
  solve(source_, {"actor", model}, whole(*performance), options_, noted.context());
  EXPECT_FALSE(noted.has(Topic::unneutral_rest));
}

/// A face with a seam, in vertex space.
class SeamedSolveTest : public testing::Test {
 protected:
  static constexpr int kFrames = 20;

  const test::SeamedFace face_;
  const MeshSequence take_ =
      face_.with_copies(test::SeamedFace::talking(face_.whole, kFrames, kFrames - 3));
  const test::Shape target_ = face_.with_copies(face_.bent());

  static BlendshapeModel mesh(const test::Shape& shape) {
    return {test::connectivity_of(shape),
            shape.positions,
            {{}, Eigen::MatrixXd(shape.positions.size(), 0)}};
  }

  void expect_closed(const std::shared_ptr<const FrameSource>& result) const {
    const Frames frames = test::frames_of(result);
    for (std::size_t v = 0; v < face_.original.size(); ++v) {
      EXPECT_EQ(frames.middleCols<3>(3 * v), frames.middleCols<3>(3 * face_.original[v])) << v;
    }
    EXPECT_GT((frames.row(0) - frames.row(1)).norm(), 0.1);
  }
};

TEST_F(SeamedSolveTest, LeavesNoGap) {
  const BlendshapeModel target = mesh(target_);
  const Source source = prepare_source(take_);
  expect_closed(solve(source, {"mesh", target}, whole(take_)).sequence);
  const Regions regions = regions_from_vertices(94, face_.triangles, {{40, 41, 82, 83, 88, 89}});
  expect_closed(solve(source, {"mesh", target}, selection_of(regions)).sequence);
}

TEST_F(SeamedSolveTest, LeavesNoGapWhereTheHeadMoves) {
  const BlendshapeModel target = mesh(target_);
  const MeshSequence moved = with_motion(test::bare(take_), test::nodding(kFrames));
  for (const RemovedMotion removed : choices<RemovedMotion>()) {
    TransferOptions options{.full = true, .head_motion = removed};
    options.source.head_motion = test::nodding(kFrames);
    expect_closed(transfer(moved, {{"mesh", target}}, options).targets[0].solution.sequence);
  }
}

TEST_F(SeamedSolveTest, IsTheSameOfAStreamByAnyNumberOfThreads) {
  const BlendshapeModel target = mesh(target_);
  const Selection all = whole(take_);
  const Frames expected =
      test::frames_of(solve(prepare_source(take_), {"mesh", target}, all).sequence);
  for (const int threads : {1, 3}) {
    const Source source = prepare_source(test::streamed(take_));
    const Solution found =
        solve(source, {"mesh", target}, all, {}, Context().with_threads(threads));
    EXPECT_TRUE(test::frames_of(found.sequence) == expected) << threads;
  }
}

TEST_F(SeamedSolveTest, NotesAndCountsTrianglesThatCollapse) {
  test::Shape stitched{target_.positions, Triangles(face_.triangles.rows() + 1, 3)};
  stitched.triangles << face_.triangles, Eigen::RowVector3i(13, 85, 22);
  const BlendshapeModel target = mesh(stitched);
  const MeshSequence take(target.shared_connectivity(), take_.positions(), {}, take_.rest());
  Noted noted;
  const Solution found =
      solve(prepare_source(take), {"mesh", target}, whole(take), {}, noted.context());
  EXPECT_EQ(found.collapsed_triangles, 1);
  EXPECT_EQ(found.degenerate_source_triangles, 0);
  EXPECT_EQ(found.degenerate_target_triangles, 0);
  ASSERT_EQ(noted.notes.size(), 1);
  EXPECT_EQ(noted.notes[0].text,
            "mesh: 1 triangles between vertices that a seam makes one take no part");
}

}  // namespace
}  // namespace mimetra
