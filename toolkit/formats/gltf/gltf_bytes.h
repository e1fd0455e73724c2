#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

/// Bytes of a glTF file and of its buffers. Internal to the reader.
namespace mimetra {

/// JSON and binary chunk of a .glb. A .gltf is all JSON.
struct GltfChunks {
  std::string_view json;
  std::optional<std::string_view> binary;
};

/// Throws IoError if `bytes` are a .glb that is damaged or of another version.
GltfChunks gltf_chunks(const std::string& path, std::string_view bytes);

/// Bytes of a buffer, or the error message if they are missing.
struct GltfBuffer {
  std::string bytes, missing;
  std::filesystem::path file;  ///< empty for bytes within the glTF file
};

/// Reads the buffer `uri` of the glTF file `path`: base64 data, or a file in the folder of `path`.
/// Links may lead to the folder that `path` itself links to. Throws IoError, also for files
/// elsewhere.
GltfBuffer read_gltf_buffer(const std::string& path, const std::string& uri);

}  // namespace mimetra
