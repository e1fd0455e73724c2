#pragma once

#include <cmath>

#include "geodesic/types.h"

namespace mimetra {

/// Readers refuse coordinates from this size on (8.7e99): their cubes would not be finite.
constexpr double kCoordinateLimit = 0x1p332;

/// False for numbers of that size, infinity, and what is not a number.
inline bool is_coordinate(double value) {
  return std::abs(value) < kCoordinateLimit;
}

/// The first row of positions with a number that is no coordinate; -1 if there is none.
Eigen::Index first_unusable(const geodesic::Positions& positions);

}  // namespace mimetra
