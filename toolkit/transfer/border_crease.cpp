#include "toolkit/transfer/border_crease.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/mesh/inspection.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {

namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3d normal_of(const Edges& edges) {
  return edges.col(0).cross(edges.col(1));
}

/// By which the second normal is turned around the edge against the first, in (-pi, pi]; none
/// where one is 0.
std::optional<double> angle_between(const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                                    const Eigen::Vector3d& edge) {
  if (first.squaredNorm() == 0 || second.squaredNorm() == 0) return {};
  const Eigen::Vector3d axis = first.cross(second);
  const double angle = std::atan2(axis.norm(), first.dot(second));
  return axis.dot(edge) < 0 ? -angle : angle;
}

/// The angle between -pi and pi that is as far as another.
double turned(double angle) {
  if (angle > kPi) return angle - 2 * kPi;
  return angle <= -kPi ? angle + 2 * kPi : angle;
}

/// The edge from corner k to the next one, in [b - a, c - a].
Eigen::Vector2d side(int corner) {
  const std::array<Eigen::Vector2d, 3> sides = {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 1),
                                                Eigen::Vector2d(0, -1)};
  return sides[corner];
}

struct Side {
  int triangle;
  int corner;  // of the triangle, where the edge begins
};

}  // namespace

BorderCrease::BorderCrease(const Positions& rest, const Triangles& triangles,
                           const Eigen::VectorXd& weights, const std::vector<bool>& counts)
    : triangles_(triangles) {
  if (weights.size() == 0 || weights.minCoeff() == weights.maxCoeff()) return;
  std::map<std::pair<VertexIndex, VertexIndex>, std::vector<Side>> sides;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (!counts[t] || quality_of(rest, triangles, t) < kDegenerateQuality) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const auto ends = std::minmax(triangles(t, corner), triangles(t, (corner + 1) % 3));
      sides[{ends.first, ends.second}].push_back({t, corner});
    }
  }
  for (const auto& [ends, of_edge] : sides) {
    if (of_edge.size() != 2) continue;
    const auto [first, second] = std::pair(of_edge[0], of_edge[1]);
    const double change = std::abs(weights[first.triangle] - weights[second.triangle]);
    if (change == 0) continue;
    // Both along the edge as the first triangle has it.
    const VertexIndex from = triangles(first.triangle, first.corner);
    const bool is_opposite = triangles(second.triangle, second.corner) != from;
    Hinge hinge{first.triangle,
                second.triangle,
                from,
                triangles(first.triangle, (first.corner + 1) % 3),
                side(first.corner),
                is_opposite ? Eigen::Vector2d(-side(second.corner)) : side(second.corner),
                0,
                0};
    const Eigen::Vector3d edge = (rest.row(hinge.to) - rest.row(hinge.from)).transpose();
    const auto angle = angle_between(normal_of(edges_of(rest, triangles, hinge.first)),
                                     normal_of(edges_of(rest, triangles, hinge.second)), edge);
    hinge.weight = change * edge.norm();
    hinge.at_rest = angle.value_or(0);
    hinges_.push_back(hinge);
  }
}

BorderCrease::Excess BorderCrease::operator()(const std::vector<Edges>& wanted,
                                              const PositionsView& pose) const {
  Excess excess;
  double squares = 0, weights = 0;
  for (const Hinge& hinge : hinges_) {
    const Edges first = edges_of(pose, triangles_, hinge.first);
    const Edges second = edges_of(pose, triangles_, hinge.second);
    const Eigen::Vector3d found_edge = first * hinge.in_first;
    const auto found = angle_between(normal_of(first), normal_of(second), found_edge);
    const Edges &one = wanted[hinge.first], &other = wanted[hinge.second];
    const Eigen::Vector3d wanted_edge = one * hinge.in_first + other * hinge.in_second;
    const auto asked = angle_between(normal_of(one), normal_of(other), wanted_edge);
    if (!found || !asked) continue;
    const double bend = turned(*found - hinge.at_rest), due = turned(*asked - hinge.at_rest);
    const double same_way = std::max(0.0, bend < 0 ? -due : due);
    const double degrees = std::max(0.0, std::abs(bend) - same_way) * 180 / kPi;
    squares += hinge.weight * degrees * degrees;
    weights += hinge.weight;
    excess.largest = std::max(excess.largest, degrees);
  }
  if (weights > 0) excess.rms = std::sqrt(squares / weights);
  return excess;
}

}  // namespace mimetra
