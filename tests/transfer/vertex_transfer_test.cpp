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

TEST(VertexTransfer, NamesTheOptionThatIsOutOfRange) {
  const Shape shape = patch();
  const auto with = [&shape](const VertexTransferOptions& options) {
    return [&shape, options] {
      VertexTransfer(shape.positions, shape.positions, shape.triangles,
                     all_triangles(shape.triangles), options);
    };
  };
  const auto names = [](const char* message) {
    return testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr(message));
  };
  EXPECT_THAT(with({.outside_weight = 0}), names("outside_weight is 0; it must be at least 1e-12"));
  EXPECT_THAT(with({.outside_smoothness = -1}),
              names("outside_smoothness is -1; it must be at least 0"));
  EXPECT_THAT(with({.inside = std::vector<bool>(80, true)}),
              names("inside: expected one entry for each of 81 vertices, found 80"));
  EXPECT_THAT(with({.anchor = Anchor::vertex, .anchor_vertex = 81}),
              names("anchor vertex 81: expected 0 to 80"));
}

TEST(VertexTransfer, RefusesTrianglesAndPerformancesOfOtherMeshes) {
  const Shape shape = patch();
  const Positions other = test::grid(3, 3).positions;
  const auto onto = [&shape](const Positions& source, const std::vector<int>& selected) {
    return VertexTransfer(source, shape.positions, shape.triangles, selected);
  };
  EXPECT_THAT([&] { onto(other, {0}); }, testing::ThrowsMessage<MismatchError>(testing::HasSubstr(
                                             "the source has 9 vertices, the target 81")));
  EXPECT_THAT([&] { onto(shape.positions, {128}); },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::HasSubstr("triangle 128 is selected, expected 0 to 127")));
  EXPECT_THROW(onto(shape.positions, {0}).frames(test::shaken(test::grid(3, 3), 1, 0.1)),
               MismatchError);
}

TEST(VertexTransfer, StopsWhenAsked) {
  const Shape shape = patch();
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles,
                                all_triangles(shape.triangles));
  const Context cancelled = Context().with_progress([](double) { return false; });
  EXPECT_THROW(transfer.frames(test::shaken(shape, 2, 0.1), cancelled), Cancelled);
}

}  // namespace
}  // namespace mimetra
