#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

using test::bent_patch;
using test::only_frame;
using test::patch;
using test::Shape;

/// [e1 e2 e4]: the edges of a triangle and the one to its fourth vertex.
Eigen::Matrix3d tetrahedron(const Eigen::Ref<const Positions>& p, const Triangles& triangles,
                            int t) {
  Eigen::Matrix3d edges;
  edges.col(0) = (p.row(triangles(t, 1)) - p.row(triangles(t, 0))).transpose();
  edges.col(1) = (p.row(triangles(t, 2)) - p.row(triangles(t, 0))).transpose();
  const Eigen::Vector3d normal = edges.col(0).cross(edges.col(1));
  edges.col(2) = normal / std::sqrt(normal.norm());
  return edges;
}

struct Wanted {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  double weight = 0;
};

/// The source's gradients in L, the identity with weight `outside` elsewhere.
std::vector<Wanted> wanted_gradients(const MeshSequence& pose, const std::vector<int>& selected,
                                     double outside) {
  std::vector<Wanted> wanted(pose.triangles().rows(), {Eigen::Matrix3d::Identity(), outside});
  for (const int t : selected) {
    wanted[t] = {tetrahedron(pose.frame(0), pose.triangles(), t) *
                     tetrahedron(pose.rest(), pose.triangles(), t).inverse(),
                 1};
  }
  return wanted;
}

/// Sumner and Popovic's system written out: unknowns are the vertices and a fourth vertex for each
/// triangle, and sum_i w_i ||T_i - Q_i||_F^2 is minimised by dense least squares. `held` vertices
/// stay at rest.
Positions literal_transfer(const std::vector<Wanted>& wanted, const Positions& target,
                           const Triangles& triangles, const std::vector<bool>& held) {
  const Eigen::Index n = target.rows(), m = triangles.rows();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(3 * m, n + m);
  Eigen::MatrixXd b(3 * m, 3);
  for (int t = 0; t < m; ++t) {
    const double root = std::sqrt(wanted[t].weight);
    const Eigen::Matrix3d inverse = tetrahedron(target, triangles, t).inverse();
    // Rows of T^T: T = [e1~ e2~ e4~] inverse.
    a.block<3, 1>(3 * t, triangles(t, 0)) -= root * inverse.colwise().sum().transpose();
    a.block<3, 1>(3 * t, triangles(t, 1)) += root * inverse.row(0).transpose();
    a.block<3, 1>(3 * t, triangles(t, 2)) += root * inverse.row(1).transpose();
    a.block<3, 1>(3 * t, n + t) += root * inverse.row(2).transpose();
    b.middleRows<3>(3 * t) = root * wanted[t].gradient.transpose();
  }
  std::vector<Eigen::Index> free;
  for (Eigen::Index v = 0; v < n; ++v) {
    if (held[v]) {
      b -= a.col(v) * target.row(v);
    } else {
      free.push_back(v);
    }
  }
  const auto vertices = static_cast<Eigen::Index>(free.size());
  for (Eigen::Index t = 0; t < m; ++t) {
    if (wanted[t].weight > 0) free.push_back(n + t);
  }
  const Eigen::MatrixXd solution = a(Eigen::all, free).householderQr().solve(b);
  Positions result = target;
  for (Eigen::Index i = 0; i < vertices; ++i) result.row(free[i]) = solution.row(i);
  return result;
}

std::vector<bool> only(VertexIndex vertex, Eigen::Index vertices) {
  std::vector<bool> held(vertices, false);
  held[vertex] = true;
  return held;
}

VertexTransferOptions anchored_at(VertexIndex vertex) {
  VertexTransferOptions options;
  options.anchor = Anchor::vertex;
  options.anchor_vertex = vertex;
  return options;
}

/// Householder on a 384 x 208 system with a condition number near 1e3.
constexpr double kLiteral = 1e-11;

class LiteralVertexTransfer : public testing::Test {
 protected:
  const Shape source_ = patch();
  const Positions target_ = bent_patch().positions;
  const Triangles& triangles_ = source_.triangles;
  const MeshSequence pose_ = test::shaken(source_, 1, 0.2);
  const std::vector<int> all_ = all_triangles(triangles_);
  const std::vector<int> half_ = test::half_of(triangles_);

  Positions transferred(const std::vector<int>& selected,
                        const VertexTransferOptions& options) const {
    return only_frame(
        VertexTransfer(source_.positions, target_, triangles_, selected, options).frames(pose_));
  }
};

TEST_F(LiteralVertexTransfer, AgreesOverAllTriangles) {
  const Positions expected = literal_transfer(wanted_gradients(pose_, all_, 0), target_, triangles_,
                                              only(0, target_.rows()));
  EXPECT_LT((transferred(all_, anchored_at(0)) - expected).lpNorm<Eigen::Infinity>(), kLiteral);
}

