#include "toolkit/transfer/seams.h"

#include <random>

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include "tests/streams.h"
#include "tests/transfer/seamed_face.h"
#include "toolkit/transfer/gradient_system.h"
#include "toolkit/transfer/vertex_transfer.h"

/// Vertices that are one point of the surface.
namespace mimetra {
namespace {

using test::SeamedFace;
using test::Shape;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// More than one block of frames; the lips open in the second.
constexpr int kFrames = 20, kOpen = 17;

/// Solved with a condition number near 1e3 on faces 8 wide, by the same eliminations: what differs
/// is the order in which a dozen numbers are added at a vertex.
constexpr double kSameSolve = 1e-12;

class SeamTest : public testing::Test {
 protected:
  const SeamedFace face_;
  const MeshSequence whole_take_ = SeamedFace::talking(face_.whole, kFrames, kOpen);
  const MeshSequence take_ = face_.with_copies(whole_take_);
  const Shape whole_target_ = face_.bent(), target_ = face_.with_copies(whole_target_);
  const std::vector<int> all_ = all_triangles(face_.triangles);

  VertexTransferOptions welded(VertexTransferOptions options = {}) const {
    options.weld = closed_seams(take_, target_.positions);
    return options;
  }

  Frames transferred(const VertexTransferOptions& options, const Context& context = {}) const {
    return VertexTransfer(take_.rest(), target_.positions, face_.triangles, all_, options, context)
        .frames(take_, context);
  }

  /// Largest distance between two vertices that are copies of one.
  double gap(const Frames& frames) const {
    double largest = 0;
    for (std::size_t v = 0; v < face_.original.size(); ++v) {
      const auto difference =
          frames.middleCols<3>(3 * v) - frames.middleCols<3>(3 * face_.original[v]);
      largest = std::max(largest, difference.cwiseAbs().maxCoeff());
    }
    return largest;
  }

  /// Compares with the mesh that was welded by hand.
  void expect_whole(const std::vector<int>& selected, VertexTransferOptions options) const {
    const Frames expected =
        face_.with_copies(VertexTransfer(whole_take_.rest(), whole_target_.positions,
                                         face_.whole.triangles, selected, on_whole(options))
                              .frames(whole_take_));
    const Frames found = VertexTransfer(take_.rest(), target_.positions, face_.triangles, selected,
                                        welded(std::move(options)))
                             .frames(take_);
    EXPECT_LT((found - expected).lpNorm<Eigen::Infinity>(),
              kSameSolve * diameter(target_.positions));
    EXPECT_GT((found.row(0) - found.row(kOpen)).norm(), 0.1);
  }

