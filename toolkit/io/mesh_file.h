#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "toolkit/io/mesh_formats.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

class MeshLayout;
struct MeshFrame;

/// Reads one mesh by its extension: .obj, .ply (ascii, binary little and big endian), .off, .om
/// (OpenMesh's own), .stl (ascii and binary; corners at one place become one vertex, in order of
/// first use). Vertices and polygons keep the file's order and count, whatever the surface looks
/// like. Throws IoError, Cancelled.
TriMesh read_mesh(const std::filesystem::path& path, const Context& context = {});

/// Reads the positions of a further file of the same mesh and compares its faces with `expected`.
/// For STL, corners are gathered by `expected`'s triangles, so that vertices which part or meet in
/// this frame stay what they are. Throws IoError; MismatchError if the vertex count or a face
/// differs; Cancelled. `expected_path` is the file that the message compares with.
Positions read_positions(const std::filesystem::path& path, const Connectivity& expected,
                         const std::filesystem::path& expected_path, const Context& context = {});

/// Reads the files of one mesh: the first one whole, of a further one only what is new in it.
///
/// Of a further file the positions are parsed and what faces depend on is compared with the first
/// file, byte by byte; where that differs, the file is read as by read_positions(). Positions
/// and errors are the same either way. Queries may run from several threads.
class MeshFileReader {
 public:
  /// Throws as read_mesh.
  explicit MeshFileReader(std::filesystem::path first, const Context& context = {});
  ~MeshFileReader();

  const std::filesystem::path& first() const { return first_; }
  const TriMesh& mesh() const { return mesh_; }
  /// The positions of a further file (N x 3). Throws as read_positions.
  Positions read(const std::filesystem::path& path) const;
  /// The same into x y z of each vertex, such as a row of Frames; undefined where it throws. \pre
  /// 3N coordinates
  void read(const std::filesystem::path& path, std::span<double> coordinates) const;

 private:
  std::filesystem::path first_;
  TriMesh mesh_;
  std::unique_ptr<const MeshLayout> layout_;
};

/// What a folder of files in a format has a place for.
HeldParts parts_held_by(MeshFormat format);

struct MeshWriteOptions {
  /// Coordinates in double precision: binary doubles in PLY, the shortest digits that read back
  /// equal in text formats; float otherwise. STL knows float only.
  bool double_precision = false;
  /// Extension (".ply") of the format to write; empty for the path's own. For paths whose extension
  /// says nothing, such as PendingOutput's.
  std::string extension = {};
  /// As properties of .om; of other formats none are written.
  std::vector<Field> fields = {};

  static constexpr Option kDoublePrecision{"double_precision", &MeshWriteOptions::double_precision};
  static constexpr auto declared() { return std::tuple(kDoublePrecision); }
};

/// Writes one mesh by its extension with its own polygons: .obj (with texture coordinates and
/// groups; not with the library of its materials, which a sequence has beside it), .ply (binary
/// little endian, with texture coordinates), .off, .om (with texture coordinates), .stl (binary,
/// triangles). Throws OutputError, MismatchError for values that the precision or the format
/// cannot hold, Cancelled. Not atomic: see PendingOutput.
void write_mesh(const std::filesystem::path& path, const PositionsView& positions,
                const Connectivity& connectivity, const MeshWriteOptions& = {},
                const Context& context = {});
void write_mesh(const std::filesystem::path& path, const TriMesh& mesh,
                const MeshWriteOptions& = {}, const Context& context = {});

/// Writes poses of one mesh, each to a file of its own. What the files have in common is made once.
/// Files may be written from several threads.
class MeshFileWriter {
 public:
  /// `extension` and `fields` as in MeshWriteOptions; throws std::invalid_argument for one that is
  /// not a mesh format, MismatchError that begins with `name` for what .om cannot hold.
  MeshFileWriter(const Connectivity& connectivity, const std::string& extension,
                 bool double_precision = false, const std::vector<Field>& fields = {},
                 const std::string& name = "the mesh", const Context& context = {});
  ~MeshFileWriter();

  /// Writes what write_mesh() writes. Throws OutputError; MismatchError that names a vertex whose
  /// coordinate single precision would make infinite; std::invalid_argument unless `positions` are
  /// as many as the connectivity's vertices.
  void write(const std::filesystem::path& path, const PositionsView& positions) const;

 private:
  int vertices_;
  bool single_precision_;
  std::unique_ptr<const MeshFrame> frame_;
};

}  // namespace mimetra
