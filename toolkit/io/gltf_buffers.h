#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace mimetra {

struct GltfBuffer {
  std::string bytes;
  std::optional<std::filesystem::path> file;  ///< none for bytes that stand in the glTF file itself
  std::string missing = {};                   ///< what to say where there is no such file
};

/// The buffer that `uri` of the glTF file `path` names: base64 data, or a file in the folder of
/// `path`; links may lead to the folder that `path` itself leads to. Throws IoError, also for what
/// lies elsewhere.
GltfBuffer read_gltf_buffer(const std::string& path, const std::string& uri);

}  // namespace mimetra
