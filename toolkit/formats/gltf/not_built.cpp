#include "toolkit/formats/gltf/gltf_format.h"
#include "toolkit/formats/gltf/scene.h"
#include "toolkit/mesh/errors.h"

// In place of the other sources of this folder.

namespace mimetra {
namespace fs = std::filesystem;
namespace {

constexpr const char* kNotBuilt =
    "glTF is not built into this program; build it with -DMIMETRA_GLTF=ON";

OpenSequence refuse_to_open(const fs::path& path, const ReadOptions&, const Context&) {
  throw IoError(path.string(), kNotBuilt);
}

ReadValue refuse_to_read(const std::string& text, const ReadOptions&, const Context&) {
  throw IoError(text, kNotBuilt);
}

Format::Paths refuse_to_write(const Data&, const fs::path& target, const WriteOptions&,
                              const Context&) {
  throw OutputError(target.string(), kNotBuilt);
}

}  // namespace

Scene read_gltf(const fs::path& path, const Context&) {
  throw IoError(path.string(), kNotBuilt);
}

std::vector<Format> gltf_formats() {
  Format sequence{.name = "glTF 2.0 (not built)",
                  .extensions = {".glb", ".gltf", ".vrm"},
                  .write = refuse_to_write,
                  .open = refuse_to_open};
  Format model{.name = sequence.name,
               .kind = DataKind::model,
               .extensions = sequence.extensions,
               .read = refuse_to_read,
               .write = refuse_to_write};
  return {std::move(sequence), std::move(model)};
}

}  // namespace mimetra
