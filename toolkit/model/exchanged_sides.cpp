#include "toolkit/model/exchanged_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>

#include <Eigen/Geometry>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/model/expression_names.h"

namespace mimetra {

namespace {

using Point = Eigen::RowVector3d;

/// Where an expression moves: vertices by their squared motion.
struct Place {
  Point centre = Point::Zero();
  bool moves = false;
};

/// Squared motion of each vertex (N) in expression `j`.
Eigen::VectorXd squared_motion(const ShapeBasis& expressions, int j) {
  const auto field = expressions.displacements.col(j);
  const Eigen::Map<const Positions> moves(field.data(), field.size() / 3, 3);
  return moves.rowwise().squaredNorm();
}

Place place_of(const Positions& neutral, const Eigen::VectorXd& motion) {
  const double all = motion.sum();
  if (all <= 0) return {};
  return {motion.transpose() * neutral / all, true};
}

/// Where the moving surface looks: outwards, as it bulges there. Zero where it looks to all sides;
/// of two faces 0.51 and 0.58 of it looks to one.
Point front_of(const Positions& neutral, const Triangles& triangles,
               const Eigen::VectorXd& motion) {
  const Positions normals = triangle_normals(neutral, triangles);
  const Eigen::VectorXd areas = normals.rowwise().norm();
  const auto corners = [&](int c) { return neutral(triangles.col(c), Eigen::all); };
  const Positions middles = (corners(0) + corners(1) + corners(2)) / 3;
  const Point centre = areas.transpose() * middles / areas.sum();
  const double bulge = (middles.rowwise() - centre).cwiseProduct(normals).sum();
  const Eigen::VectorXd share =
      motion(triangles.col(0)) + motion(triangles.col(1)) + motion(triangles.col(2));
  const Point front = (bulge < 0 ? -1 : 1) * share.transpose() * normals;
  constexpr double kToOneSide = 0.3;
  return front.norm() < kToOneSide * share.dot(areas) ? Point::Zero() : front;
}

/// From the mouth to the eyes; nothing where names do not tell.
std::optional<Point> up_of(const std::vector<std::string>& names,
                           const std::vector<Place>& places) {
  constexpr std::array<std::string_view, 5> kAbove = {"brow", "blink", "squint", "eyewide", "lid"};
  constexpr std::array<std::string_view, 4> kBelow = {"jaw", "mouth", "lip", "chin"};
  const auto middle_of = [&](const auto& words) -> Place {
    Place sum;
    int count = 0;
    for (std::size_t j = 0; j < names.size(); ++j) {
      const std::string name = folded_name(names[j]);
      const bool named = std::ranges::any_of(
          words, [&](std::string_view word) { return name.find(word) != std::string::npos; });
      if (!named || !places[j].moves) continue;
      sum.centre += places[j].centre;
      ++count;
    }
    if (count == 0) return {};
    return {sum.centre / count, true};
  };
  const Place above = middle_of(kAbove), below = middle_of(kBelow);
  if (!above.moves || !below.moves) return std::nullopt;
  return above.centre - below.centre;
}

}  // namespace

ExchangedSides exchanged_sides(const Positions& neutral, const Triangles& triangles,
                               const ShapeBasis& expressions) {
  constexpr double kApart = 0.02;
  const std::vector<std::array<int, 2>> pairs = known_pairs(expressions.names);
  if (pairs.empty() || triangles.rows() == 0) return {};
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(neutral.rows());
  std::vector<Place> places;
  places.reserve(expressions.names.size());
  for (int j = 0; j < expressions.size(); ++j) {
    const Eigen::VectorXd of_this = squared_motion(expressions, j);
    places.push_back(place_of(neutral, of_this));
    motion += of_this;
  }
  const auto place = [&](int j) -> const Place& { return places[static_cast<std::size_t>(j)]; };

  Point most = Point::Zero();
  for (const auto& [left, right] : pairs) {
    if (place(left).moves && place(right).moves) most += place(left).centre - place(right).centre;
  }
  const std::optional<Point> up = up_of(expressions.names, places);
  const Point front = front_of(neutral, triangles, motion);
  const bool knows_left = up && front.norm() > 0;
  const Point to_left = knows_left ? up->cross(front) : most;
  if (to_left.norm() == 0) return {};
  const Point axis = to_left.normalized();
  const double least = kApart * diameter(neutral, triangles);
  ExchangedSides sides;
  std::size_t apart = 0;
  for (const auto& [left, right] : pairs) {
    if (!place(left).moves || !place(right).moves) continue;
    const double ahead = (place(left).centre - place(right).centre).dot(axis);
    if (std::abs(ahead) < least) continue;
    ++apart;
    if (ahead < 0) sides.left_halves.push_back(expressions.names[static_cast<std::size_t>(left)]);
  }
  sides.everywhere = knows_left && 2 * sides.left_halves.size() > apart;
  return sides;
}

}  // namespace mimetra
