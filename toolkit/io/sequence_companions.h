#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mimetra {

/// Another sequence of the name of `sequence`, a part of which is what stands beside that; empty
/// where there is none.
std::filesystem::path other_of_name(const std::filesystem::path& sequence);

/// Files that stand beside a sequence which is about to be written, and that its own parts may not
/// replace: "take.rest.ply: belongs to 'take.pc2', ...". Whether it has such a part, and one with
/// another content, is known when it is written.
std::vector<std::string> refused_companions(const std::filesystem::path& sequence, bool overwrite);

/// The same of a model, regions or a table, whose parts are those of the format alone (.gltf, .pvd)
/// and, where it may be paired, a correspondence.
std::vector<std::string> refused_parts(const std::filesystem::path& file, bool overwrite,
                                       bool may_be_paired);

}  // namespace mimetra
