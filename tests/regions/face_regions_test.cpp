#include <algorithm>
#include <set>

#include <gmock/gmock.h>

#include "tests/mesh/captured_performance.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/regions/regions.h"

/// Regions with distances along the surface, from decomposition to the triangles.
namespace mimetra::test {
namespace {

/// rest + a lift around vertex `center`, back and forth in 6 frames.
MeshSequence lifted_around(const Shape& shape, const Eigen::RowVector3d& center) {
  const TriMesh mesh = mesh_of(shape);
  const Eigen::Map<const Eigen::RowVectorXd> rest(shape.positions.data(), shape.positions.size());
  Frames frames = rest.replicate(6, 1);
  for (int f = 0; f < 6; ++f) {
    for (int v = 0; v < shape.positions.rows(); ++v) {
      const double distance = (shape.positions.row(v) - center).norm();
      frames(f, 3 * v + 2) += std::max(0.0, 1 - distance / 2) * std::sin(f);
    }
  }
  return {mesh.connectivity, std::move(frames), {}, shape.positions};
}

TEST(RegionsAlongASurface, PassAWeldedSeam) {
  // Two grids that meet in the column x = 8; both have vertices there.
  const Shape left = grid(9, 9);
  Shape right = left;
  right.positions.col(0).array() += 8;
  const Shape shape = both(left, right);
  const MeshSequence sequence = lifted_around(shape, {7, 4, 0});
  const Components components = decompose(sequence, {.count = 1});
  const Regions regions = find_regions(components, {.radius = 3});
  // (9, 4) lies on the right grid, two away from the centre (7, 4) on the left one.
  EXPECT_EQ(components.centers[0], 4 * 9 + 7);
  EXPECT_TRUE(regions.inside[81 + 4 * 9 + 1]);
}

TEST(RegionsAlongASurface, DoNotReachAnotherSurfaceNearby) {
  const Shape lower = grid(9, 9);
  Shape upper = lower;
  upper.positions.col(2).array() += 0.1;
  const Shape shape = both(lower, upper);
  const MeshSequence sequence = lifted_around(shape, {4, 4, -0.1});
  const Regions regions = find_regions(decompose(sequence, {.count = 1}), {.radius = 3});
  for (int v = 81; v < 162; ++v) EXPECT_FALSE(regions.inside[v]);
}

/// The facecap head: 17 components (head, eyes, teeth), UV seams.
TEST(FacecapRegions, StayOnTheirOwnPartAndHoldBothSidesOfEverySeam) {
  const auto folder = shared_path("data/facecap");
  MIMETRA_SKIP_WITHOUT(folder);
  const MeshSequence sequence =
      captured_performance(folder / "neutral.obj", folder / "targets", folder / "weights.csv", 100);
  const Components components = decompose(sequence, {.count = 20, .iterations = 3});
  const Weld weld = Weld::exact(components.rest);
  ASSERT_GT(weld.count, 0);

  const Regions regions = find_regions(components);
  EXPECT_EQ(regions.vertices, 2694);
  const ConnectedComponents parts =
      connected_components(regions.vertices, weld.welded(components.triangles));
  const auto part_of = [&](VertexIndex v) { return parts.of_vertex[weld.representative[v]]; };
  for (const Region& region : regions.regions) {
    for (const VertexIndex v : region.vertices) {
      EXPECT_EQ(part_of(v), part_of(region.center)) << v << " around " << region.center;
    }
  }

  int on_seams = 0;
  // The seams lie at the back of the head: discs of the default radius do not reach them.
  const Regions wide = find_regions(components, {.radius = 0.5 * diameter(components.rest)});
  for (const Region& region : wide.regions) {
    const std::set<VertexIndex> held(region.vertices.begin(), region.vertices.end());
    for (int v = 0; v < wide.vertices; ++v) {
      if (weld.representative[v] == v) continue;
      EXPECT_EQ(held.count(v), held.count(weld.representative[v])) << v;
      on_seams += static_cast<int>(held.count(v));
    }
  }
  EXPECT_GT(on_seams, 0);
}

}  // namespace
}  // namespace mimetra::test
