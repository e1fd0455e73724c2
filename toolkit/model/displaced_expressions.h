#pragma once

#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Share of a face's diameter() by which no expression moves every vertex of it.
constexpr double kStillShare = 0.01;

/// The least distance between two poses of a vertex that triangles use; 0 without vertices.
double least_move(const Positions& from, const Eigen::Ref<const Positions>& to,
                  const Triangles& triangles);

/// Names of expressions that are shapes of another place, turn or size than the neutral, as where
/// they were exported side by side, with other axes or in another unit: every vertex moves by more
/// than that and all by the same more than by what differs, or whole_motion() turns it by more than
/// 10 degrees or changes its size by more than a fifth. The first components of a statistical
/// model move every vertex, but not so.
std::vector<std::string> displaced_expressions(const Positions& neutral, const Triangles& triangles,
                                               const ShapeBasis& expressions);

}  // namespace mimetra