 private:
  /// With the anchor of the mesh without copies; a vertex inside stands for its copies.
  VertexTransferOptions on_whole(VertexTransferOptions options) const {
    if (options.anchor_vertex >= 0) options.anchor_vertex = face_.original[options.anchor_vertex];
    if (!options.inside.empty()) options.inside.resize(SeamedFace::kVertices);
    return options;
  }
};

TEST_F(SeamTest, WeldsTheSeamAndNotTheLipsInMemoryAndOfAStream) {
  const Weld weld = closed_seams(take_, target_.positions);
  EXPECT_EQ(weld.representative, face_.original);
  EXPECT_EQ(weld.count, 10);
  const test::Stream stream(take_);
  for (const int threads : {1, 3}) {
    const Context context = Context().with_threads(threads);
    EXPECT_EQ(closed_seams(stream, target_.positions, context).representative, face_.original);
  }
}

TEST_F(SeamTest, WeldsLipsThatNeverOpen) {
  const MeshSequence silent = take_.slice(0, kOpen);
  const Weld weld = closed_seams(silent, target_.positions);
  EXPECT_EQ(weld.representative[SeamedFace::kUpperLip], SeamedFace::kLowerLip);
  EXPECT_EQ(weld.count, 13);
}

TEST_F(SeamTest, WeldsWithinTheToleranceInEveryFrame) {
  const double parted = kPartedShare * take_.diameter();
  Frames poses = take_.positions();
  poses.col(3 * 84) = poses.col(3 * face_.original[84]).array() + 0.9 * parted;
  poses(3, 3 * 85) += 1.1 * parted;
  const Weld weld = closed_seams(take_.with_frames(poses), target_.positions);
  EXPECT_EQ(weld.representative[84], face_.original[84]);
  EXPECT_EQ(weld.representative[85], 85);
}

TEST_F(SeamTest, WeldsWhatIsAtOnePlaceInOneRestPoseAndNearInTheOther) {
  const double at_source = kPartedShare * take_.diameter();
  const double at_target = kPartedShare * diameter(target_.positions);
  Positions source = take_.rest(), target = target_.positions;
  source(84, 0) += 0.9 * at_source;
  source(85, 0) += 1.1 * at_source;
  target(86, 0) += 0.9 * at_target;
  target(87, 0) += 1.1 * at_target;
  // Near in both, as neighbours of a fine mesh are.
  source(88, 0) += 0.1 * at_source;
  target(88, 0) += 0.1 * at_target;
  const Weld weld = closed_seams(take_.with_rest(source), target);
  for (const int v : {84, 86}) EXPECT_EQ(weld.representative[v], face_.original[v]) << v;
  for (const int v : {85, 87, 88}) EXPECT_EQ(weld.representative[v], v) << v;
  EXPECT_EQ(weld.count, 7);
}

TEST_F(SeamTest, FollowsTheSourcesOwnCornersWhereNoiseHoldsThemApart) {
  // Turned and made larger as a whole, triangles have that as their gradient wherever their corners
  // are.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  Positions rest = take_.rest();
  for (double& coordinate : rest.reshaped()) {
    coordinate += noise(random) * kPartedShare * take_.diameter();
  }
  const Eigen::Matrix3d turn =
      1.2 * Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Positions pose = rest * turn.transpose();
  Frames poses = take_.positions();
  poses.rowwise() = Eigen::RowVectorXd(pose.reshaped<Eigen::RowMajor>().transpose());
  const MeshSequence take = take_.with_frames(poses).with_rest(rest);
  VertexTransferOptions options;
  options.weld = closed_seams(take, target_.positions);
  EXPECT_GE(options.weld.count, 10);
  const Frames found =
      VertexTransfer(rest, target_.positions, face_.triangles, all_, options).frames(take);
  const Positions expected = target_.positions * turn.transpose();
  const Eigen::RowVector3d moved = found.row(0).head<3>() - expected.row(0);
  for (Eigen::Index v = 0; v < expected.rows(); ++v) {
    const Eigen::RowVector3d off = found.row(0).segment<3>(3 * v) - moved - expected.row(v);
    EXPECT_LT(off.norm(), 1e-9) << v;
  }
}

TEST_F(SeamTest, StaysAsFarOpenAsTheTargetIs) {
  Shape target = target_;
  target.positions(86, 0) += 0.5 * kPartedShare * diameter(target_.positions);
  VertexTransferOptions options;
  options.weld = closed_seams(take_, target.positions);
  const Frames found =
      VertexTransfer(take_.rest(), target.positions, face_.triangles, all_, options).frames(take_);
  const Eigen::Index other = face_.original[86];
  const Eigen::RowVector3d apart = target.positions.row(86) - target.positions.row(other);
  for (const auto& frame : found.rowwise()) {
    const Eigen::RowVector3d now = frame.segment<3>(3 * 86) - frame.segment<3>(3 * other);
    EXPECT_LT((now - apart).norm(), kSameSolve * diameter(target.positions));
  }
}

TEST_F(SeamTest, StaysClosedUnderTheNoiseOfATrackedScan) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.1 * kPartedShare * take_.diameter());
  Frames poses = take_.positions();
  for (double& coordinate : poses.reshaped()) coordinate += noise(random);
  Positions rest = take_.rest();
  for (double& coordinate : rest.reshaped()) coordinate += noise(random);
  const MeshSequence tracked = take_.with_frames(poses).with_rest(rest);
  VertexTransferOptions options;
  options.weld = closed_seams(tracked, target_.positions);
  EXPECT_EQ(options.weld.representative, face_.original);
  const Frames found =
      VertexTransfer(tracked.rest(), target_.positions, face_.triangles, all_, options)
          .frames(tracked);
  EXPECT_EQ(gap(found), 0);
}

