#pragma once

#include <filesystem>
#include <vector>

#include "toolkit/mesh/fields.h"

namespace mimetra {

/// The properties of vertices and faces in one of OpenMesh's own files (.om) that are numbers:
/// integers, bool, float, double, and vectors of two to four. Others are left out. `connectivity`
/// is that of the file. Throws IoError.
std::vector<Field> read_om_fields(const std::filesystem::path& path,
                                  const Connectivity& connectivity);

}  // namespace mimetra
