#include "toolkit/correspondence/surface_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "tests/correspondence/closest_in_triangle.h"
#include "tests/shapes.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/similarity.h"

namespace mimetra {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<Marker> kCorners = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};

/// Section 4 as it stands, with dense normal equations and no tricks, for closed surfaces without
/// seams whose box has a diagonal of 1.
class LiteralFit {
 public:
  LiteralFit(const test::Shape& source, const test::Shape& target,
             const std::vector<Marker>& markers, const SurfaceFitOptions& options)
      : source_(source), target_(target), markers_(markers), options_(options) {}

  Positions run() const {
    Positions positions = minimum(0, {});
    for (int step = 0; step < options_.steps; ++step) {
      const double growth = options_.last_closest / options_.first_closest;
      const double weight =
          options_.first_closest * std::pow(growth, step / (options_.steps - 1.0));
      positions = minimum(weight, closest(positions));
    }
    return positions;
  }

 private:
  int vertices() const { return static_cast<int>(source_.positions.rows()); }
  int triangles() const { return static_cast<int>(source_.triangles.rows()); }

  /// Rows of the matrix that gives T_i's coefficients from the unknowns of one coordinate.
  Eigen::MatrixXd gradient(int i) const {
    const auto corner = [&](int c) -> Vector3d {
      return source_.positions.row(source_.triangles(i, c));
    };
    const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    Eigen::Matrix3d V;
    V << corner(1) - corner(0), corner(2) - corner(0), normal / std::sqrt(normal.norm());
    Eigen::MatrixXd edges = Eigen::MatrixXd::Zero(3, vertices() + triangles());
    const int first = source_.triangles(i, 0);
    const std::array<int, 3> others = {source_.triangles(i, 1), source_.triangles(i, 2),
                                       vertices() + i};
    for (int e = 0; e < 3; ++e) {
      edges(e, others[e]) = 1;
      edges(e, first) = -1;
    }
    return V.inverse().transpose() * edges;
  }

  bool adjacent(int i, int j) const {
    int shared = 0;
    for (const int a : source_.triangles.row(i)) {
      for (const int b : source_.triangles.row(j)) shared += a == b;
    }
    return i != j && shared == 2;
  }

  Positions minimum(double closest_weight, const Positions& closest) const {
    const int unknowns = vertices() + triangles();
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(unknowns, unknowns);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(unknowns, 3);
    for (int i = 0; i < triangles(); ++i) {
      const Eigen::MatrixXd T_i = gradient(i);
      for (int j = 0; j < triangles(); ++j) {
        if (!adjacent(i, j)) continue;
        const Eigen::MatrixXd difference = T_i - gradient(j);
        normal += options_.smoothness * difference.transpose() * difference;
      }
      normal += options_.identity * T_i.transpose() * T_i;
      right += options_.identity * T_i.transpose() * Eigen::Matrix3d::Identity();
    }
    for (int v = 0; v < vertices() && closest_weight > 0; ++v) {
      normal(v, v) += closest_weight;
      right.row(v) += closest_weight * closest.row(v);
    }
    // Markers are no unknowns.
    for (const Marker& marker : markers_) {
      normal.row(marker.source).setZero();
      normal(marker.source, marker.source) = 1;
      right.row(marker.source) = target_.positions.row(marker.target);
    }
    return normal.fullPivLu().solve(right).topRows(vertices());
  }

  Positions closest(const Positions& positions) const {
    Positions normals = Positions::Zero(vertices(), 3);
    for (int i = 0; i < triangles(); ++i) {
      const auto corner = [&](int c) -> Vector3d { return positions.row(source_.triangles(i, c)); };
      const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
      for (const int v : source_.triangles.row(i)) normals.row(v) += normal;
    }
    Positions result(vertices(), 3);
    for (int v = 0; v < vertices(); ++v) {
      double least = std::numeric_limits<double>::infinity();
      for (int t = 0; t < target_.triangles.rows(); ++t) {
        const auto corner = [&](int c) -> Vector3d {
          return target_.positions.row(target_.triangles(t, c));
        };
        const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        if (normal.dot(normals.row(v)) <= 0) continue;
        const Vector3d p = positions.row(v);
        const Vector3d at = test::closest_in(p, corner(0), corner(1), corner(2));
        if ((at - p).norm() >= least) continue;
        least = (at - p).norm();
        result.row(v) = at;
      }
    }
    return result;
  }

  const test::Shape& source_;
  const test::Shape& target_;
  const std::vector<Marker>& markers_;
  const SurfaceFitOptions& options_;
};

