#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Named values on the vertices (N x c) or triangles (M x c) of a mesh, the same in every frame.
struct Field {
  enum class Location { vertices, triangles };

  std::string name;
  Location location = Location::vertices;
  Eigen::MatrixXd values;
  /// Written as 32-bit integers: indices, counts and masks.
  bool integer = false;
};

/// A sequence and what is shown on it.
struct FieldSequence {
  MeshSequence sequence;
  std::vector<Field> fields;
  /// Also write `displacement` (vector) and `displacement_length` per frame, from the rest pose.
  bool displacement = false;
};

}  // namespace mimetra
