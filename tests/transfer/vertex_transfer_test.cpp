#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

using test::bent_patch;
using test::only_frame;
using test::patch;
using test::Shape;

TEST(VertexTransfer, OntoTheSameMeshGivesTheSourceBack) {
  const Shape shape = patch();
  const MeshSequence take = test::shaken(shape, 5, 0.2);
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles,
                                all_triangles(shape.triangles));
  EXPECT_LT((transfer.frames(take) - take.positions()).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(VertexTransfer, KeepsVerticesOutsideTheRegionsBitByBit) {
  const Shape source = patch(), target = bent_patch();
  const MeshSequence take = test::shaken(source, 3, 0.3);
  const Regions regions = regions_from_vertices(81, source.triangles, {{40, 41, 10}, {70}});
  VertexTransferOptions options;
  options.inside = regions.inside;
  const Frames frames = VertexTransfer(source.positions, target.positions, source.triangles,
                                       regions.triangles, options)
                            .frames(take);
  for (int f = 0; f < 3; ++f) {
    const PositionsView pose(frames.row(f).data(), 81, 3);
    for (int v = 0; v < 81; ++v) {
      if (regions.inside[v]) continue;
      EXPECT_EQ(pose.row(v), target.positions.row(v)) << v;
    }
  }
  EXPECT_GT((frames.row(0) - frames.row(1)).norm(), 0.01);
}

TEST(VertexTransfer, OfTheRestPoseIsTheTargetsRestPose) {
  const Shape source = patch();
  const Positions target = bent_patch().positions;
  const VertexTransfer transfer(source.positions, target, source.triangles,
                                all_triangles(source.triangles));
  EXPECT_EQ(only_frame(transfer.frames(test::shaken(source, 1, 0))), target);
}

TEST(VertexTransfer, ScalesWithTheTarget) {
  const Shape source = patch();
  const MeshSequence take = test::shaken(source, 1, 0.2);
  const Positions target = bent_patch().positions;
  const auto all = all_triangles(source.triangles);
  VertexTransferOptions options;
  options.anchor = Anchor::centroid;
  const auto onto = [&](const Positions& rest) {
    return Positions(
        only_frame(
            VertexTransfer(source.positions, rest, source.triangles, all, options).frames(take)) -
        rest);
  };
  EXPECT_LT((onto(100 * target) - 100 * onto(target)).lpNorm<Eigen::Infinity>(), 1e-10);
}

TEST(VertexTransfer, GivesFramesThatDoNotDependOnTheirNumber) {
  const Shape shape = patch();
  const MeshSequence take = test::shaken(shape, 20, 0.2);  // more than one block of frames
  const VertexTransfer transfer(shape.positions, bent_patch().positions, shape.triangles,
                                all_triangles(shape.triangles));
  EXPECT_EQ(transfer.frames(take).row(18), transfer.frames(take.slice(18, 19)).row(0));
}

TEST(VertexTransfer, LeavesTheRestPoseAloneWithSmoothnessOutside) {
  const Shape source = patch(), target = bent_patch();
  const MeshSequence still = test::shaken(source, 1, 0);
  VertexTransferOptions options;
  options.outside = Outside::identity;
  options.outside_smoothness = 10;
  const VertexTransfer transfer(source.positions, target.positions, source.triangles,
                                test::half_of(source.triangles), options);
  EXPECT_EQ(only_frame(transfer.frames(still)), target.positions);
}

TEST(VertexTransfer, IsFiniteWithDegenerateTriangles) {
  Shape source = patch(), target = bent_patch();
  source.positions.row(source.triangles(60, 2)) = source.positions.row(source.triangles(60, 0));
  target.positions.row(target.triangles(20, 2)) = target.positions.row(target.triangles(20, 0));
  const MeshSequence take = test::shaken(source, 2, 0.1);
  const VertexTransfer transfer(source.positions, target.positions, source.triangles,
                                all_triangles(source.triangles));
  EXPECT_GT(transfer.degenerate_source_triangles(), 0);
  EXPECT_GT(transfer.degenerate_target_triangles(), 0);
  const Frames frames = transfer.frames(take);
  EXPECT_TRUE(frames.allFinite());
  EXPECT_LT(frames.cwiseAbs().maxCoeff(), 50);  // the patch is 8 wide and moves by 0.1
}

TEST(VertexTransfer, IsChangedLittleByANeedleInTheSource) {
  Shape source = patch();
  const auto corners = source.triangles.row(60);
  const Eigen::RowVector3d middle =
      (source.positions.row(corners[0]) + source.positions.row(corners[1])) / 2;
  Shape needle = source;
  needle.positions.row(corners[2]) = middle + 1e-9 * (source.positions.row(corners[2]) - middle);
  const MeshSequence take = test::shaken(needle, 1, 0.01);
  const VertexTransfer transfer(needle.positions, source.positions, source.triangles,
                                all_triangles(source.triangles));
  EXPECT_GE(transfer.degenerate_source_triangles(), 1);
  // The other triangles change by a hundredth of an edge; 1 / 1e-9 of that would be 1e7.
  EXPECT_LT((only_frame(transfer.frames(take)) - source.positions).lpNorm<Eigen::Infinity>(), 0.5);
}

TEST(VertexTransfer, KeepsVerticesThatOnlyDegenerateTargetTrianglesHold) {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 3, 4, 5;
  Shape source{Positions(6, 3), triangles};
  source.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 3, 0, 0, 4, 0, 0, 3, 1, 0;
  Positions target = source.positions;
  target.row(5) << 3.5, 0, 0;
  const VertexTransfer transfer(source.positions, target, triangles, {0, 1});
  const Positions found = only_frame(transfer.frames(test::shaken(source, 1, 0.2)));
  EXPECT_EQ(transfer.degenerate_target_triangles(), 1);
  EXPECT_EQ(found.bottomRows(3), target.bottomRows(3));
}

class VertexTransferRefusal : public testing::Test {
 protected:
  const Shape shape_ = patch();
  const std::vector<int> all_ = all_triangles(shape_.triangles);
  VertexTransferOptions options_;

  template <typename Error>
  void expect(const char* message) const {
    EXPECT_THAT(
        [this] {
          VertexTransfer(shape_.positions, shape_.positions, shape_.triangles, all_, options_);
        },
        testing::ThrowsMessage<Error>(testing::HasSubstr(message)));
  }
};

TEST_F(VertexTransferRefusal, NamesBothVertexCounts) {
  EXPECT_THAT(
      [this] {
        VertexTransfer(test::grid(3, 3).positions, shape_.positions, shape_.triangles, all_);
      },
      testing::ThrowsMessage<MismatchError>(
          testing::HasSubstr("the source has 9 vertices, the target 81")));
}

TEST_F(VertexTransferRefusal, NamesAnOutsideWeightOfZero) {
  options_.outside_weight = 0;
  expect<std::invalid_argument>("outside_weight is 0; it must be at least 1e-12");
}

TEST_F(VertexTransferRefusal, NamesANegativeSmoothness) {
  options_.outside_smoothness = -1;
  expect<std::invalid_argument>("outside_smoothness is -1; it must be at least 0");
}

TEST_F(VertexTransferRefusal, NamesTheLengthOfInside) {
  options_.inside.assign(80, true);
  expect<std::invalid_argument>("inside: expected one entry for each of 81 vertices, found 80");
}

TEST_F(VertexTransferRefusal, NamesAnAnchorOutOfRange) {
  options_.anchor = Anchor::vertex;
  options_.anchor_vertex = 81;
  expect<std::invalid_argument>("anchor vertex 81: expected 0 to 80");
}

TEST_F(VertexTransferRefusal, NamesATriangleOutOfRange) {
  EXPECT_THAT(
      [this] { VertexTransfer(shape_.positions, shape_.positions, shape_.triangles, {128}); },
      testing::ThrowsMessage<std::invalid_argument>(
          testing::HasSubstr("triangle 128 is selected, expected 0 to 127")));
}

TEST_F(VertexTransferRefusal, HoldsForPerformancesOfOtherMeshes) {
  const VertexTransfer transfer(shape_.positions, shape_.positions, shape_.triangles, all_);
  EXPECT_THROW(transfer.frames(test::shaken(test::grid(3, 3), 1, 0.1)), MismatchError);
}

TEST(VertexTransfer, StopsWhenAsked) {
  const Shape shape = patch();
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles,
                                all_triangles(shape.triangles),
                                {.progress = [](double) { return false; }});
  EXPECT_THROW(transfer.frames(test::shaken(shape, 2, 0.1)), Cancelled);
}

}  // namespace
}  // namespace mimetra
