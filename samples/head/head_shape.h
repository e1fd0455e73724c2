#pragma once

#include "samples/head/head_grid.h"

namespace mimetra::samples {

/// Distance of each eyelid's edge from the line on which the lids meet, halfway between the corners
/// of the eye, in mm.
struct Eyelids {
  double upper = 9.8;
  double lower = 1.2;
};

/// Rest positions of the grid's vertices with the given eyelids, mm.
Positions head_positions(const HeadGrid& grid, const Eyelids& left = {}, const Eyelids& right = {});

}  // namespace mimetra::samples
