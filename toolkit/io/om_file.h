#pragma once

#include <filesystem>

#include "toolkit/io/fields_read.h"
#include "toolkit/mesh/context.h"

namespace mimetra {

/// The properties of vertices and faces in one of OpenMesh's own files (.om) that are numbers:
/// integers, bool, float, double, and vectors of two to four; others are left out. `connectivity`
/// is that of the file. Throws IoError, Cancelled.
FieldsRead read_om_fields(const std::filesystem::path& path, const Connectivity& connectivity,
                          const Context& context = {});

}  // namespace mimetra