/// An egg with a box of diagonal 1 around the origin.
test::Shape egg(int levels) {
  test::Shape shape = test::sphere(levels);
  shape.positions.col(0) *= 1.2;
  shape.positions.col(1) *= 0.9;
  shape.positions.col(2) =
      shape.positions.col(2).unaryExpr([](double z) { return z > 0 ? z : 0.8 * z; });
  shape.positions.rowwise() -=
      (shape.positions.colwise().maxCoeff() + shape.positions.colwise().minCoeff()) / 2;
  shape.positions /= box_diagonal(shape.positions);
  return shape;
}

TEST(SurfaceFit, IsThatOfTheDenseEquationsOfThePaper) {
  const test::Shape sphere = test::sphere(1), target = egg(2);
  const SurfaceFitOptions options = {.steps = 3};
  const SurfaceFit fit =
      fit_to_surface(test::mesh_of(sphere), test::mesh_of(target), kCorners, options);
  // The literal version starts where the markers' similarity leaves the source.
  const Similarity similarity =
      similarity_fit(sphere.positions.topRows(6), target.positions.topRows(6));
  const test::Shape start = {similarity.apply(sphere.positions), sphere.triangles};
  const Positions expected = LiteralFit(start, target, kCorners, options).run();
  // The normal equations have a condition number of about 1e7 where closest points weigh most.
  EXPECT_LT((fit.positions - expected).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(SurfaceFit, PutsMarkersOnMarkersAndTheRestOnTheSurface) {
  const test::Shape target = egg(3);
  const SurfaceFit fit =
      fit_to_surface(test::mesh_of(test::sphere(2)), test::mesh_of(target), kCorners);
  for (const Marker& marker : kCorners) {
    EXPECT_LT((fit.positions.row(marker.source) - target.positions.row(marker.target)).norm(),
              1e-12);
  }
  double farthest = 0;
  for (int v = 0; v < fit.positions.rows(); ++v) {
    double nearest = 1;
    for (int t = 0; t < target.triangles.rows(); ++t) {
      const auto corner = [&](int c) -> Vector3d {
        return target.positions.row(target.triangles(t, c));
      };
      const Vector3d p = fit.positions.row(v);
      nearest =
          std::min(nearest, (test::closest_in(p, corner(0), corner(1), corner(2)) - p).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  // Shares of the diagonal; the egg is 5 % from a similar sphere.
  EXPECT_LT(farthest, 0.002);
}

TEST(SurfaceFit, OfASimilarMeshIsThatMesh) {
  const TriMesh source = test::mesh_of(test::sphere(2));
  TriMesh target = source;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  target.positions =
      (250 * source.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(100, -300, 20);
  const SurfaceFit fit = fit_to_surface(source, target, kCorners);
  EXPECT_LT((fit.positions - target.positions).cwiseAbs().maxCoeff(), 250 * 1e-9);
}

TEST(SurfaceFit, HasTheSameBytesForEveryNumberOfThreads) {
  const TriMesh source = test::mesh_of(test::sphere(3)), target = test::mesh_of(egg(3));
  const SurfaceFit one = fit_to_surface(source, target, kCorners, {}, Context().with_threads(1));
  const SurfaceFit three = fit_to_surface(source, target, kCorners, {}, Context().with_threads(3));
  EXPECT_EQ(one.positions, three.positions);
}

/// A bowl of columns x rows vertices with unit spacing.
test::Shape bowl(int columns, int rows) {
  test::Shape shape = test::grid(columns, rows);
  for (int v = 0; v < shape.positions.rows(); ++v) {
    shape.positions(v, 2) =
        0.08 * (std::pow(shape.positions(v, 0) - 4, 2) + std::pow(shape.positions(v, 1) - 3, 2));
  }
  return shape;
}

TEST(SurfaceFit, LeavesWhatReachesBeyondAnOpenTargetThere) {
  // The target ends at x = 6, the source goes on to x = 10.
  const test::Shape wide = bowl(11, 7);
  const TriMesh source = test::mesh_of(wide), target = test::mesh_of(bowl(7, 7));
  const std::vector<Marker> markers = {
      {0, 0}, {4, 4}, {11 * 6, 7 * 6}, {11 * 6 + 4, 7 * 6 + 4}, {11 * 3 + 2, 7 * 3 + 2}};
  const SurfaceFit fit = fit_to_surface(source, target, markers);
  for (int v = 0; v < wide.positions.rows(); ++v) {
    // A tenth of the spacing.
    EXPECT_LT((fit.positions.row(v) - wide.positions.row(v)).norm(), 0.1) << v;
  }
}

TEST(SurfaceFit, LeavesTheBackOfAHeadBehindAMask) {
  // The target is the front half of a sphere whose middle bulges.
  const test::Shape head = test::sphere(3);
  test::Shape mask = head;
  std::vector<int> front;
  for (int t = 0; t < mask.triangles.rows(); ++t) {
    double z = 0;
    for (const int v : mask.triangles.row(t)) z += mask.positions(v, 2);
    if (z > 0) front.push_back(t);
  }
  mask.triangles = Triangles(mask.triangles(front, Eigen::all));
  const std::vector<Marker> markers = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}};
  const SurfaceFit fit = fit_to_surface(test::mesh_of(head), test::mesh_of(mask), markers);
  // The front is there already, and nothing draws the back: it stays a sphere.
  EXPECT_LT((fit.positions - head.positions).rowwise().norm().maxCoeff(), 0.02);
}

TEST(SurfaceFit, MovesBothSidesOfASeamAsOne) {
  test::Shape left = test::sphere(2);
  const TriMesh source = test::mesh_of(left);
  TriMesh seamed = source;
  // The first triangle gets corners of its own.
  const int count = source.connectivity.vertices;
  Triangles triangles = source.connectivity.triangles;
  seamed.positions.conservativeResize(count + 3, 3);
  for (int c = 0; c < 3; ++c) {
    seamed.positions.row(count + c) = source.positions.row(triangles(0, c));
    triangles(0, c) = count + c;
  }
  seamed.connectivity = Connectivity::from_triangles(count + 3, triangles);
  const TriMesh target = test::mesh_of(egg(2));
  const Positions welded = fit_to_surface(source, target, kCorners).positions;
  const Positions parted = fit_to_surface(seamed, target, kCorners).positions;
  EXPECT_EQ(parted.topRows(count), welded);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(parted.row(count + c), welded.row(source.connectivity.triangles(0, c)));
  }
}

TEST(SurfaceFit, CarriesPartsWithoutAMarkerByTheSimilarity) {
  test::Shape eye = test::sphere(1);
  eye.positions *= 0.1;
  const TriMesh source = test::mesh_of(test::both(test::sphere(2), eye));
  TriMesh target = test::mesh_of(test::sphere(3));
  target.positions *= 3;
  const SurfaceFit fit = fit_to_surface(source, target, kCorners);
  EXPECT_TRUE(fit.reached[65]);
  EXPECT_FALSE(fit.reached[66]);
  EXPECT_LT((fit.positions.bottomRows(18) - 3 * source.positions.bottomRows(18)).norm(), 1e-12);
}

TEST(SurfaceFit, DoesNotDependOnOtherPartsOfTheTarget) {
  test::Shape body = test::sphere(2);
  body.positions = (4 * body.positions).rowwise() + Eigen::RowVector3d(0, -8, 0);
  const test::Shape head = egg(2);
  const TriMesh source = test::mesh_of(test::sphere(2));
  const SurfaceFit alone = fit_to_surface(source, test::mesh_of(head), kCorners);
  const SurfaceFit with_body =
      fit_to_surface(source, test::mesh_of(test::both(head, body)), kCorners);
  EXPECT_EQ(with_body.positions, alone.positions);
}

TEST(SurfaceFit, PassesOverTrianglesWithoutArea) {
  test::Shape sphere = test::sphere(1);
  sphere.positions.conservativeResize(20, 3);
  sphere.positions.bottomRows(2) << 0, 0, 2, 0, 0, 3;
  sphere.triangles.conservativeResize(33, 3);
  sphere.triangles.row(32) << 4, 18, 19;
  const SurfaceFit fit = fit_to_surface(test::mesh_of(sphere), test::mesh_of(egg(2)), kCorners);
  EXPECT_TRUE(fit.positions.allFinite());
  EXPECT_FALSE(fit.reached[18]);
}

TEST(SurfaceFit, RefusesTwoMarkersAtOnePlace) {
  test::Shape twice = test::both(test::sphere(1), test::sphere(1));
  std::vector<Marker> markers = kCorners;
  markers.push_back({18, 9});
  EXPECT_THAT([&] { fit_to_surface(test::mesh_of(twice), test::mesh_of(egg(1)), markers); },
              ThrowsMessage<MismatchError>(HasSubstr("two markers are at the place of vertex 18")));
  markers.back() = {9, 18};
  EXPECT_THAT(
      [&] { fit_to_surface(test::mesh_of(test::sphere(1)), test::mesh_of(twice), markers); },
      ThrowsMessage<MismatchError>(HasSubstr("place of vertex 18 of the target")));
}

TEST(SurfaceFit, RefusesOptionsOutOfRange) {
  const TriMesh mesh = test::mesh_of(test::sphere(1));
  EXPECT_THROW(fit_to_surface(mesh, mesh, kCorners, {.identity = 0}), std::invalid_argument);
  EXPECT_THROW(fit_to_surface(mesh, mesh, kCorners, {.steps = -1}), std::invalid_argument);
}

TEST(SurfaceFit, StopsWhereProgressSaysSo) {
  const TriMesh mesh = test::mesh_of(test::sphere(1));
  const Context half = Context().with_progress([](double share) { return share < 0.5; });
  EXPECT_THROW(fit_to_surface(mesh, mesh, kCorners, {}, half), Cancelled);
}

}  // namespace
}  // namespace mimetra