TEST_F(SeamTest, DoesNotWeldAVertexOfNoTriangle) {
  Shape face = face_.with_copies(face_.whole);
  face.positions.conservativeResize(95, Eigen::NoChange);
  face.positions.row(94) = face.positions.row(4);
  const MeshSequence still = test::shaken(face, 1, 0);
  EXPECT_EQ(closed_seams(still, face.positions).representative[94], 94);
}

TEST_F(SeamTest, DoesNotWeldWhereNoTriangleHasArea) {
  Shape face = face_.whole;
  face.positions.setZero();
  EXPECT_EQ(closed_seams(test::shaken(face, 1, 0), face.positions).count, 0);
}

TEST_F(SeamTest, NeedsNoFrameOfAMeshWithoutDuplicates) {
  const test::Stream stream(test::shaken(test::patch(), 5, 0.2));
  EXPECT_EQ(closed_seams(stream, test::bent_patch().positions).count, 0);
  EXPECT_EQ(stream.frames_read(), 0);
}

TEST_F(SeamTest, OfATargetOfAnotherVertexCountIsRefused) {
  EXPECT_THAT([this] { closed_seams(take_, face_.whole.positions); },
              ThrowsMessage<MismatchError>("the source has 94 vertices, the target 84"));
}

TEST_F(SeamTest, StaysClosedInEveryFrame) {
  EXPECT_GT(gap(transferred({})), 0.01);
  EXPECT_EQ(gap(transferred(welded())), 0);
}

TEST_F(SeamTest, LetsLipsOpenAsTheSourcesDo) {
  VertexTransferOptions options;
  options.weld = closed_seams(take_, take_.rest());
  const Frames found =
      VertexTransfer(take_.rest(), take_.rest(), face_.triangles, all_, options).frames(take_);
  // As in VertexTransfer.NothingDriftsOnSeveralPieces.
  EXPECT_LT((found - take_.positions()).lpNorm<Eigen::Infinity>(), 1e-11);
  const auto opening = [&found](int f) {
    return (found.row(f).segment<3>(3 * SeamedFace::kUpperLip) -
            found.row(f).segment<3>(3 * SeamedFace::kLowerLip))
        .norm();
  };
  EXPECT_LT(opening(kOpen - 1), 1e-11);
  EXPECT_GT(opening(kOpen), 0.5);
}

TEST_F(SeamTest, MovesAsTheMeshWithoutDuplicates) {
  for (const TriangleWeight weight : choices<TriangleWeight>()) {
    VertexTransferOptions options;
    options.triangle_weight = weight;
    expect_whole(all_, options);
    expect_whole(test::half_of(face_.triangles), options);
  }
}

TEST_F(SeamTest, MovesAsTheMeshWithoutDuplicatesWithIdentityOutside) {
  for (const double smoothness : {0.0, 0.7}) {
    VertexTransferOptions options;
    options.outside = Outside::identity;
    options.outside_smoothness = smoothness;
    expect_whole(test::half_of(face_.triangles), options);
  }
}

TEST_F(SeamTest, MovesAsTheMeshWithoutDuplicatesInARegion) {
  const Regions regions = regions_from_vertices(94, face_.triangles,
                                                {{39, 40, 41, 48, 49, 50, 81, 82, 83, 88, 89, 90}});
  VertexTransferOptions options;
  options.inside = regions.inside;
  expect_whole(regions.triangles, options);
}

TEST_F(SeamTest, IsNoBorderOfAFloatingPiece) {
  for (const Anchor anchor : {Anchor::source_motion, Anchor::centroid, Anchor::vertex}) {
    VertexTransferOptions options;
    options.anchor = anchor;
    options.anchor_vertex = 86;  // a copy
    expect_whole(all_, options);
  }
}

TEST_F(SeamTest, ClosesAtThePinToo) {
  // The lowest vertex of the only piece is 4, which is one with 84.
  Triangles triangles(3, 3);
  triangles << 84, 5, 14, 84, 14, 85, 12, 13, 22;
  const VertexTransfer transfer(take_.rest(), target_.positions, triangles,
                                all_triangles(triangles), welded());
  const Frames found = transfer.frames(take_);
  EXPECT_EQ(gap(found), 0);
  EXPECT_GT((found.row(0).segment<3>(3 * 84) - found.row(1).segment<3>(3 * 84)).norm(), 0.01);
}

