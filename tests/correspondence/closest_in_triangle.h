#pragma once

#include <algorithm>

#include <Eigen/Geometry>

namespace mimetra::test {

/// The closest point of a triangle: in its plane where the foot is inside, on its edges elsewhere.
inline Eigen::Vector3d closest_in(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                  const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  const Eigen::Vector3d foot = p - (p - a).dot(normal) * normal;
  if ((b - a).cross(foot - a).dot(normal) >= 0 && (c - b).cross(foot - b).dot(normal) >= 0 &&
      (a - c).cross(foot - c).dot(normal) >= 0) {
    return foot;
  }
  Eigen::Vector3d best = a;
  const auto try_edge = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const double share =
        std::clamp((p - from).dot(to - from) / (to - from).squaredNorm(), 0.0, 1.0);
    const Eigen::Vector3d at = from + share * (to - from);
    if ((at - p).norm() < (best - p).norm()) best = at;
  };
  try_edge(a, b);
  try_edge(b, c);
  try_edge(c, a);
  return best;
}

}  // namespace mimetra::test