TEST_F(LiteralVertexTransfer, AgreesOnARegionWithFixedOutside) {
  const Regions regions =
      regions_from_vertices(81, triangles_, {{30, 31, 32, 39, 40, 41, 48, 49, 50}});
  VertexTransferOptions options;
  options.inside = regions.inside;
  std::vector<bool> held = regions.inside;
  held.flip();
  const Positions expected =
      literal_transfer(wanted_gradients(pose_, regions.triangles, 0), target_, triangles_, held);
  EXPECT_LT((transferred(regions.triangles, options) - expected).lpNorm<Eigen::Infinity>(),
            kLiteral);
}

TEST_F(LiteralVertexTransfer, AgreesWithIdentityOutside) {
  VertexTransferOptions options = anchored_at(5);
  options.outside = Outside::identity;
  options.outside_weight = 0.3;
  const Positions expected = literal_transfer(wanted_gradients(pose_, half_, 0.3), target_,
                                              triangles_, only(5, target_.rows()));
  EXPECT_LT((transferred(half_, options) - expected).lpNorm<Eigen::Infinity>(), kLiteral);
}

TEST_F(LiteralVertexTransfer, AgreesWithWeightsByArea) {
  VertexTransferOptions options = anchored_at(5);
  options.triangle_weight = TriangleWeight::area;
  std::vector<Wanted> wanted = wanted_gradients(pose_, all_, 0);
  for (int t = 0; t < triangles_.rows(); ++t) {
    const Eigen::Matrix3d edges = tetrahedron(target_, triangles_, t);
    wanted[t].weight = edges.col(0).cross(edges.col(1)).norm() / 2;
  }
  const Positions expected = literal_transfer(wanted, target_, triangles_, only(5, target_.rows()));
  EXPECT_LT((transferred(all_, options) - expected).lpNorm<Eigen::Infinity>(), kLiteral);
}

/// In-plane gradients of the displacement from `target` to `found`.
std::vector<Eigen::Matrix3d> displacement_gradients(const Positions& target,
                                                    const Triangles& triangles,
                                                    const Positions& found) {
  std::vector<Eigen::Matrix3d> gradients;
  for (int t = 0; t < triangles.rows(); ++t) {
    const Eigen::Matrix3d rest = tetrahedron(target, triangles, t);
    Eigen::Matrix3d moved = tetrahedron(found, triangles, t) - rest;
    moved.col(2).setZero();
    gradients.push_back(moved * rest.inverse());
  }
  return gradients;
}

/// Sum of w_i ||T_i - Q_i||_F^2 in the planes of the target's triangles.
double misfit(const std::vector<Wanted>& wanted, const Positions& target,
              const Triangles& triangles, const Positions& found) {
  const auto gradients = displacement_gradients(target, triangles, found);
  double sum = 0;
  for (int t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d normal = tetrahedron(target, triangles, t).col(2).normalized();
    const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    const Eigen::Matrix3d change = wanted[t].gradient - Eigen::Matrix3d::Identity();
    sum += wanted[t].weight * (gradients[t] - change * plane).squaredNorm();
  }
  return sum;
}

/// Squared jumps of displacement gradients across edges with a triangle outside of `selected`.
double jumps(const std::vector<int>& selected, const Positions& target, const Triangles& triangles,
             const Positions& found) {
  const auto gradients = displacement_gradients(target, triangles, found);
  const auto neighbors = triangle_neighbors(static_cast<int>(target.rows()), triangles);
  std::vector<bool> in_l(triangles.rows(), false);
  for (const int t : selected) in_l[t] = true;
  double sum = 0;
  for (int t = 0; t < triangles.rows(); ++t) {
    for (const int other : neighbors[t]) {
      if (other < t || (in_l[t] && in_l[other])) continue;
      sum += (gradients[t] - gradients[other]).squaredNorm();
    }
  }
  return sum;
}

TEST_F(LiteralVertexTransfer, WithSmoothnessIsTheMinimumOfTheEnergy) {
  VertexTransferOptions options;
  options.outside = Outside::identity;
  options.outside_weight = 0.2;
  options.outside_smoothness = 0.7;
  const Positions found = transferred(half_, options);
  const std::vector<Wanted> wanted = wanted_gradients(pose_, half_, 0.2);
  const auto energy = [&](const Positions& p) {
    return misfit(wanted, target_, triangles_, p) + 0.7 * jumps(half_, target_, triangles_, p);
  };
  // The energy is quadratic: central differences give its gradient exactly but for rounding of an
  // energy near 10, divided by the step.
  constexpr double kStep = 0.1;
  for (int v = 0; v < 81; v += 4) {
    Positions up = found, down = found;
    up(v, v % 3) += kStep;
    down(v, v % 3) -= kStep;
    EXPECT_NEAR((energy(up) - energy(down)) / (2 * kStep), 0, 1e-11) << v;
  }
}

}  // namespace
}  // namespace mimetra
