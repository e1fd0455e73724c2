#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include <mimetra/mesh/inspection.h>
#include <mimetra/samples/head.h>

namespace mimetra::test {

/// The head is always the same: made once for all tests.
inline const MorphableModel& head() {
  static const MorphableModel model = samples::parametric_head();
  return model;
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
