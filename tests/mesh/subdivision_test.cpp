#include "toolkit/mesh/subdivision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/LoopT.hh>

#include "tests/shapes.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/openmesh.h"

namespace mimetra {
namespace {

using test::Shape;

Connectivity connectivity_of(const Shape& shape) {
  return Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles);
}

Positions finer(const Shape& shape, const SubdivideOptions& options = {}) {
  return subdivide(shape.positions, connectivity_of(shape), options).weights * shape.positions;
}

/// By OpenMesh's own subdivider.
TriMesh by_openmesh(const Shape& shape, int times) {
  using Mesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
  Mesh mesh;
  for (const auto& p : shape.positions.rowwise()) mesh.add_vertex({p[0], p[1], p[2]});
  for (const auto& t : shape.triangles.rowwise()) {
    mesh.add_face(OpenMesh::VertexHandle(t[0]), OpenMesh::VertexHandle(t[1]),
                  OpenMesh::VertexHandle(t[2]));
  }
  OpenMesh::Subdivider::Uniform::LoopT<Mesh, double> loop;
  loop.attach(mesh);
  loop(static_cast<std::size_t>(times));
  loop.detach();
  return from_openmesh(mesh);
}

class LoopOf : public testing::TestWithParam<int> {
 protected:
  static Shape shape() {
    switch (GetParam()) {
      case 0:
        return test::octahedron();
      case 1:
        return test::sphere(2);
      default:
        Shape grid = test::grid(6, 4);
        for (Eigen::Index v = 0; v < grid.positions.rows(); ++v) {
          grid.positions(v, 2) = std::sin(double(7 * v));
        }
        return grid;
    }
  }
};

TEST_P(LoopOf, IsWhatOpenMeshMakes) {
  for (const int times : {1, 2}) {
    const Positions own = finer(shape(), {.times = times});
    const TriMesh other = by_openmesh(shape(), times);
    ASSERT_EQ(own.rows(), other.positions.rows());
    for (Eigen::Index v = 0; v < own.rows(); ++v) {
      // New vertices have another order. Both sum a few numbers of size 1.
      EXPECT_LT((other.positions.rowwise() - own.row(v)).rowwise().norm().minCoeff(), 1e-14);
    }
    for (Eigen::Index v = 0; v < shape().positions.rows(); ++v) {
      EXPECT_LT((other.positions.row(v) - own.row(v)).norm(), 1e-14);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, LoopOf, testing::Values(0, 1, 2));

TEST(Subdivision, HasWeightsThatAddUpToOne) {
  for (const auto scheme : {SubdivisionScheme::loop, SubdivisionScheme::midpoint}) {
    const Shape shape = test::sphere(1);
    const Subdivision fine = subdivide(shape.positions, connectivity_of(shape), {scheme, 2});
    const Eigen::VectorXd sums = fine.weights * Eigen::VectorXd::Ones(shape.positions.rows());
    EXPECT_LT((sums.array() - 1).abs().maxCoeff(), 1e-15 * 8);
    EXPECT_EQ(fine.connectivity->triangles.rows(), 16 * shape.triangles.rows());
    EXPECT_EQ(fine.connectivity->vertices, fine.weights.rows());
  }
}

TEST(Subdivision, AtMidpointsLeavesTheSurfaceAsItIs) {
  const Shape shape = test::sphere(1);
  const Shape expected = test::subdivided(shape);
  const Subdivision fine =
      subdivide(shape.positions, connectivity_of(shape), {SubdivisionScheme::midpoint, 1});
  EXPECT_EQ(fine.weights * shape.positions, expected.positions);
  EXPECT_EQ(fine.connectivity->triangles, expected.triangles);
}

TEST(Subdivision, DoesNotOpenSeams) {
  const Shape left = test::grid(4, 5);
  Shape right = left;
  right.positions.col(0).array() += 3;
  Shape seam = test::both(left, right);
  for (Eigen::Index v = 0; v < seam.positions.rows(); ++v) {
    const auto p = seam.positions.row(v);
    seam.positions(v, 2) = std::sin(p[0] + 2 * p[1]);
  }
  // One sheet of the same vertices, which has no seam.
  Shape whole = test::grid(7, 5);
  for (Eigen::Index v = 0; v < whole.positions.rows(); ++v) {
    const auto p = whole.positions.row(v);
    whole.positions(v, 2) = std::sin(p[0] + 2 * p[1]);
  }
  const Positions fine = finer(seam, {.times = 2}), expected = finer(whole, {.times = 2});
  for (Eigen::Index v = 0; v < fine.rows(); ++v) {
    EXPECT_LT((expected.rowwise() - fine.row(v)).rowwise().norm().minCoeff(), 1e-14);
  }
}

TEST(Subdivision, PassesOverFacesThatCollapseIntoAnEdge) {
  // The upper row of a sheet has vertices of its own at the edge from 5 to 6. Two faces without
  // area lie between both sides.
  const Shape sheet = test::grid(4, 3);
  Shape apart = sheet;
  apart.positions.conservativeResize(14, 3);
  apart.positions.bottomRows(2) = sheet.positions.middleRows(5, 2);
  for (Eigen::Index t = 0; t < apart.triangles.rows(); ++t) {
    if (apart.triangles.row(t).maxCoeff() < 8) continue;
    for (int c = 0; c < 3; ++c) {
      int& corner = apart.triangles(t, c);
      if (corner == 5 || corner == 6) corner += 7;
    }
  }
  apart.triangles.conservativeResize(apart.triangles.rows() + 2, 3);
  apart.triangles.bottomRows(2) << 12, 13, 6, 12, 6, 5;
  const Positions fine = finer(apart), expected = finer(sheet);
  for (Eigen::Index v = 0; v < expected.rows(); ++v) {
    EXPECT_LT((fine.rowwise() - expected.row(v)).rowwise().norm().minCoeff(), 1e-15);
  }
}

TEST(Subdivision, TakesEdgesOfThreeTriangles) {
  Shape shape{Positions(5, 3), Triangles(3, 3)};
  shape.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1;
  shape.triangles << 0, 1, 2, 1, 0, 3, 0, 1, 4;
  const Positions fine = finer(shape);
  EXPECT_EQ(fine.rows(), 5 + 7);
  EXPECT_LT((fine.rowwise() - Eigen::RowVector3d(0.5, 0, 0)).rowwise().norm().minCoeff(), 1e-15);
}

TEST(Subdivision, GivesTextureCoordinatesAndGroups) {
  Shape grid = test::grid(3, 3);
  Connectivity mesh = Connectivity::from_triangles(9, grid.triangles);
  for (int v = 0; v < 9; ++v) {
    mesh.texture.coordinates.emplace_back(grid.positions(v, 0), grid.positions(v, 1));
  }
  mesh.texture.corners = mesh.polygons.corners;
  mesh.groups = {{0, "g a"}, {5, "g b"}};
  const Subdivision fine = subdivide(grid.positions, mesh, {SubdivisionScheme::midpoint, 2});
  const Positions positions = fine.weights * grid.positions;
  const Connectivity& made = *fine.connectivity;
  ASSERT_EQ(made.texture.corners.size(), made.polygons.corners.size());
  for (std::size_t c = 0; c < made.texture.corners.size(); ++c) {
    const auto uv = made.texture.coordinates[static_cast<std::size_t>(made.texture.corners[c])];
    EXPECT_EQ(uv, positions.row(made.polygons.corners[c]).head<2>().transpose());
  }
  EXPECT_EQ(made.groups[1].first_face, 5 * 16);
}

TEST(Subdivision, OfPolygonsBeginsWithTheirTriangles) {
  const Connectivity quad = Connectivity::from_polygons(4, {{0, 1, 2, 3}, {0, 4}});
  Positions square(4, 3);
  square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  const Subdivision fine = subdivide(square, quad, {SubdivisionScheme::midpoint, 1});
  EXPECT_EQ(fine.connectivity->triangles.rows(), 8);
  EXPECT_EQ(fine.connectivity->vertices, 9);
}

TEST(Subdivision, OfPolygonsKeepsEachTriangleInItsGroup) {
  Connectivity quads = Connectivity::from_polygons(6, {{0, 1, 2, 3, 1, 4, 5, 2}, {0, 4, 8}});
  quads.groups = {{0, "g a"}, {1, "g b"}};
  Positions strip(6, 3);
  strip << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0;
  const Subdivision fine = subdivide(strip, quads, {SubdivisionScheme::midpoint, 1});
  EXPECT_EQ(fine.connectivity->groups[1].first_face, 8);  // four for each half of the first quad
}

TEST(Subdivision, CarriesFramesAndTheRestPose) {
  const Shape shape = test::octahedron();
  Frames frames(3, shape.positions.size());
  frames.setRandom();
  const auto sequence = std::make_shared<const MeshSequence>(
      connectivity_of(shape), frames, Eigen::Vector3d(0, 0.5, 1), shape.positions);
  const Subdivision fine = subdivide(shape.positions, connectivity_of(shape));
  const auto made = subdivided(sequence, fine);
  EXPECT_EQ(made->times(), sequence->times());
  EXPECT_EQ(made->rest(), Positions(fine.weights * shape.positions));
  const Frames poses = made->read(1, 2);
  for (int row = 0; row < 2; ++row) {
    EXPECT_EQ(Positions(PositionsView(poses.row(row).data(), made->vertices(), 3)),
              Positions(fine.weights * sequence->frame(1 + row)));
  }
}

TEST(Subdivision, RefusesWhatItCannotCount) {
  const Shape shape = test::octahedron();
  EXPECT_THROW(subdivide(shape.positions, connectivity_of(shape), {.times = 0}),
               std::invalid_argument);
  const auto other =
      std::make_shared<const MeshSequence>(connectivity_of(test::grid(2, 2)), Frames::Zero(1, 12));
  EXPECT_THROW(subdivided(other, subdivide(shape.positions, connectivity_of(shape))),
               std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
