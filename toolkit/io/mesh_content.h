#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/bytes.h"
#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/tri_mesh.h"

/// Readers and writers of mesh formats, on bytes in memory. Internal to the formats and to
/// mesh_file.h, which checks what they return.
namespace mimetra {

/// Content of a mesh file, not yet validated.
struct MeshContent {
  std::vector<double> coordinates;  ///< x y z of each vertex
  Polygons polygons;
  TextureCoordinates texture;
  std::vector<FaceGroup> groups;
  /// Text after each `mtllib`.
  std::vector<std::string> libraries;
  /// Line of each face in a text file; empty for formats without lines.
  std::vector<int> face_lines;
  /// Number of the first vertex in messages: 1 for OBJ.
  int first_index = 0;
};

/// Parse the bytes of a file. Throw IoError with `path` and the line or the element, and Cancelled.
MeshContent read_obj(const std::string& path, std::string_view bytes, const Context&);
MeshContent read_ply(const std::string& path, std::string_view bytes, const Context&);
MeshContent read_off(const std::string& path, std::string_view bytes, const Context&);
MeshContent read_om(const std::string& path, std::string_view bytes, const Context&);
/// Fields of a mesh file, and names of properties that are none.
struct FieldsRead {
  std::vector<Field> fields = {};
  std::vector<std::string> left_out = {};
};

/// Reads the numeric properties of vertices and faces from OpenMesh's own format (.om). These are
/// integers, bool, float, double, and vectors of 2 to 4; others are listed in `left_out`.
/// `connectivity` is the file's. Throws IoError, Cancelled.
FieldsRead read_om_fields(const std::filesystem::path& path, const Connectivity& connectivity,
                          const Context& context = {});
/// Corners of all triangles in order, not welded (x y z each). Throws as the readers above.
std::vector<double> read_stl_corners(const std::string& path, std::string_view bytes,
                                     const Context&);

/// Reports progress every 16384 lines or elements: `left` of `size` are not done yet.
inline void report_element(const Context& context, std::size_t element, std::size_t left,
                           std::size_t size) {
  constexpr std::size_t kElements = 1 << 14;
  if (element % kElements != 0 || size == 0) return;
  context.report(1 - static_cast<double>(left) / static_cast<double>(size));
}

/// Bytes of the files of one mesh, in one format and precision.
struct MeshFrame {
  std::string before;  ///< bytes before the positions
  std::string after;   ///< bytes after them
  /// Returns the bytes of the given positions. Safe to call from several threads.
  std::function<std::string(const PositionsView&)> positions;
};

/// Coordinates are floats unless `double_precision` is set or a texture coordinate needs more; STL
/// always has floats. The frame keeps no reference to the connectivity. Throw Cancelled.
MeshFrame obj_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
MeshFrame ply_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
MeshFrame off_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
MeshFrame stl_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
/// Stores the fields as properties, which the other formats cannot. Throws MismatchError for a
/// vertex or face that half-edges cannot represent, and for a field that the format cannot store.
MeshFrame om_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                   bool double_precision, const Context&);

/// Learn what further files share with the bytes of a first one, in which the format's reader found
/// `vertices` vertices. Empty if only that reader can parse the files. Throw Cancelled.
FurtherReader obj_further_reader(std::string first, std::size_t vertices, const Context&);
FurtherReader ply_further_reader(std::string first, std::size_t vertices, const Context&);
FurtherReader off_further_reader(std::string first, std::size_t vertices, const Context&);

/// False if single precision would make a texture coordinate infinite.
bool fits_single_precision(const TextureCoordinates& texture);
/// Lines "x y z", one for each vertex, each with `before` in front.
std::string position_lines(std::string_view before, const PositionsView& positions,
                           bool double_precision);

/// Bytes of x y z of each vertex, least significant byte first.
template <typename Scalar>
std::string position_bytes(const PositionsView& positions) {
  std::string bytes(sizeof(Scalar) * static_cast<std::size_t>(positions.size()), '\0');
  char* at = bytes.data();
  for (Eigen::Index vertex = 0; vertex < positions.rows(); ++vertex) {
    for (int axis = 0; axis < 3; ++axis, at += sizeof(Scalar)) {
      put_little_endian(at, static_cast<Scalar>(positions(vertex, axis)));
    }
  }
  return bytes;
}

}  // namespace mimetra
