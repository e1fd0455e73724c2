#include "toolkit/io/driven_model.h"
#include "toolkit/io/gltf_write.h"
#include "toolkit/io/sequence_format.h"

namespace mimetra {

SequenceFormat gltf_format() {
  SequenceFormat format{"glTF 2.0", {".glb", ".gltf"}, false, SequenceFormat::Precision::single,
                        open_scene, begin_gltf};
  // Polygons by FB_ngon_encoding.
  format.holds = {.polygons = true,
                  .texture = HeldParts::Texture::vertices,
                  .bare_faces = false,
                  .exact_times = false};
  format.write_animation = write_gltf;
  return format;
}

}  // namespace mimetra
