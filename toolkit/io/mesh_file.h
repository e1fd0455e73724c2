#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Reads one mesh by its extension: .obj, .ply (ascii, binary little and big endian), .off, .om
/// (OpenMesh's own), or .stl (ascii and binary). STL corners at the same position become one
/// vertex, in order of first use. Vertices and polygons keep the file's order and count, whatever
/// the surface looks like. Throws IoError, Cancelled.
TriMesh read_mesh(const std::filesystem::path& path, const Context& context = {});

/// Reads the positions of a further file of the same mesh and compares its faces with `expected`.
/// Faces may come in another order. STL corners are assigned to vertices by `expected`'s triangles,
/// so vertices that coincide only in this frame stay separate.
///
/// Throws IoError; MismatchError if the vertex count or a face differs, or if the corners of an STL
/// vertex lie apart; Cancelled. The message compares the file with `expected_path`.
Positions read_positions(const std::filesystem::path& path, const Connectivity& expected,
                         const std::filesystem::path& expected_path, const Context& context = {});

/// Reads the files of one mesh: the first file completely, and the positions of further ones.
///
/// In a further file, the bytes that affect faces are compared with the first file's. If they
/// differ, the file is read as by read_positions(). Positions and errors are the same either way.
/// Queries may run from several threads.
class MeshFileReader {
 public:
  /// Throws as read_mesh().
  explicit MeshFileReader(std::filesystem::path first, const Context& context = {});

  const std::filesystem::path& first() const { return first_; }
  const TriMesh& mesh() const { return mesh_; }
  /// Positions of a further file (N x 3). Throws as read_positions().
  Positions read(const std::filesystem::path& path) const;
  /// Reads the positions into x y z of each vertex, such as a row of Frames. If it throws,
  /// `coordinates` are unspecified. Throws std::invalid_argument unless there are 3N coordinates.
  void read(const std::filesystem::path& path, std::span<double> coordinates) const;

 private:
  std::filesystem::path first_;
  TriMesh mesh_;
  FurtherReader further_;
};

/// Writes one mesh with its polygons, in the format of the extension. Of the options, the precision
/// and the fields apply: coordinates are floats or, by option and never in STL, doubles.
///  - .obj, with texture coordinates and groups, but without the material library, which a sequence
///    writes beside it;
///  - .ply, binary little endian, with texture coordinates;
///  - .off;
///  - .om, with texture coordinates and the fields;
///  - .stl, binary, as triangles.
///
/// Throws OutputError, MismatchError for values that the precision or the format cannot hold,
/// Cancelled. Not atomic: see PendingOutput.
void write_mesh(const std::filesystem::path& path, const PositionsView& positions,
                const Connectivity& connectivity, const WriteOptions& = {},
                const Context& context = {});
void write_mesh(const std::filesystem::path& path, const TriMesh& mesh, const WriteOptions& = {},
                const Context& context = {});

/// Writes poses of one mesh, each to its own file. The bytes that the files share are made once.
/// Files may be written from several threads.
class MeshFileWriter {
 public:
  /// Writes files of the extension's format, such as ".ply". Throws std::invalid_argument if that
  /// is not a mesh format, and MismatchError, which begins with `name`, for data that .om cannot
  /// hold.
  MeshFileWriter(const Connectivity& connectivity, const std::string& extension,
                 bool double_precision = false, const std::vector<Field>& fields = {},
                 const std::string& name = "the mesh", const Context& context = {});
  ~MeshFileWriter();

  /// Writes the same file as write_mesh(). Throws OutputError; MismatchError for a vertex whose
  /// coordinate single precision would make infinite; std::invalid_argument unless there is one
  /// position for each vertex of the connectivity.
  void write(const std::filesystem::path& path, const PositionsView& positions) const;

 private:
  int vertices_;
  bool single_precision_;
  std::unique_ptr<const MeshFrame> frame_;
};

}  // namespace mimetra
