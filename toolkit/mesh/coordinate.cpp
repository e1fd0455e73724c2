#include "toolkit/mesh/coordinate.h"

namespace mimetra {

Eigen::Index first_unusable(const geodesic::Positions& positions) {
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    for (const double value : positions.row(v)) {
      if (!is_coordinate(value)) return v;
    }
  }
  return -1;
}

}  // namespace mimetra