TEST(SeamOfADegenerateTriangle, TakesTheNeighboursBeyondIt) {
  const SeamedFace face;
  Shape whole = face.whole;
  for (int t = 0; t < whole.triangles.rows(); ++t) {
    // On the left of the seam, with an edge on it.
    if (whole.triangles(t, 1) != 58 || whole.triangles(t, 2) != 67) continue;
    whole.positions.row(whole.triangles(t, 0)) =
        (whole.positions.row(58) + whole.positions.row(67)) / 2;
  }
  const MeshSequence whole_take = SeamedFace::talking(whole, kFrames, kOpen);
  const MeshSequence take = face.with_copies(whole_take);
  const Positions target = face.bent().positions, cut_target = face.with_copies(target);
  const std::vector<int> all = all_triangles(whole.triangles);
  VertexTransferOptions options;
  options.weld = closed_seams(take, cut_target);
  const VertexTransfer transfer(take.rest(), cut_target, face.triangles, all, options);
  const VertexTransfer expected(whole_take.rest(), target, whole.triangles, all);
  EXPECT_EQ(transfer.degenerate_source_triangles(), 1);
  EXPECT_EQ(expected.degenerate_source_triangles(), 1);
  EXPECT_LT((transfer.frames(take) - face.with_copies(expected.frames(whole_take)))
                .lpNorm<Eigen::Infinity>(),
            kSameSolve * diameter(target));
}

TEST_F(SeamTest, AtTheRegionsBorderStaysWhereOneSideIsOutside) {
  VertexTransferOptions options;
  options.inside.assign(94, true);
  std::fill(options.inside.begin() + SeamedFace::kVertices, options.inside.end(), false);
  const VertexTransfer transfer(take_.rest(), target_.positions, face_.triangles, all_,
                                welded(options));
  const Frames found = transfer.frames(take_);
  EXPECT_EQ(gap(found), 0);
  for (const VertexIndex v : {4, 40, 84, 93}) {
    EXPECT_TRUE(transfer.fixed()[v]);
    EXPECT_EQ(found.row(kOpen).segment<3>(3 * v), target_.positions.row(v)) << v;
  }
  EXPECT_FALSE(transfer.fixed()[3]);
}

TEST_F(SeamTest, MovesWithTheSideThatHasSelectedTriangles) {
  std::vector<int> left;
  for (const int t : all_) {
    if (face_.triangles.row(t).maxCoeff() < 84 && take_.rest()(face_.triangles(t, 0), 0) <= 4) {
      left.push_back(t);
    }
  }
  VertexTransferOptions options;
  options.inside.assign(94, true);
  const VertexTransfer transfer(take_.rest(), target_.positions, face_.triangles, left,
                                welded(options));
  const Frames found = transfer.frames(take_);
  EXPECT_EQ(gap(found), 0);
  EXPECT_FALSE(transfer.fixed()[84]);
  EXPECT_TRUE(transfer.fixed()[8]);
}

/// The seam is stitched by triangles between its two sides.
class StitchedSeamTest : public SeamTest {
 protected:
  StitchedSeamTest() : stitched_(face_.triangles.rows() + 2, 3) {
    stitched_ << face_.triangles, Eigen::RowVector3i(13, 85, 22), Eigen::RowVector3i(85, 86, 13);
  }

  VertexTransfer transfer(const std::vector<int>& selected) const {
    return VertexTransfer(take_.rest(), target_.positions, stitched_, selected, welded());
  }

  Triangles stitched_;
};

TEST_F(StitchedSeamTest, DropsAndCountsItsTriangles) {
  const VertexTransfer stitched = transfer(all_triangles(stitched_));
  EXPECT_EQ(stitched.collapsed_triangles(), 2);
  EXPECT_EQ(stitched.degenerate_source_triangles(), 0);
  EXPECT_EQ(stitched.degenerate_target_triangles(), 0);
  EXPECT_EQ(stitched.frames(take_), transferred(welded()));
}

