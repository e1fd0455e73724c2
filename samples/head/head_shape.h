#pragma once

#include "samples/head/head_grid.h"

namespace mimetra::samples {

/// How far the edge of each eyelid is from the line on which they meet, in mm, halfway between the
/// corners of the eye.
struct Eyelids {
  double upper = 9.8;
  double lower = 1.2;
};

/// Rest positions of the grid's vertices with the given eyelids.
Positions head_positions(const HeadGrid& grid, const Eyelids& left = {}, const Eyelids& right = {});

}  // namespace mimetra::samples
