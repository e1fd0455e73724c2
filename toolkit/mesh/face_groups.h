#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// What the statements of an OBJ file say of the faces after them.
enum class FaceGroupKind {
  group,    ///< `g` and `o`: each face is in all groups that the last statement of either names
  material  ///< `usemtl`
};

/// Faces that a file has a name for.
struct NamedFaces {
  std::string name;
  std::vector<int> faces;  ///< polygons, ascending
};

/// The groups or materials of a mesh that have faces, in the order of their first face.
std::vector<NamedFaces> named_faces(const Connectivity& connectivity, FaceGroupKind kind);

}  // namespace mimetra
