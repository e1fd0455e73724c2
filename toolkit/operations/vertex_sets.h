#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {

/// --only and --without: vertices by the part of the mesh that they lie on, by a name that an OBJ
/// file gives their faces, by a field, or listed in a file.
Parameter vertex_set_parameter(std::string name, std::string help);

/// The vertices (N) that `text` names: `component:0,2` (connected components, the largest surface
/// is 0), `group:NAME`, `material:NAME`, `field:NAME` (not zero), each with several names between
/// commas, or a file with a vertex list as read_regions() takes it. Throws MismatchError for a name
/// that is not there, with those that are; what read_regions() throws.
std::vector<bool> named_vertices(const std::string& text, const FieldSequence& sequence);

}  // namespace mimetra
