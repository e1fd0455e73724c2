#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "toolkit/io/gltf_document.h"
#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// What a primitive's compressed mesh holds.
struct DracoMesh {
  Triangles triangles;
  Frames positions;               ///< N x 3
  std::optional<Frames> texture;  ///< N x 2
};

/// Decodes `bytes` with the attributes that `draco` names. `what` names the mesh in messages.
/// Throws IoError, also where this program was built without the library.
DracoMesh decode_draco(const std::string& path, const std::string& what, const GltfDraco& draco,
                       std::string_view bytes);

}  // namespace mimetra
