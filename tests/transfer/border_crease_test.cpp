#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "tests/transfer/faces.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra {
namespace {

using test::patch;
using test::Shape;

constexpr double kDegree = std::numbers::pi / 180;

/// Two triangles of area 1/2 on both sides of the y axis, of which the right one is turned upwards.
Positions hinge(double degrees) {
  Positions positions(4, 3);
  positions << 0, 0, 0, 0, 1, 0, -1, 0, 0, std::cos(degrees * kDegree), 0,
      std::sin(degrees * kDegree);
  return positions;
}

MeshSequence hinged(double rest, double pose) {
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 1, 0, 3;
  const Positions frame = hinge(pose);
  return {test::connectivity_of({hinge(rest), triangles}),
          Eigen::Map<const Eigen::RowVectorXd>(frame.data(), frame.size()),
          {},
          hinge(rest)};
}

/// By how much the result folds at a border that holds the left triangle only.
TransferError error_of_hinge(const MeshSequence& source, const MeshSequence& result) {
  return transfer_error(source, result, {0}, {.inside = {true, true, true, false}});
}

TEST(BorderCrease, IsTheAngleOfAHingeThatTheSourceDoesNotBend) {
  // acos and atan2 of exact numbers, in degrees.
  EXPECT_NEAR(error_of_hinge(hinged(0, 0), hinged(0, 30)).crease, 30, 1e-12);
  EXPECT_NEAR(error_of_hinge(hinged(0, 0), hinged(0, 30)).largest_crease, 30, 1e-12);
  EXPECT_NEAR(error_of_hinge(hinged(20, 20), hinged(20, 50)).crease, 30, 1e-12);
  EXPECT_NEAR(error_of_hinge(hinged(20, 20), hinged(20, -10)).crease, 30, 1e-12);
  EXPECT_NEAR(error_of_hinge(hinged(0, 0), hinged(0, 170)).crease, 170, 1e-12);
}

TEST(BorderCrease, IsWhatTheSourceDoesNotAskFor) {
  EXPECT_NEAR(error_of_hinge(hinged(0, 30), hinged(0, 30)).crease, 0, 1e-12);
  EXPECT_NEAR(error_of_hinge(hinged(0, 20), hinged(0, 30)).crease, 10, 1e-12);
  // Less than the source bends is no crease, the other way is.
  EXPECT_EQ(error_of_hinge(hinged(0, 40), hinged(0, 30)).crease, 0);
  EXPECT_NEAR(error_of_hinge(hinged(0, -20), hinged(0, 30)).crease, 30, 1e-12);
}

TEST(BorderCrease, IsZeroWithoutABorder) {
  const MeshSequence source = hinged(0, 0), result = hinged(0, 30);
  EXPECT_EQ(transfer_error(source, result, {0}).crease, 0);
  EXPECT_EQ(transfer_error(source, result, {0, 1}, {.inside = {true, true, true, true}}).crease, 0);
  EXPECT_EQ(transfer_error(source, result, {0, 1}, {.weights = Eigen::Vector4d::Constant(0.5)})
                .largest_crease,
            0);
}

TEST(BorderCrease, SeesASeamThatIsClosed) {
  // The right triangle has corners of its own on the hinge.
  const auto torn = [](double degrees) {
    Positions positions(6, 3);
    positions << hinge(degrees), hinge(degrees).topRows(2);
    Triangles triangles(2, 3);
    triangles << 0, 1, 2, 5, 4, 3;
    return MeshSequence(test::connectivity_of({positions, triangles}),
                        Eigen::Map<const Eigen::RowVectorXd>(positions.data(), positions.size()),
                        {}, positions);
  };
  const MeshSequence flat = torn(0);
  const MeshSequence folded = flat.with_frames(torn(25).positions());
  TransferErrorOptions options;
  options.weights = (Eigen::VectorXd(6) << 1, 1, 1, 0, 1, 1).finished();
  EXPECT_EQ(transfer_error(flat, folded, {0}, options).crease, 0);
  options.weld = Weld::exact(flat.rest());
  EXPECT_NEAR(transfer_error(flat, folded, {0}, options).crease, 25, 1e-12);
}

/// The same measure edge by edge.
TransferError literal_crease(const MeshSequence& source, const MeshSequence& result,
                             const Eigen::VectorXd& weights) {
  const Triangles& triangles = source.triangles();
  TransferError error;
  for (int f = 0; f < source.frames(); ++f) {
    double squares = 0, sum = 0;
    for (int a = 0; a < triangles.rows(); ++a) {
      for (int b = a + 1; b < triangles.rows(); ++b) {
        std::vector<VertexIndex> shared;
        for (const VertexIndex v : triangles.row(a)) {
          if ((triangles.row(b).array() == v).any()) shared.push_back(v);
        }
        if (shared.size() != 2) continue;
        const double change =
            std::abs(weights(triangles.row(a)).mean() - weights(triangles.row(b)).mean());
        if (change < 1e-12) continue;
        // Along the edge as triangle a has it.
        for (int k = 0; k < 3; ++k) {
          const VertexIndex from = triangles(a, k), to = triangles(a, (k + 1) % 3);
          if (std::set<VertexIndex>{from, to} != std::set<VertexIndex>{shared[0], shared[1]})
            continue;
          shared = {from, to};
          break;
        }
        const auto normal = [&](const Positions& p, int t) {
          return Eigen::Vector3d(triangle_frame(p, triangles, t).col(2));
        };
        const auto signed_angle = [](const Eigen::Vector3d& n, const Eigen::Vector3d& m,
                                     const Eigen::Vector3d& edge) {
          const double angle = std::acos(std::clamp(n.normalized().dot(m.normalized()), -1.0, 1.0));
          return n.cross(m).dot(edge) < 0 ? -angle : angle;
        };
        const auto along = [&](const Positions& p) {
          return Eigen::Vector3d((p.row(shared[1]) - p.row(shared[0])).transpose());
        };
        const auto gradient = [&](int t) {
          return Eigen::Matrix3d(triangle_frame(source.frame(f), triangles, t) *
                                 triangle_frame(source.rest(), triangles, t).inverse());
        };
        const Eigen::Matrix3d qa = gradient(a), qb = gradient(b);
        const Positions& rest = result.rest();
        const Positions pose = result.frame(f);
        const double at_rest = signed_angle(normal(rest, a), normal(rest, b), along(rest));
        const double found = signed_angle(normal(pose, a), normal(pose, b), along(pose)) - at_rest;
        const double asked =
            signed_angle(qa.determinant() * qa.inverse().transpose() * normal(rest, a),
                         qb.determinant() * qb.inverse().transpose() * normal(rest, b),
                         (qa + qb) * along(rest)) -
            at_rest;
        const double excess =
            std::max(0.0, std::abs(found) - std::max(0.0, found < 0 ? -asked : asked)) / kDegree;
        squares += change * along(rest).norm() * excess * excess;
        sum += change * along(rest).norm();
        error.largest_crease = std::max(error.largest_crease, excess);
      }
    }
    error.crease = std::max(error.crease, std::sqrt(squares / sum));
  }
  return error;
}

TEST(BorderCrease, AgreesWithTheLiteralMeasure) {
  const MeshSequence source = test::shaken(patch(), 3, 0.1, 1);
  const MeshSequence result = test::shaken(test::bent_patch(), 3, 0.1, 2);
  Eigen::VectorXd weights(81);
  for (int v = 0; v < 81; ++v) weights[v] = std::clamp(0.3 * (v % 9) - 0.5, 0.0, 1.0);
  const TransferError expected = literal_crease(source, result, weights);
  for (const int threads : {1, 3}) {
    const TransferError found =
        transfer_error(source, result, {0}, {.weights = weights}, Context().with_threads(threads));
    // acos is worst near flat: its rounding is that of the root of 1e-16, in degrees.
    EXPECT_NEAR(found.crease, expected.crease, 1e-6);
    EXPECT_NEAR(found.largest_crease, expected.largest_crease, 1e-6);
  }
  EXPECT_GT(expected.crease, 1);
}

TEST(BorderCrease, LeakIsThatOfVerticesOfWeightZero) {
  const MeshSequence source = test::shaken(patch(), 1, 0);
  Frames frames = source.positions();
  frames(0, 3 * 2 + 2) += 0.7;
  frames(0, 3 * 5 + 2) += 0.9;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(81);
  weights[5] = 0.1;
  const MeshSequence result = source.with_frames(frames);
  EXPECT_DOUBLE_EQ(transfer_error(source, result, {0}, {.weights = weights}).leak, 0.7);
}

}  // namespace
}  // namespace mimetra
