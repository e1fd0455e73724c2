#include "toolkit/model/displaced_expressions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

double least_move(const Positions& from, const Eigen::Ref<const Positions>& to,
                  const Triangles& triangles) {
  const std::vector<VertexIndex> used = used_vertices(triangles, from.rows());
  if (used.empty()) return 0;
  double least2 = std::numeric_limits<double>::infinity();
  for (const VertexIndex v : used) least2 = std::min(least2, (to.row(v) - from.row(v)).squaredNorm());
  return std::sqrt(least2);
}

namespace {

/// Whether vertices (N x 3) move by the same more than by what differs between them.
bool moves_aside(const Eigen::Ref<const Positions>& moves) {
  const Eigen::RowVector3d common = moves.colwise().mean();
  const double rest = (moves.rowwise() - common).squaredNorm() / static_cast<double>(moves.rows());
  return common.squaredNorm() > rest;
}

}  // namespace

std::vector<std::string> displaced_expressions(const Positions& neutral, const Triangles& triangles,
                                               const ShapeBasis& expressions) {
  const double least = kStillShare * diameter(neutral, triangles);
  std::vector<std::string> displaced;
  for (int j = 0; j < expressions.size(); ++j) {
    const auto field = expressions.displacements.col(j);
    const Eigen::Map<const Positions> moves(field.data(), neutral.rows(), 3);
    if (!(least_move(neutral, neutral + moves, triangles) > least) || !moves_aside(moves)) continue;
    displaced.push_back(expressions.names[static_cast<std::size_t>(j)]);
  }
  return displaced;
}

std::vector<std::string> notes_on_displaced(const std::string& name, const Positions& neutral,
                                            const Triangles& triangles,
                                            const ShapeBasis& expressions) {
  const std::vector<std::string> displaced = displaced_expressions(neutral, triangles, expressions);
  if (displaced.empty()) return {};
  return {name + ": expressions that move every vertex by more than " + percent(kStillShare) +
          " of the face's size, and all aside: " + listed(displaced) +
          "; they seem to stand elsewhere than the neutral: bring them there "
          "(`mimetra align`), or the face moves with them"};
}

}  // namespace mimetra
