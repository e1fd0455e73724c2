#pragma once

#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Names of expressions that are no shapes of the neutral's surface, as where their vertices are in
/// another order: a tenth of the area is turned by more than 90 degrees (those of two faces turn
/// 0.3 % of it at most), or a vertex is_torn_off().
std::vector<std::string> torn_expressions(const Positions& neutral, const Triangles& triangles,
                                          const ShapeBasis& expressions);

}  // namespace mimetra