TEST_F(StitchedSeamTest, IsNotHeldByTrianglesThatAreNotSelected) {
  const VertexTransfer stitched = transfer(all_);
  EXPECT_EQ(stitched.collapsed_triangles(), 0);
  EXPECT_THAT(stitched.fixed(), testing::Each(false));
}

TEST_F(SeamTest, MovesTheSameByAnyNumberOfThreads) {
  const Frames one = transferred(welded(), Context().with_threads(1));
  EXPECT_EQ(transferred(welded(), Context().with_threads(3)), one);
}

TEST_F(SeamTest, ChangesNoByteWhereNothingCoincides) {
  VertexTransferOptions options;
  options.weld = closed_seams(whole_take_, whole_target_.positions);
  EXPECT_EQ(options.weld.count, 0);
  const auto with = [this](const VertexTransferOptions& given) {
    return VertexTransfer(whole_take_.rest(), whole_target_.positions, face_.whole.triangles, all_,
                          given)
        .frames(whole_take_);
  };
  EXPECT_EQ(with(options), with({}));
}

TEST_F(SeamTest, RefusesAWeldOfVerticesThatAreApart) {
  const auto refuses = [this](const Positions& source, const Positions& target) {
    EXPECT_THAT([&] { VertexTransfer(source, target, face_.triangles, all_, welded()); },
                ThrowsMessage<std::invalid_argument>(
                    "vertex 84 is welded to 4, which is at another place"));
  };
  Positions apart = take_.rest();
  apart(84, 2) += 1;
  refuses(apart, target_.positions);
  refuses(take_.rest(), apart);
}

TEST_F(SeamTest, RefusesAWeldOfAnotherVertexCount) {
  VertexTransferOptions options;
  options.weld = Weld::none(93);
  EXPECT_THAT([&] { transferred(options); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("a weld of 93 vertices for 94")));
}

/// Two triangles with a seam between them.
class SeamedPair : public testing::Test {
 protected:
  SeamedPair() : triangles_(2, 3) {
    triangles_ << 0, 1, 2, 3, 4, 5;
    weld_.representative[3] = 2;
    weld_.count = 1;
  }

  Triangles triangles_;
  Weld weld_ = Weld::none(6);
};

TEST_F(SeamedPair, IsOnePieceOfAsManyUnknownsAsPlaces) {
  const VertexUnknowns unknowns =
      number_unknowns(triangles_, {1, 1}, std::vector<bool>(6, false), weld_);
  ASSERT_EQ(unknowns.floating.size(), 1);
  EXPECT_THAT(unknowns.floating[0].vertices, ElementsAre(0, 1, 2, 4, 5));
  EXPECT_THAT(unknowns.floating[0].pin, ElementsAre(0));
  EXPECT_THAT(unknowns.of_vertex, ElementsAre(-1, 0, 1, 1, 2, 3));
  EXPECT_EQ(unknowns.count, 4);
}

TEST_F(SeamedPair, IsHeldByAFixedVertexBeyondTheSeam) {
  std::vector<bool> fixed(6, false);
  fixed[5] = true;
  const VertexUnknowns unknowns = number_unknowns(triangles_, {1, 1}, fixed, weld_);
  EXPECT_TRUE(unknowns.floating.empty());
  EXPECT_THAT(unknowns.of_vertex, ElementsAre(0, 1, 2, 2, 3, -1));
  EXPECT_FALSE(unknowns.held.empty());
}

TEST_F(SeamedPair, PinsBothSidesWhereTheLowestVertexIsOnTheSeam) {
  weld_ = Weld::none(6);
  weld_.representative[4] = 0;
  weld_.count = 1;
  const VertexUnknowns unknowns =
      number_unknowns(triangles_, {1, 1}, std::vector<bool>(6, false), weld_);
  ASSERT_EQ(unknowns.floating.size(), 1);
  EXPECT_THAT(unknowns.floating[0].vertices, ElementsAre(0, 1, 2, 3, 5));
  EXPECT_THAT(unknowns.floating[0].pin, ElementsAre(0, 4));
  EXPECT_THAT(unknowns.of_vertex, ElementsAre(-1, 0, 1, 2, -1, 3));
}

}  // namespace
}  // namespace mimetra
