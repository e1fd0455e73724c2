#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {

// Files and other texts that parameters name.

/// Reads positions from the mesh file `path`. Throws IoError, and MismatchError for other vertices
/// or faces than the sequence's.
Positions read_rest(const std::string& path, const FrameSource& sequence);

/// A motion as recorded in align's manifest.
struct KeptMotion {
  std::vector<RigidTransform> transforms;
  /// Extent of the aligned sequence's rest pose along each axis; earlier manifests have none.
  std::optional<Eigen::Vector3d> extent = {};
  /// Number of vertices, and positions of the spread_vertices() in the rest pose (8 x 3). Earlier
  /// manifests have neither.
  int vertices = 0;
  std::optional<Positions> places = {};
};

/// Returns 8 vertices at even steps of a mesh's numbers, from the first to the last. Small meshes
/// repeat some.
std::vector<VertexIndex> spread_vertices(int vertices);

/// Reads a motion of `frames` frames. Throws IoError, MismatchError.
KeptMotion read_motion(const std::string& path, int frames);

/// Declares --only or --without. They select vertices by connected part, by the OBJ groups or
/// materials of their faces, by a field, or from a list in a file.
Parameter vertex_set_parameter(std::string name, std::string help);

/// Returns the vertices (N) that `text` describes. `text` is `component:0,2` (connected components,
/// the largest surface is 0), `group:NAME`, `material:NAME`, `field:NAME` (not zero), each with
/// several names between commas. Otherwise it is a file with a vertex list for read_regions().
/// Throws MismatchError for an unknown name, with the known ones, and what read_regions() throws.
std::vector<bool> named_vertices(const std::string& text, const FieldSequence& sequence);

/// Sets parameters from a JSON file with an object of names and values. Throws IoError if the file
/// cannot be read, UsageError for an unknown name or a value out of range.
void set_from_file(const std::string& path, Parameters& parameters);

}  // namespace mimetra
