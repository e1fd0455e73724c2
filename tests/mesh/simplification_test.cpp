#include "toolkit/mesh/simplification.h"

#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

using test::Shape;

/// A sequence of poses of a shape, of which the first is the rest pose.
MeshSequence moving(const Shape& shape, const std::vector<Positions>& poses) {
  Frames frames(static_cast<Eigen::Index>(poses.size()), shape.positions.size());
  for (std::size_t f = 0; f < poses.size(); ++f) {
    frames.row(static_cast<Eigen::Index>(f)) = poses[f].reshaped<Eigen::RowMajor>();
  }
  return {Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles),
          frames,
          {},
          shape.positions};
}

MeshSequence still(const Shape& shape) {
  return moving(shape, {shape.positions});
}

Positions kept(const Simplification& mesh, const PositionsView& pose) {
  return pose(mesh.vertices, Eigen::all);
}

Eigen::Vector3d normal_of(const Positions& pose, const Triangles& triangles, Eigen::Index t) {
  const Eigen::Vector3d a = pose.row(triangles(t, 0)), b = pose.row(triangles(t, 1)),
                        c = pose.row(triangles(t, 2));
  return (b - a).cross(c - a);
}

double area(const Positions& pose, const Triangles& triangles) {
  double sum = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    sum += normal_of(pose, triangles, t).norm() / 2;
  }
  return sum;
}

TEST(Simplification, KeepsAShareOfTheVertices) {
  const MeshSequence sphere = still(test::sphere(4));
  const Simplification mesh = simplify(sphere, {.share = 0.25});
  EXPECT_EQ(mesh.vertices.size(), std::size_t(std::ceil(0.25 * sphere.vertices())));
  EXPECT_TRUE(std::ranges::is_sorted(mesh.vertices));
  EXPECT_EQ(std::set<int>(mesh.vertices.begin(), mesh.vertices.end()).size(), mesh.vertices.size());
  EXPECT_EQ(mesh.connectivity->vertices, static_cast<int>(mesh.vertices.size()));
  // Euler: a sphere of V vertices has 2 V - 4 triangles.
  EXPECT_EQ(mesh.connectivity->triangles.rows(), 2 * mesh.connectivity->vertices - 4);
}

TEST(Simplification, StaysNearTheSurface) {
  const MeshSequence sphere = still(test::sphere(5));
  const Simplification mesh = simplify(sphere, {.share = 0.1});
  const Positions rest = kept(mesh, sphere.frame(0));
  const Triangles& triangles = mesh.connectivity->triangles;
  // n vertices on a sphere are about sqrt(4 pi / n * 2 / sqrt(3)) apart, and the middle of three
  // that are so far apart lies their distance squared over 6 below it; these are not all equal.
  const double edge2 = 4 * std::numbers::pi / double(mesh.vertices.size()) * 2 / std::sqrt(3.0);
  for (const auto& t : triangles.rowwise()) {
    const Eigen::RowVector3d middle = (rest.row(t[0]) + rest.row(t[1]) + rest.row(t[2])) / 3;
    EXPECT_GT(middle.norm(), 1 - 3 * edge2 / 6);
  }
}

TEST(Simplification, KeepsAFlatSheetAndItsBorder) {
  const Shape grid = test::grid(21, 15);
  const Simplification mesh = simplify(still(grid), {.share = 0.2});
  const Positions rest = grid.positions(mesh.vertices, Eigen::all);
  EXPECT_NEAR(area(rest, mesh.connectivity->triangles), 20 * 14, 1e-9);
  for (Eigen::Index t = 0; t < mesh.connectivity->triangles.rows(); ++t) {
    EXPECT_GT(normal_of(rest, mesh.connectivity->triangles, t)[2], 0);
  }
}

TEST(Simplification, OfAllVerticesIsTheMeshItself) {
  const Shape shape = test::sphere(2);
  const Simplification mesh = simplify(still(shape), {.share = 1});
  EXPECT_EQ(static_cast<Eigen::Index>(mesh.vertices.size()), shape.positions.rows());
  EXPECT_TRUE(same_faces(*mesh.connectivity, still(shape).connectivity()));
}

