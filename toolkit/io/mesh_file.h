#pragma once

#include <filesystem>
#include <string>

#include <mimetra/mesh/tri_mesh.h>

namespace mimetra {

/// Reads one mesh by its extension: .obj, .ply (ascii, binary little and big endian), .off, .stl
/// (ascii and binary; corners at one place become one vertex, in order of first use). Vertices and
/// polygons keep the file's order and count, whatever the surface looks like. Throws IoError.
TriMesh read_mesh(const std::filesystem::path& path);

/// Reads the positions of a further file of the same mesh and compares its faces with `expected`.
/// For STL, corners are gathered by `expected`'s triangles, so that vertices which part or meet in
/// this frame stay what they are. Throws IoError; MismatchError where the vertex count or a face
/// differs; `expected_path` is the file that the message compares with.
Positions read_positions(const std::filesystem::path& path, const Connectivity& expected,
                         const std::filesystem::path& expected_path);

struct MeshWriteOptions {
  /// Coordinates in double precision: binary doubles in PLY, the shortest digits that read back
  /// equal in text formats; float otherwise. STL knows float only.
  bool double_precision = false;
  /// Extension (".ply") of the format to write; empty for the path's own. For paths whose extension
  /// says nothing, such as PendingOutput's.
  std::string extension = {};
};

/// Writes one mesh by its extension with its own polygons: .obj (with texture coordinates and
/// groups), .ply (binary little endian), .off, .stl (binary, triangles). Throws OutputError. Not
/// atomic: see PendingOutput.
void write_mesh(const std::filesystem::path& path, const PositionsView& positions,
                const Connectivity& connectivity, const MeshWriteOptions& = {});
void write_mesh(const std::filesystem::path& path, const TriMesh& mesh,
                const MeshWriteOptions& = {});

/// True for an extension (".obj") that read_mesh knows, in any case.
bool is_mesh_extension(const std::string& extension);

}  // namespace mimetra
