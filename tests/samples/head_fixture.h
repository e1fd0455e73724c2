#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "samples/head/head.h"
#include "samples/head/head_grid.h"
#include "samples/head/head_shape.h"
#include "toolkit/mesh/inspection.h"

namespace mimetra::test {

/// Sound triangles of real faces go down to 4e-3 (kDegenerateQuality is a thousandth of this).
constexpr double kFewestQuality = 1e-3;

/// The head is always the same: made once for all tests.
inline const MorphableModel& head() {
  static const MorphableModel model = samples::parametric_head();
  return model;
}

/// Where the head's vertices, in the same order, lie in the terms of its formulas.
inline const samples::HeadGrid& grid() {
  static const samples::HeadGrid result = samples::head_grid();
  return result;
}

inline samples::HeadVertex::Part part_of(int vertex) {
  return grid().vertices[static_cast<std::size_t>(vertex)].part;
}

/// On the teeth, the tongue or behind the lips.
inline bool is_inside_the_mouth(int vertex) {
  using Part = samples::HeadVertex::Part;
  return part_of(vertex) == Part::mouth || part_of(vertex) == Part::teeth ||
         part_of(vertex) == Part::tongue;
}

/// The vertices above and below a cut in the skin, column by column.
using Edges = std::vector<std::pair<int, int>>;

/// The cut in row `row`, from column `from` to `to` in the parameter u.
inline Edges edges(double row, double from, double to) {
  std::map<double, std::pair<int, int>> by_column;
  for (int v = 0; v < head().vertices(); ++v) {
    const samples::HeadVertex& vertex = grid().vertices[static_cast<std::size_t>(v)];
    const bool skin = vertex.part == samples::HeadVertex::Part::skin;
    if (!skin || vertex.rim == 0 || vertex.v != row) continue;
    if (vertex.u < from || vertex.u > to) continue;
    auto& [above, below] = by_column[vertex.u];
    (vertex.rim > 0 ? above : below) = v;
  }
  Edges result;
  for (const auto& [u, pair] : by_column) result.push_back(pair);
  return result;
}

inline Edges mouth_edges() {
  return edges(samples::kMouthRow, -1, 1);
}

/// `eye` 1 for the head's left one, -1 for its right one.
inline Edges eye_edges(int eye) {
  return eye > 0 ? edges(samples::kEyeRow, 0, 1) : edges(samples::kEyeRow, -1, 0);
}

/// Distance between the two sides of a cut at each of its columns.
inline std::vector<double> gaps(const Positions& positions, const Edges& cut) {
  std::vector<double> result;
  for (const auto& [above, below] : cut) {
    result.push_back((positions.row(above) - positions.row(below)).norm());
  }
  return result;
}

inline Eigen::Vector3d corner(const Positions& positions, int triangle, int corner) {
  return positions.row(head().connectivity().triangles(triangle, corner));
}

inline Eigen::Vector3d normal(const Positions& positions, int triangle) {
  const Eigen::Vector3d a = corner(positions, triangle, 0);
  return (corner(positions, triangle, 1) - a).cross(corner(positions, triangle, 2) - a);
}

inline double worst_quality(const Positions& positions) {
  double worst = 1;
  for (int t = 0; t < head().connectivity().triangles.rows(); ++t) {
    worst = std::min(worst, triangle_quality(corner(positions, t, 0), corner(positions, t, 1),
                                             corner(positions, t, 2)));
  }
  return worst;
}

/// Triangles whose normal turns by a right angle or more.
inline int flipped(const Positions& before, const Positions& after) {
  int count = 0;
  for (int t = 0; t < head().connectivity().triangles.rows(); ++t) {
    count += normal(before, t).dot(normal(after, t)) <= 0;
  }
  return count;
}

/// Displacements (N x 3) of one shape of a basis.
inline Positions field(const ShapeBasis& basis, int shape) {
  return Eigen::Map<const Positions>(basis.displacements.col(shape).data(), head().vertices(), 3);
}

inline Positions field(const std::string& expression) {
  return field(head().expressions(), head().expressions().find(expression));
}

/// The vertex at the mirror image (x to -x) of each vertex, -1 where there is none.
inline std::vector<int> mirror_vertices() {
  const Positions& mean = head().mean();
  std::map<std::tuple<double, double, double>, int> at;
  for (int v = 0; v < mean.rows(); ++v) at[{mean(v, 0), mean(v, 1), mean(v, 2)}] = v;
  std::vector<int> result;
  for (int v = 0; v < mean.rows(); ++v) {
    const auto found = at.find({-mean(v, 0), mean(v, 1), mean(v, 2)});
    result.push_back(found == at.end() ? -1 : found->second);
  }
  return result;
}

}  // namespace mimetra::test