/// A sheet that is flat at rest, and in other frames bends on its left half.
MeshSequence half_bending() {
  const Shape grid = test::grid(41, 21);
  Positions bent = grid.positions;
  for (Eigen::Index v = 0; v < bent.rows(); ++v) {
    const double x = bent(v, 0), y = bent(v, 1);
    if (x < 20) bent(v, 2) = 2 * std::pow(std::sin(std::numbers::pi * x / 20), 2) * std::cos(y / 3);
  }
  return moving(grid, {grid.positions, bent, (grid.positions + bent) / 2});
}

TEST(Simplification, KeepsVerticesWhereTheMeshMoves) {
  const MeshSequence sheet = half_bending();
  const Simplification mesh = simplify(sheet, {.share = 0.3});
  const Positions rest = kept(mesh, sheet.frame(0));
  const auto left = (rest.col(0).array() < 20).count(), right = (rest.col(0).array() > 20).count();
  EXPECT_GT(left, 3 * right);
}

/// Vertices and triangles of a tongue that rolls up more and more.
MeshSequence rolling() {
  const Shape grid = test::grid(61, 9);
  std::vector<Positions> poses = {grid.positions};
  for (int frame = 1; frame <= 8; ++frame) {
    const double curvature = 0.06 * frame;
    Positions pose = grid.positions;
    for (Eigen::Index v = 0; v < pose.rows(); ++v) {
      const double angle = curvature * pose(v, 0);
      pose(v, 0) = std::sin(angle) / curvature;
      pose(v, 2) = (1 - std::cos(angle)) / curvature;
    }
    poses.push_back(pose);
  }
  return moving(grid, poses);
}

TEST(Simplification, FoldsNoTriangleInAnyFrame) {
  const MeshSequence tongue = rolling();
  const Simplification mesh = simplify(tongue, {.share = 0.15});
  EXPECT_EQ(mesh.folded, 0);
  const Triangles& triangles = mesh.connectivity->triangles;
  for (int f = 1; f < tongue.frames(); ++f) {
    const Positions pose = kept(mesh, tongue.frame(f));
    const double curvature = 0.06 * f;
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
      // The outside of the roll at each corner: where the flat sheet had z.
      const Eigen::Vector3d normal = normal_of(pose, triangles, t);
      Eigen::Vector3d outside = Eigen::Vector3d::Zero();
      for (const int corner : triangles.row(t)) {
        const int own = mesh.vertices[static_cast<std::size_t>(corner)];
        const double angle = curvature * tongue.rest()(own, 0);
        outside += Eigen::Vector3d(-std::sin(angle), 0, std::cos(angle));
      }
      EXPECT_GT(normal.dot(outside), 0) << "frame " << f << ", triangle " << t;
    }
  }
}

TEST(Simplification, KeepsTextureCoordinatesWithTheirVertices) {
  const Shape grid = test::grid(17, 17);
  Connectivity mesh = Connectivity::from_triangles(289, grid.triangles);
  const auto place = [](int v) {
    const int row = v / 17;
    return Eigen::Vector2d(v % 17 / 16.0, row / 16.0);
  };
  for (int v = 0; v < 289; ++v) mesh.texture.coordinates.push_back(place(v));
  mesh.texture.corners = mesh.polygons.corners;
  const MeshSequence sheet(mesh, grid.positions.reshaped<Eigen::RowMajor>().transpose());
  const Simplification simple = simplify(sheet, {.share = 0.3});
  const Connectivity& left = *simple.connectivity;
  ASSERT_EQ(left.texture.corners.size(), left.polygons.corners.size());
  for (std::size_t c = 0; c < left.polygons.corners.size(); ++c) {
    const int own = simple.vertices[static_cast<std::size_t>(left.polygons.corners[c])];
    EXPECT_EQ(left.texture.coordinates[static_cast<std::size_t>(left.texture.corners[c])],
              place(own));
  }
}

