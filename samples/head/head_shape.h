#pragma once

#include <mimetra/samples/head_grid.h>

namespace mimetra::samples {

/// How far the edge of each eyelid is from the line on which they meet, in mm, halfway between the
/// corners of the eye.
struct Eyelids {
  double upper = 9.8;
  double lower = 1.2;
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
