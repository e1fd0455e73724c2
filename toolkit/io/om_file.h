#pragma once

#include <filesystem>

#include "toolkit/io/fields_read.h"

namespace mimetra {

/// The properties of vertices and faces in one of OpenMesh's own files (.om) that are numbers:
/// integers, bool, float, double, and vectors of two to four; others are left out. `connectivity`
/// is that of the file. Throws IoError.
FieldsRead read_om_fields(const std::filesystem::path& path, const Connectivity& connectivity);

}  // namespace mimetra
