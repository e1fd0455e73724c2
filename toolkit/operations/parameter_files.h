#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {

// What parameters name, by a path or otherwise.

/// Positions of `path` (a mesh file), checked against a sequence's vertex count. Throws IoError,
/// MismatchError.
Positions read_rest(const std::string& path, const FrameSource& sequence);

/// A motion as align's manifest keeps it.
struct KeptMotion {
  std::vector<RigidTransform> transforms;
  /// Of the box around the aligned sequence's rest pose; earlier manifests have none.
  std::optional<Eigen::Vector3d> extent = {};
  /// How many vertices it has, and places of its rest pose (8 x 3), by spread_vertices(); earlier
  /// manifests have none.
  int vertices = 0;
  std::optional<Positions> places = {};
};

/// Vertices at even steps of a mesh's numbers, the first and the last among them: 8, or some twice.
std::vector<VertexIndex> spread_vertices(int vertices);

/// Of `frames` frames. Throws IoError, MismatchError.
KeptMotion read_motion(const std::string& path, int frames);

/// --only and --without: vertices by the part of the mesh that they lie on, by a name that an OBJ
/// file gives their faces, by a field, or listed in a file.
Parameter vertex_set_parameter(std::string name, std::string help);

/// The vertices (N) that `text` names: `component:0,2` (connected components, the largest surface
/// is 0), `group:NAME`, `material:NAME`, `field:NAME` (not zero), each with several names between
/// commas, or a file with a vertex list as read_regions() takes it. Throws MismatchError for a name
/// that is not there, with those that are; what read_regions() throws.
std::vector<bool> named_vertices(const std::string& text, const FieldSequence& sequence);

/// Sets parameters from a JSON file, an object of their names and values. Throws IoError where it
/// cannot be read, UsageError for an unknown name or a value out of range.
void set_from_file(const std::string& path, Parameters& parameters);

}  // namespace mimetra
