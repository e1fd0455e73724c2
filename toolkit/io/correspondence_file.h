#pragma once

#include <filesystem>
#include <string>

#include "toolkit/correspondence/correspondence.h"

namespace mimetra {

/// Text of a .json file: the pairs of triangles, each target triangle's distance from the deformed
/// source, and hashes of both meshes' faces. The hashes let the reader refuse pairs of other
/// meshes.
std::string correspondence_json(const Correspondence& pairs, const Connectivity& source,
                                const Connectivity& target);

/// Reads pairs of triangles for these meshes. Weights and distances equal the written ones exactly.
/// Throws IoError, and MismatchError if the file was made for other faces.
Correspondence read_correspondence(const std::filesystem::path& path, const Connectivity& source,
                                   const Connectivity& target);

}  // namespace mimetra
