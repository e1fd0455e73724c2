#pragma once

#include <cmath>
#include <limits>
#include <memory>
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
  /// Writes the values as integers, with 32 bits if they fit: for indices, counts and masks.
  bool integer = false;
};

/// A sequence, in memory or read on demand, with the fields to show on it.
struct FieldSequence {
  FieldSequence() : FieldSequence(MeshSequence()) {}
  FieldSequence(std::shared_ptr<const FrameSource> frames, std::vector<Field> fields = {},
                bool displacement = false);
  FieldSequence(MeshSequence sequence, std::vector<Field> fields = {}, bool displacement = false);

  /// Sequence with all frames in memory. Throws std::logic_error if they are read on demand.
  const MeshSequence& sequence() const;
  bool is_in_memory() const;

  /// Never null.
  std::shared_ptr<const FrameSource> frames;
  std::vector<Field> fields;
  /// Whether to also write kDisplacement (vector) and kDisplacementLength per frame, relative to
  /// the rest pose.
  bool displacement = false;
};

constexpr const char* kDisplacement = "displacement";
constexpr const char* kDisplacementLength = "displacement_length";

/// Whether a field is on vertices and named kDisplacement or kDisplacementLength.
bool is_displacement(const Field& field);

/// Whether the rest pose must be written beside the frames. False if it is unknown or equals the
/// only frame. Throws whatever reading throws.
bool has_left_its_rest(const FrameSource& frames);

/// If has_left_its_rest(), sets `displacement`, from which readers recover the rest pose, and
/// removes the fields for which is_displacement() holds.
void show_displacement(FieldSequence& sequence);

/// Whether all values, rounded to whole numbers, fit into `Integer`; false if one is not finite.
template <typename Integer>
bool all_are_held_by(const Eigen::MatrixXd& values) {
  const double limit = std::ldexp(1.0, std::numeric_limits<Integer>::digits);
  return (values.array().round() >= -limit && values.array().round() < limit).all();
}

/// Values per polygon from values per triangle (M x c): their component-wise maximum.
Eigen::MatrixXd on_polygons(const Eigen::MatrixXd& on_triangles, const Connectivity& connectivity);

/// FieldSequence of `frames`, without fields. The frames are loaded into memory if those of `like`
/// are, and read on demand otherwise. Throws whatever reading throws, and Cancelled.
FieldSequence held_like(const FieldSequence& like, std::shared_ptr<const FrameSource> frames,
                        const Context& context = {});

}  // namespace mimetra
