#pragma once

#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// What to say about a model's expressions under its `name`: displaced_expressions(),
/// torn_expressions(), exchanged_sides() and those that are written in two ways. Nothing where all
/// is as expected.
std::vector<std::string> notes_on_expressions(const std::string& name, const Positions& neutral,
                                              const Triangles& triangles,
                                              const ShapeBasis& expressions);

}  // namespace mimetra
