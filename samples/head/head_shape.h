#pragma once

#include <mimetra/samples/head_grid.h>

namespace mimetra::samples {

/// Height of the edge of each eyelid above the eye's middle, in mm, halfway between the corners.
struct Eyelids {
  double upper = 6.2;
  double lower = -4.2;
};

/// Rest positions of the grid's vertices with the given eyelids.
Positions head_positions(const HeadGrid& grid, const Eyelids& left = {}, const Eyelids& right = {});

/// Height of the line between the lips, mm.
constexpr double kMouthHeight = -66;
/// Half the distance between the corners of the mouth, mm.
constexpr double kMouthHalfWidth = 25.5;
/// Middle of the head's left eyeball, mm.
inline const Eigen::Vector3d kLeftEye{31, -0.5, 60.5};

}  // namespace mimetra::samples
