#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "geodesic/support_map.h"

namespace mimetra::geodesic {

Eigen::VectorXd support_map(const Eigen::VectorXd& distances, double d_min, double d_max) {
  if (!(0 <= d_min && d_min < d_max && std::isfinite(d_max))) {
    throw std::invalid_argument("a support map needs 0 <= d_min < d_max, found d_min " +
                                std::to_string(d_min) + ", d_max " + std::to_string(d_max));
  }
  return distances.unaryExpr(
      [=](double distance) { return std::clamp((distance - d_min) / (d_max - d_min), 0.0, 1.0); });
}

}  // namespace mimetra::geodesic