TEST(Simplification, KeepsTextureCoordinatesOfFacesThatAreWoundAgainstOthers) {
  Shape grid = test::grid(17, 17);
  for (Eigen::Index t = 0; t < grid.triangles.rows(); t += 7) {
    grid.triangles.row(t).reverseInPlace();
  }
  Connectivity mesh = Connectivity::from_triangles(289, grid.triangles);
  for (int v = 0; v < 289; ++v) mesh.texture.coordinates.emplace_back(v % 17, v / 17);
  mesh.texture.corners = mesh.polygons.corners;
  const MeshSequence sheet(mesh, grid.positions.reshaped<Eigen::RowMajor>().transpose());
  const Simplification simple = simplify(sheet, {.share = 0.5});
  const Connectivity& left = *simple.connectivity;
  for (std::size_t c = 0; c < left.polygons.corners.size(); ++c) {
    const int own = simple.vertices[static_cast<std::size_t>(left.polygons.corners[c])];
    EXPECT_EQ(left.texture.coordinates[static_cast<std::size_t>(left.texture.corners[c])],
              Eigen::Vector2d(own % 17, own / 17));
  }
}

/// Two charts that lie on each other in texture space, with a seam at x = 8.
TEST(Simplification, KeepsChartsThatOverlapApart) {
  const Shape grid = test::grid(17, 17);
  Connectivity mesh = Connectivity::from_triangles(289, grid.triangles);
  const auto place = [](int v, bool is_right) {
    return Eigen::Vector2d(is_right ? 19 - v % 17 : v % 17, v / 17);
  };
  const auto is_right = [&](const Triangles& triangles, const std::vector<VertexIndex>& vertices,
                            Eigen::Index t) {
    int columns = 0;
    for (const int v : triangles.row(t)) columns += vertices[std::size_t(v)] % 17;
    return columns > 3 * 8;
  };
  for (const bool right : {false, true}) {
    for (int v = 0; v < 289; ++v) mesh.texture.coordinates.push_back(place(v, right));
  }
  std::vector<VertexIndex> all(289);
  std::iota(all.begin(), all.end(), 0);
  for (std::size_t c = 0; c < mesh.polygons.corners.size(); ++c) {
    const bool right = is_right(mesh.triangles, all, static_cast<Eigen::Index>(c / 3));
    mesh.texture.corners.push_back(mesh.polygons.corners[c] + (right ? 289 : 0));
  }
  const MeshSequence sheet(mesh, grid.positions.reshaped<Eigen::RowMajor>().transpose());
  for (const double share : {0.5, 0.2}) {
    const Simplification simple = simplify(sheet, {.share = share});
    const Connectivity& left = *simple.connectivity;
    ASSERT_LT(left.vertices, 200);
    for (Eigen::Index t = 0; t < left.triangles.rows(); ++t) {
      const bool right = is_right(left.triangles, simple.vertices, t);
      for (int c = 0; c < 3; ++c) {
        const int number = left.texture.corners[static_cast<std::size_t>(3 * t + c)];
        const int own = simple.vertices[static_cast<std::size_t>(left.triangles(t, c))];
        EXPECT_EQ(left.texture.coordinates[static_cast<std::size_t>(number)], place(own, right))
            << "corner " << c << " of triangle " << t;
      }
    }
  }
}

TEST(Simplification, DoesNotOpenSeams) {
  // Two sheets of their own vertices, side by side: x = 10 is there twice.
  const Shape left = test::grid(11, 11);
  Shape right = left;
  right.positions.col(0).array() += 10;
  const Shape seam = test::both(left, right);
  const Simplification mesh = simplify(still(seam), {.share = 0.4});
  EXPECT_EQ(mesh.locked, 22);
  const std::set<int> vertices(mesh.vertices.begin(), mesh.vertices.end());
  for (int y = 0; y < 11; ++y) {
    EXPECT_TRUE(vertices.contains(y * 11 + 10));
    EXPECT_TRUE(vertices.contains(121 + y * 11));
  }
  EXPECT_NEAR(area(seam.positions(mesh.vertices, Eigen::all), mesh.connectivity->triangles), 200,
              1e-9);
}

