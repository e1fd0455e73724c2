#include "toolkit/model/expression_notes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include <Eigen/Geometry>

#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/whole_motion.h"
#include "toolkit/model/expression_names.h"

namespace mimetra {

double least_move(const Positions& from, const Eigen::Ref<const Positions>& to,
                  const Triangles& triangles) {
  const std::vector<VertexIndex> used = used_vertices(triangles, from.rows());
  if (used.empty()) return 0;
  double least2 = std::numeric_limits<double>::infinity();
  for (const VertexIndex v : used)
    least2 = std::min(least2, (to.row(v) - from.row(v)).squaredNorm());
  return std::sqrt(least2);
}

namespace {

/// Displacement of the vertices (N x 3) by expression `j`.
PositionsView field_of(const ShapeBasis& expressions, int j) {
  return {expressions.displacements.col(j).data(), expressions.displacements.rows() / 3, 3};
}

/// Whether the common part of the vertices' motion (N x 3) exceeds the differences between them.
bool moves_aside(const Positions& moves) {
  const Eigen::RowVector3d common = moves.colwise().mean();
  const double rest = (moves.rowwise() - common).squaredNorm() / static_cast<double>(moves.rows());
  return common.squaredNorm() > rest;
}

/// Whether a face is turned or scaled more than any expression does. A jaw that opens turns it by 6
/// degrees and makes it larger by 7 %.
bool is_turned_or_scaled(const Positions& neutral, const Positions& moves) {
  constexpr double kTurned = 10, kScaled = 0.2;
  const WholeMotion whole = whole_motion(neutral, neutral + moves);
  return (whole.moves() && whole.angle > kTurned) ||
         (whole.is_scaled() && std::abs(whole.scale - 1) > kScaled);
}

}  // namespace

std::vector<std::string> displaced_expressions(const Positions& neutral, const Triangles& triangles,
                                               const ShapeBasis& expressions) {
  const double least = kStillShare * diameter(neutral, triangles);
  const std::vector<VertexIndex> used = surface_vertices(neutral, triangles);
  const Positions face = neutral(used, Eigen::all);
  std::vector<std::string> displaced;
  for (int j = 0; j < expressions.size(); ++j) {
    const Positions moves = field_of(expressions, j)(used, Eigen::all);
    const bool is_aside =
        moves.rowwise().squaredNorm().minCoeff() > least * least && moves_aside(moves);
    if (is_aside || is_turned_or_scaled(face, moves)) {
      displaced.push_back(expressions.names[static_cast<std::size_t>(j)]);
    }
  }
  return displaced;
}

std::vector<std::string> torn_expressions(const Positions& neutral, const Triangles& triangles,
                                          const ShapeBasis& expressions) {
  constexpr double kTurned = 0.1;
  const Triangles sound = with_area(neutral, triangles);
  if (sound.rows() == 0) return {};
  const StrayVertices strays(neutral, sound);
  const Positions normals = triangle_normals(neutral, sound);
  const Eigen::VectorXd areas = normals.rowwise().norm();
  const double size = diameter(neutral, triangles);
  std::vector<std::string> torn;
  for (int j = 0; j < expressions.size(); ++j) {
    const Positions pose = neutral + field_of(expressions, j);
    const Eigen::VectorXd along =
        triangle_normals(pose, sound).cwiseProduct(normals).rowwise().sum();
    const double turned = (along.array() < 0).select(areas, 0).sum();
    VertexIndex farthest = 0;
    const double distance =
        strays.distances(PositionsView(pose.data(), pose.rows(), 3)).maxCoeff(&farthest);
    if (turned > kTurned * areas.sum() || strays.is_torn_off(farthest, distance, size)) {
      torn.push_back(expressions.names[static_cast<std::size_t>(j)]);
    }
  }
  return torn;
}

namespace {

using Point = Eigen::RowVector3d;

/// Place that an expression moves: the centroid of the vertices, weighted by squared motion.
struct Place {
  Point centre = Point::Zero();
  bool moves = false;
};

Place place_of(const Positions& neutral, const Eigen::VectorXd& motion) {
  const double all = motion.sum();
  if (all <= 0) return {};
  return {motion.transpose() * neutral / all, true};
}

/// Direction that the moving surface faces, outwards because the surface bulges that way. Zero if
/// it faces all sides; on two measured faces the direction has 0.51 and 0.58 of the area.
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

/// Direction from the mouth to the eyes; nullopt if the names do not show it.
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
    const Eigen::VectorXd of_this = field_of(expressions, j).rowwise().squaredNorm();
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

namespace {

std::string described(const ExchangedSides& sides) {
  const std::string these = listed(sides.left_halves);
  if (sides.everywhere) {
    return "expressions of the left move the face's right: " + these +
           "; the face is mirrored, as by an export with one axis negated, or left is the "
           "viewer's: "
           "on another face, left and right would be exchanged";
  }
  return "expressions of the left move the side that the others call right: " + these +
         "; exchange them with their other halves";
}

/// Expressions whose names differ in spelling only: "'a_L' and 'aLeft'".
std::vector<std::string> written_twice(const std::vector<std::string>& names) {
  std::map<std::string, std::string> first;
  std::vector<std::string> twice;
  for (const std::string& name : names) {
    const auto [known, is_new] = first.try_emplace(folded_name(spelled_out(name)), name);
    if (!is_new) twice.push_back("'" + known->second + "' and '" + name + "'");
  }
  return twice;
}

}  // namespace

std::vector<std::string> notes_on_expressions(const std::string& name, const Positions& neutral,
                                              const Triangles& triangles,
                                              const ShapeBasis& expressions) {
  std::vector<std::string> notes;
  const std::vector<std::string> displaced = displaced_expressions(neutral, triangles, expressions);
  if (!displaced.empty()) {
    notes.push_back(name + ": expressions of another place, turn or size than the neutral: " +
                    listed(displaced) +
                    "; every vertex of it moves as in no expression: bring them there (`mimetra "
                    "align`) and into one unit, or the face moves with them");
  }
  const std::vector<std::string> torn = torn_expressions(neutral, triangles, expressions);
  if (!torn.empty()) {
    notes.push_back(name +
                    ": expressions that tear the neutral's surface, as where their vertices "
                    "are in another order: " +
                    listed(torn) + "; give them the neutral's (`mimetra convert --match`)");
  }
  const std::vector<std::string> twice = written_twice(expressions.names);
  if (!twice.empty()) {
    notes.push_back(name + ": expressions that differ in how they are written only: " +
                    listed(twice) + "; weights with a column for one of them drive both");
  }
  const ExchangedSides sides = exchanged_sides(neutral, triangles, expressions);
  if (!sides.left_halves.empty()) notes.push_back(name + ": " + described(sides));
  return notes;
}

}  // namespace mimetra
