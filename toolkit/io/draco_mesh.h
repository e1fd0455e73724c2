#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/gltf_document.h"
#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Four joints of each vertex, and their weights (N x 4).
struct VertexJoints {
  Frames joints, weights;
};

/// What a primitive's compressed mesh holds, integers as they are stored: its accessors say whether
/// they are normalised. Numbers that it does not hold have no rows.
struct DracoMesh {
  Triangles triangles;
  Frames positions;  ///< N x 3
  Frames texture;    ///< N x 2
  std::vector<VertexJoints> joints;
};

/// Decodes `bytes` with the attributes that `draco` names. `what` names the mesh in messages.
/// Throws IoError, also where this program was built without the library.
DracoMesh decode_draco(const std::string& path, const std::string& what, const GltfDraco& draco,
                       std::string_view bytes);

}  // namespace mimetra
