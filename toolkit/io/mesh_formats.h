#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <mimetra/mesh/tri_mesh.h>

/// One reader and one writer for each mesh format, on bytes in memory. Internal to mesh_file.h,
/// which chooses among them and checks what they return.
namespace mimetra {

/// What a mesh file says, before anybody has checked that it makes sense.
struct MeshContent {
  std::vector<double> coordinates;  ///< x y z of each vertex
  Polygons polygons;
  TextureCoordinates texture;
  std::vector<FaceGroup> groups;
  /// Line of each face in a text file; empty where lines mean nothing.
  std::vector<int> face_lines;
  /// How the format counts vertices, for messages: 1 for OBJ.
  int first_index = 0;
};

/// Throw IoError that names `path` and the line or the element.
MeshContent read_obj(const std::string& path, std::string_view bytes);
MeshContent read_ply(const std::string& path, std::string_view bytes);
MeshContent read_off(const std::string& path, std::string_view bytes);
/// The corners of all triangles, one after the other, not welded (x y z each).
std::vector<double> read_stl_corners(const std::string& path, std::string_view bytes);

/// The bytes of a file. Coordinates are floats unless `double_precision`.
std::string obj_bytes(const PositionsView& positions, const Connectivity& connectivity,
                      bool double_precision);
std::string ply_bytes(const PositionsView& positions, const Connectivity& connectivity,
                      bool double_precision);
std::string off_bytes(const PositionsView& positions, const Connectivity& connectivity,
                      bool double_precision);
std::string stl_bytes(const PositionsView& positions, const Connectivity& connectivity);

/// Appends the shortest digits that read back equal, as float or as double.
void append_number(std::string& text, double value, bool double_precision);
void append_integer(std::string& text, long long value);

}  // namespace mimetra
