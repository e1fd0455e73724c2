#include "toolkit/model/displaced_expressions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/triangle_quality.h"
#include "toolkit/mesh/whole_motion.h"

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

/// Whether vertices (N x 3) move by the same more than by what differs between them.
bool moves_aside(const Positions& moves) {
  const Eigen::RowVector3d common = moves.colwise().mean();
  const double rest = (moves.rowwise() - common).squaredNorm() / static_cast<double>(moves.rows());
  return common.squaredNorm() > rest;
}

/// Whether a face is turned or has another size, as no expression does it: a jaw that opens turns
/// it by 6 degrees and makes it larger by 7 %.
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
    const auto field = expressions.displacements.col(j);
    const Eigen::Map<const Positions> of_all(field.data(), neutral.rows(), 3);
    const Positions moves = of_all(used, Eigen::all);
    const bool is_aside =
        moves.rowwise().squaredNorm().minCoeff() > least * least && moves_aside(moves);
    if (is_aside || is_turned_or_scaled(face, moves)) {
      displaced.push_back(expressions.names[static_cast<std::size_t>(j)]);
    }
  }
  return displaced;
}

}  // namespace mimetra
