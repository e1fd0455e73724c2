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
  /// Written as integers, of 32 bits where they hold them: indices, counts and masks.
  bool integer = false;
};

/// A sequence, in memory or read when it is needed, and what is shown on it.
struct FieldSequence {
  FieldSequence() : FieldSequence(MeshSequence()) {}
  FieldSequence(std::shared_ptr<const FrameSource> frames, std::vector<Field> fields = {},
                bool displacement = false);
  FieldSequence(MeshSequence sequence, std::vector<Field> fields = {}, bool displacement = false);

  /// All frames in memory. Throws std::logic_error for a sequence that is read when it is needed.
  const MeshSequence& sequence() const;
  bool is_in_memory() const;

  /// Never null.
  std::shared_ptr<const FrameSource> frames;
  std::vector<Field> fields;
  /// Also write kDisplacement (vector) and kDisplacementLength per frame, from the rest pose.
  bool displacement = false;
};

constexpr const char* kDisplacement = "displacement";
constexpr const char* kDisplacementLength = "displacement_length";

/// True for a field on vertices that has the name of a displacement, or of its length.
bool is_displacement(const Field& field);

/// True unless the rest pose is the first frame, as it is to those who read the frames alone.
/// Throws what reading throws.
bool has_left_its_rest(const FrameSource& frames);

/// Has displacements written where the rest pose is read again from them, in place of fields of
/// their names.
void show_displacement(FieldSequence& sequence);

/// Whether `Integer` holds all values, rounded to whole numbers; false where one is not finite.
template <typename Integer>
bool all_are_held_by(const Eigen::MatrixXd& values) {
  const double limit = std::ldexp(1.0, std::numeric_limits<Integer>::digits);
  return (values.array().round() >= -limit && values.array().round() < limit).all();
}

/// Values of the polygons: the largest of their triangles' (M x c) in each component.
Eigen::MatrixXd on_polygons(const Eigen::MatrixXd& on_triangles, const Connectivity& connectivity);

/// Other frames in place of those of `like`: in memory where these are, otherwise read when they
/// are needed, without its fields. Throws what reading throws, Cancelled.
FieldSequence held_like(const FieldSequence& like, std::shared_ptr<const FrameSource> frames,
                        const Context& context = {});

}  // namespace mimetra
