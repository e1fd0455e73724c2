#pragma once

#include <filesystem>
#include <string>

#include "toolkit/correspondence/correspondence.h"

namespace mimetra {

/// The content of a .json file: the pairs of triangles, each target triangle's distance from the
/// deformed source, and a hash of either mesh's faces, so that pairs of other meshes are refused.
std::string correspondence_json(const Correspondence& pairs, const Connectivity& source,
                                const Connectivity& target);

/// Reads such a file for these meshes; weights and distances are those that were written, bit by
/// bit. Throws IoError; MismatchError where it was made for other faces.
Correspondence read_correspondence(const std::filesystem::path& path, const Connectivity& source,
                                   const Connectivity& target);

}  // namespace mimetra
