#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_formats.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/tri_mesh.h"

/// The table of mesh formats: one reader and one writer for each, on bytes in memory. Internal to
/// mesh_file.h, which chooses among them and checks what they return.
namespace mimetra {

/// What a mesh file says, before anybody has checked that it makes sense.
struct MeshContent {
  std::vector<double> coordinates;  ///< x y z of each vertex
  Polygons polygons;
  TextureCoordinates texture;
  std::vector<FaceGroup> groups;
  /// What follows each `mtllib`.
  std::vector<std::string> libraries;
  /// Line of each face in a text file; empty where lines mean nothing.
  std::vector<int> face_lines;
  /// How the format counts vertices, for messages: 1 for OBJ.
  int first_index = 0;
};

/// Throw IoError that names `path` and the line or the element, and Cancelled.
MeshContent read_obj(const std::string& path, std::string_view bytes, const Context&);
MeshContent read_ply(const std::string& path, std::string_view bytes, const Context&);
MeshContent read_off(const std::string& path, std::string_view bytes, const Context&);
MeshContent read_om(const std::string& path, std::string_view bytes, const Context&);
/// The properties of vertices and faces in one of OpenMesh's own files (.om) that are numbers:
/// integers, bool, float, double, and vectors of two to four; others are left out. `connectivity`
/// is that of the file. Throws IoError, Cancelled.
FieldsRead read_om_fields(const std::filesystem::path& path, const Connectivity& connectivity,
                          const Context& context = {});
/// The corners of all triangles, one after the other, not welded (x y z each).
std::vector<double> read_stl_corners(const std::string& path, std::string_view bytes,
                                     const Context&);

/// Reports progress once in some thousand lines or elements: `left` of `size` are not done yet.
inline void report_element(const Context& context, std::size_t element, std::size_t left,
                           std::size_t size) {
  constexpr std::size_t kElements = 1 << 14;
  if (element % kElements != 0 || size == 0) return;
  context.report(1 - static_cast<double>(left) / static_cast<double>(size));
}

/// The bytes of all files of one mesh, in a format and a precision.
struct MeshFrame {
  std::string before;  ///< what stands before the positions
  std::string after;   ///< what stands behind them
  /// What stands between for some positions. Safe to call from several threads.
  std::function<std::string(const PositionsView&)> positions;
};

/// Coordinates are floats unless `double_precision` or a texture needs more, in STL always. No
/// reference to the connectivity is kept. Throw Cancelled.
MeshFrame obj_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
MeshFrame ply_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
MeshFrame off_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
MeshFrame stl_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                    bool double_precision, const Context&);
/// With the fields as properties, which the other formats have no place for. Throws MismatchError
/// that names a vertex or a face which half-edges cannot hold, or a field which the file cannot.
MeshFrame om_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                   bool double_precision, const Context&);

/// What the files of one mesh have in common, learnt from the first of them.
class MeshLayout {
 public:
  virtual ~MeshLayout() = default;

  /// Reads x y z of each vertex of a further file into `coordinates`. Bytes around the positions
  /// are compared with the first file's. False, with anything in `coordinates`, where they differ
  /// in what faces depend on, where a position is malformed or not finite, or where the file is
  /// written in a way that only the format's whole reader knows.
  virtual bool read(std::string_view bytes, std::span<double> coordinates) const = 0;
};

/// Learn the layout from the bytes of a first file, in which the format's reader found so many
/// vertices. Null if the file is written in a way that only that reader knows. Throw Cancelled.
std::unique_ptr<const MeshLayout> obj_layout(std::string first, std::size_t vertices,
                                             const Context&);
std::unique_ptr<const MeshLayout> ply_layout(std::string first, std::size_t vertices,
                                             const Context&);
std::unique_ptr<const MeshLayout> off_layout(std::string first, std::size_t vertices,
                                             const Context&);

/// A format, declared once.
struct MeshCodec {
  MeshFormat format;
  /// Null for STL, whose files name no vertices.
  MeshContent (*read)(const std::string& path, std::string_view bytes, const Context&);
  /// From the bytes of the first file and its vertex count; null for a format whose files have
  /// nothing in common.
  std::unique_ptr<const MeshLayout> (*layout)(std::string first, std::size_t vertices,
                                              const Context&);
  MeshFrame (*frame)(const Connectivity& connectivity, const std::vector<Field>& fields,
                     bool double_precision, const Context&);
  /// In its files; a rest pose stands beside them.
  HeldParts holds;
  /// Fields in a file; null for a format without.
  FieldsRead (*fields)(const std::filesystem::path& path, const Connectivity&,
                       const Context&) = nullptr;

  /// ".ply".
  std::string extension() const;
};

/// The format of an extension (".ply") in any case; null for one that is no mesh format.
const MeshCodec* mesh_codec(const std::string& extension);

/// False where single precision would make a texture coordinate infinite.
bool fits_single_precision(const TextureCoordinates& texture);
/// A line "x y z" for each vertex, with `before` in front of it.
std::string position_lines(std::string_view before, const PositionsView& positions,
                           bool double_precision);

/// x y z of each vertex, least significant byte first.
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