TEST(Simplification, TakesWhatIsNoManifold) {
  // A third sheet stands on the middle row of a flat one, one triangle repeats a corner, and one
  // vertex has no triangle.
  Shape shape = test::grid(9, 9);
  const Eigen::Index flat = shape.positions.rows(), faces = shape.triangles.rows();
  shape.positions.conservativeResize(flat + 10, 3);
  shape.triangles.conservativeResize(faces + 17, 3);
  for (int x = 0; x < 9; ++x) shape.positions.row(flat + x) << x, 4, 1;
  shape.positions.row(flat + 9) << 50, 50, 50;
  for (int x = 0; x < 8; ++x) {
    const int a = 36 + x, b = a + 1, c = static_cast<int>(flat) + x, d = c + 1;
    shape.triangles.row(faces + 2 * x) << a, b, d;
    shape.triangles.row(faces + 2 * x + 1) << a, d, c;
  }
  shape.triangles.row(faces + 16) << 0, 0, 1;
  const Simplification mesh = simplify(still(shape), {.share = 0.5});
  const std::set<int> vertices(mesh.vertices.begin(), mesh.vertices.end());
  for (int x = 1; x < 8; ++x) EXPECT_TRUE(vertices.contains(36 + x));
  EXPECT_TRUE(vertices.contains(static_cast<int>(flat) + 9));
  EXPECT_LT(vertices.size(), 0.7 * double(flat));
  EXPECT_NEAR(area(shape.positions(mesh.vertices, Eigen::all), mesh.connectivity->triangles),
              64 + 8, 1e-9);
}

TEST(Simplification, KeepsTheMiddleOfAFan) {
  // A disc of 600 triangles around one vertex, whose edges are all candidates at every collapse.
  constexpr int kRim = 600;
  Shape disc{Positions(kRim + 1, 3), Triangles(kRim, 3)};
  disc.positions.row(kRim) << 0, 0, 0;
  for (int v = 0; v < kRim; ++v) {
    const double angle = 2 * std::numbers::pi * v / kRim;
    disc.positions.row(v) << std::cos(angle), std::sin(angle), 0;
    disc.triangles.row(v) << kRim, v, (v + 1) % kRim;
  }
  const Simplification mesh = simplify(still(disc), {.share = 0.5});
  EXPECT_EQ(mesh.vertices.back(), kRim);
  EXPECT_LT(mesh.vertices.size(), 0.6 * kRim);
}

TEST(Simplification, KeepsGroupsBeforeTheirFaces) {
  const Shape grid = test::grid(11, 11);
  Connectivity mesh = Connectivity::from_triangles(121, grid.triangles);
  mesh.groups = {{0, "g low"}, {100, "g high"}};  // rows of 20 triangles: y < 5 and above
  const MeshSequence sheet(mesh, grid.positions.reshaped<Eigen::RowMajor>().transpose());
  const Simplification simple = simplify(sheet, {.share = 0.5});
  const Connectivity& left = *simple.connectivity;
  ASSERT_EQ(left.groups.size(), 2U);
  EXPECT_EQ(left.groups[0].first_face, 0);
  EXPECT_GT(left.groups[1].first_face, 0);
  EXPECT_LT(left.groups[1].first_face, left.polygons.size());
  EXPECT_EQ(left.groups[1].statement, "g high");
}

TEST(Simplification, IsTheSameForEveryNumberOfThreads) {
  const MeshSequence tongue = rolling();
  const Simplification one = simplify(tongue, {.share = 0.3}, Context().with_threads(1));
  const Simplification three = simplify(tongue, {.share = 0.3}, Context().with_threads(3));
  EXPECT_EQ(one.vertices, three.vertices);
  EXPECT_EQ(one.connectivity->triangles, three.connectivity->triangles);
}

TEST(Simplification, CanBeCancelledAndRefusesShares) {
  const MeshSequence tongue = rolling();
  const Context cancelled = Context().with_progress([](double) { return false; });
  EXPECT_THROW(simplify(tongue, {}, cancelled), Cancelled);
  EXPECT_THROW(simplify(tongue, {.share = 0}), std::invalid_argument);
  EXPECT_THROW(simplify(tongue, {.share = 1.5}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
