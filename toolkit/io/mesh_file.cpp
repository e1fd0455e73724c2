#include "toolkit/io/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/material_library.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/face_order.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

std::string read_bytes(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (!is_mesh_extension(extension)) {
    throw IoError(path.string(), unknown_mesh_extension(extension));
  }
  std::string bytes = read_file(path);
  if (bytes.empty()) throw IoError(path.string(), "is empty, expected a mesh");
  return bytes;
}

Positions positions_of(const std::vector<double>& coordinates) {
  return Eigen::Map<const Positions>(coordinates.data(),
                                     static_cast<Eigen::Index>(coordinates.size() / 3), 3);
}

void check_finite(const std::string& path, const std::vector<double>& coordinates,
                  const std::string& element, int first_index) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    if (is_coordinate(coordinates[i])) continue;
    throw IoError(
        path, element + " " + std::to_string(i / 3 + static_cast<std::size_t>(first_index)) +
                  " has no usable position: " + "xyz"[i % 3] + " is " + readable(coordinates[i]));
  }
}

std::string face_name(const MeshContent& content, int face) {
  std::string name = "face " + std::to_string(face + content.first_index);
  if (!content.face_lines.empty()) {
    name += " (line " + std::to_string(content.face_lines[face]) + ")";
  }
  return name;
}

void check_faces(const std::string& path, const MeshContent& content) {
  const Polygons& polygons = content.polygons;
  // Vertices, triangles and corners are counted in ints.
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 3;
  if (content.coordinates.size() / 3 > kMost || polygons.corners.size() > kMost) {
    throw IoError(path, "has " + std::to_string(content.coordinates.size() / 3) + " vertices and " +
                            std::to_string(polygons.corners.size()) +
                            " corners of faces, expected at most " + std::to_string(kMost));
  }
  const auto vertices = static_cast<int>(content.coordinates.size() / 3);
  if (polygons.size() == 0) throw IoError(path, "has no faces");
  for (int face = 0; face < polygons.size(); ++face) {
    const int first = polygons.offsets[face], last = polygons.offsets[face + 1];
    if (last - first < 3) {
      throw IoError(path, face_name(content, face) + " has " + std::to_string(last - first) +
                              " corners, expected at least 3");
    }
    for (int corner = first; corner < last; ++corner) {
      const int vertex = polygons.corners[corner];
      if (vertex >= 0 && vertex < vertices) continue;
      throw IoError(path, face_name(content, face) + " uses vertex " +
                              std::to_string(vertex + content.first_index) + ", expected " +
                              std::to_string(content.first_index) + " to " +
                              std::to_string(vertices - 1 + content.first_index));
    }
  }
}

MeshContent read_checked(const fs::path& path, std::string_view bytes, const Context& context) {
  MeshContent content =
      mesh_format(lower_extension(path))->parse_mesh(path.string(), bytes, context);
  check_finite(path.string(), content.coordinates, "vertex", content.first_index);
  check_faces(path.string(), content);
  return content;
}

std::vector<double> read_checked_corners(const fs::path& path, std::string_view bytes,
                                         const Context& context) {
  std::vector<double> corners = read_stl_corners(path.string(), bytes, context);
  if (corners.empty()) throw IoError(path.string(), "has no faces");
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 3;
  if (corners.size() / 3 > kMost) {
    throw IoError(path.string(), "has " + std::to_string(corners.size() / 9) +
                                     " triangles, expected at most " + std::to_string(kMost / 3));
  }
  check_finite(path.string(), corners, "corner", 0);
  return corners;
}

/// Numbers the vertices in the order in which the file first uses their positions.
TriMesh read_stl(const fs::path& path, std::string_view bytes, const Context& context) {
  const Positions corners = positions_of(read_checked_corners(path, bytes, context));
  const Weld weld = Weld::exact(corners);
  std::vector<int> vertex_of(weld.representative.size());
  Positions positions(corners.rows() - weld.count, 3);
  int vertices = 0;
  for (std::size_t corner = 0; corner < vertex_of.size(); ++corner) {
    const auto first = static_cast<std::size_t>(weld.representative[corner]);
    if (first == corner) {
      positions.row(vertices) = corners.row(static_cast<Eigen::Index>(corner));
      vertex_of[corner] = vertices++;
    } else {
      vertex_of[corner] = vertex_of[first];
    }
  }
  const Triangles triangles = Eigen::Map<const Triangles>(
      vertex_of.data(), static_cast<Eigen::Index>(vertex_of.size() / 3), 3);
  return {std::move(positions), Connectivity::from_triangles(vertices, triangles)};
}

[[noreturn]] void throw_mismatch(const fs::path& path, long long found, const std::string& what,
                                 long long expected, const fs::path& expected_path) {
  throw MismatchError(path.string() + ": " + std::to_string(found) + " " + what + ", expected " +
                      std::to_string(expected) + " as in " + expected_path.string());
}

/// Throws MismatchError if corners that share a vertex lie apart.
///
/// STL does not index vertices, so flipped or reordered triangles show only in shared vertices with
/// corners at several places. Lips and lids that touch in the first frame look the same, but they
/// are never most of a mesh.
void check_parting(const fs::path& path, const std::vector<int>& corners_at,
                   const std::vector<char>& parts, const fs::path& expected_path) {
  const auto shared =
      std::count_if(corners_at.begin(), corners_at.end(), [](int corners) { return corners > 1; });
  const auto parting = std::count(parts.begin(), parts.end(), 1);
  if (parting == 0) return;
  if (2 * parting < shared) {
    const auto vertex = std::find(parts.begin(), parts.end(), 1) - parts.begin();
    throw MismatchError(path.string() + ": " + std::to_string(parting) +
                        (parting == 1 ? " vertex" : " vertices") + " of " + expected_path.string() +
                        ", such as " + std::to_string(vertex) +
                        ", are at several places, as where lips or lids touch there and open here; "
                        "STL does not tell them apart: begin with a frame in which nothing "
                        "touches, or write the frames as OBJ or PLY");
  }
  throw MismatchError(path.string() + ": " + std::to_string(parting) + " of " +
                      std::to_string(shared) +
                      " shared vertices are at several places, so its triangles are not those of " +
                      expected_path.string() + "; write all frames with one order of triangles");
}

Positions gathered_corners(const fs::path& path, std::string_view bytes,
                           const Connectivity& expected, const fs::path& expected_path,
                           const Context& context) {
  const Positions corners = positions_of(read_checked_corners(path, bytes, context));
  const Eigen::Index triangles = expected.triangles.rows();
  if (corners.rows() != 3 * triangles) {
    throw_mismatch(path, corners.rows() / 3, "triangles", triangles, expected_path);
  }
  Positions positions(expected.vertices, 3);
  std::vector<int> corners_at(static_cast<std::size_t>(expected.vertices), 0);
  std::vector<char> parts(static_cast<std::size_t>(expected.vertices), 0);
  // Differences in the last digit of a float do not count.
  const double parted = 1e-6 * box_diagonal(corners);
  for (Eigen::Index corner = 0; corner < corners.rows(); ++corner) {
    const int vertex = expected.triangles(corner / 3, corner % 3);
    const auto index = static_cast<std::size_t>(vertex);
    if (corners_at[index]++ == 0) positions.row(vertex) = corners.row(corner);
    if ((positions.row(vertex) - corners.row(corner)).norm() > parted) parts[index] = 1;
  }
  check_parting(path, corners_at, parts, expected_path);
  const auto missing = std::find(corners_at.begin(), corners_at.end(), 0);
  if (missing != corners_at.end()) {
    throw MismatchError(path.string() + ": vertex " + std::to_string(missing - corners_at.begin()) +
                        " of " + expected_path.string() + " is in no triangle; STL has no place " +
                        "for it");
  }
  return positions;
}

std::string corners_of(const Polygons& polygons, int face, int first_index) {
  std::string text;
  for (int corner = polygons.offsets[face]; corner < polygons.offsets[face + 1]; ++corner) {
    text += (text.empty() ? "" : " ") + std::to_string(polygons.corners[corner] + first_index);
  }
  return text;
}

void check_same_faces(const fs::path& path, const MeshContent& content,
                      const Connectivity& expected, const fs::path& expected_path) {
  // Usually the lists are equal, and then no triangulation is needed.
  if (content.polygons == expected.polygons) return;
  const Connectivity found = Connectivity::from_polygons(expected.vertices, content.polygons);
  // Accept faces in another order or triangulated otherwise, but not flipped ones.
  const std::optional<Connectivity> ordered = in_order_of(expected, found);
  if (ordered && ordered->triangles == expected.triangles) return;
  if (content.polygons.size() != expected.polygons.size()) {
    throw_mismatch(path, content.polygons.size(), "faces", expected.polygons.size(), expected_path);
  }
  const int face = first_different_face(found, expected);
  if (face < 0) return;
  throw MismatchError(path.string() + ": " + face_name(content, face) + " has the vertices " +
                      corners_of(content.polygons, face, content.first_index) + ", expected " +
                      corners_of(expected.polygons, face, content.first_index) + " as in " +
                      expected_path.string());
}

/// True if the format stores corners of triangles without indices.
bool names_no_vertices(const fs::path& path) {
  return !mesh_format(lower_extension(path))->parse_mesh;
}

TriMesh mesh_of(const fs::path& path, std::string_view bytes, const Context& context) {
  if (names_no_vertices(path)) return read_stl(path, bytes, context);
  MeshContent content = read_checked(path, bytes, context);
  TriMesh mesh{positions_of(content.coordinates), {}};
  mesh.connectivity = Connectivity::from_polygons(static_cast<int>(mesh.positions.rows()),
                                                  std::move(content.polygons));
  if (!content.texture.coordinates.empty()) mesh.connectivity.texture = std::move(content.texture);
  mesh.connectivity.groups = std::move(content.groups);
  mesh.connectivity.materials = read_materials(path, content.libraries);
  return mesh;
}

Positions positions_in(const fs::path& path, std::string_view bytes, const Connectivity& expected,
                       const fs::path& expected_path, const Context& context) {
  if (names_no_vertices(path))
    return gathered_corners(path, bytes, expected, expected_path, context);
  const MeshContent content = read_checked(path, bytes, context);
  const auto vertices = static_cast<long long>(content.coordinates.size() / 3);
  if (vertices != expected.vertices) {
    throw_mismatch(path, vertices, "vertices", expected.vertices, expected_path);
  }
  check_same_faces(path, content, expected, expected_path);
  return positions_of(content.coordinates);
}

}  // namespace

TriMesh read_mesh(const fs::path& path, const Context& context) {
  return mesh_of(path, read_bytes(path), context);
}

Positions read_positions(const fs::path& path, const Connectivity& expected,
                         const fs::path& expected_path, const Context& context) {
  return positions_in(path, read_bytes(path), expected, expected_path, context);
}

MeshFileReader::MeshFileReader(fs::path first, const Context& context) : first_(std::move(first)) {
  constexpr double kMeshShare = 0.9;
  std::string bytes = read_bytes(first_);
  mesh_ = mesh_of(first_, bytes, context.part(0, kMeshShare));
  if (const auto learn = mesh_format(lower_extension(first_))->further_reader) {
    further_ = learn(std::move(bytes), static_cast<std::size_t>(mesh_.positions.rows()),
                     context.part(kMeshShare, 1));
  }
}

void MeshFileReader::read(const fs::path& path, std::span<double> coordinates) const {
  if (coordinates.size() != static_cast<std::size_t>(mesh_.positions.size())) {
    throw std::invalid_argument(std::to_string(coordinates.size()) + " coordinates, expected " +
                                std::to_string(mesh_.positions.size()));
  }
  const std::string bytes = read_bytes(path);
  const bool same_format = lower_extension(path) == lower_extension(first_);
  if (further_ && same_format && further_(bytes, coordinates)) return;
  const Positions positions = positions_in(path, bytes, mesh_.connectivity, first_, {});
  std::copy_n(positions.data(), positions.size(), coordinates.begin());
}

Positions MeshFileReader::read(const fs::path& path) const {
  Positions positions(mesh_.positions.rows(), 3);
  read(path, {positions.data(), static_cast<std::size_t>(positions.size())});
  return positions;
}

MeshFileWriter::MeshFileWriter(const Connectivity& connectivity, const std::string& extension,
                               bool double_precision, const std::vector<Field>& fields,
                               const std::string& name, const Context& context)
    : vertices_(connectivity.vertices),
      single_precision_(!double_precision || lower_case(extension) == ".stl") {
  const Format* format = mesh_format(extension);
  if (!format) throw std::invalid_argument(unknown_mesh_extension(lower_case(extension)));
  try {
    frame_ = std::make_unique<const MeshFrame>(
        format->mesh_frame(connectivity, fields, double_precision, context));
  } catch (const MismatchError& error) {
    throw MismatchError(name + ": " + error.what());
  }
}

MeshFileWriter::~MeshFileWriter() = default;

void MeshFileWriter::write(const fs::path& path, const PositionsView& positions) const {
  if (positions.rows() != vertices_) {
    throw std::invalid_argument(std::to_string(positions.rows()) + " positions, expected " +
                                std::to_string(vertices_) + " as the faces have");
  }
  Eigen::Index vertex = 0, axis = 0;
  const double farthest = vertices_ == 0 ? 0 : positions.cwiseAbs().maxCoeff(&vertex, &axis);
  // Values that are already infinite stay infinite.
  if (single_precision_ && farthest > kLargestSingle && std::isfinite(farthest)) {
    throw MismatchError(committed_name(path).string() + ": " + beyond_single(vertex, farthest));
  }
  const std::string between = frame_->positions(positions);
  OutputFile file(path);
  file.write({frame_->before, between, frame_->after});
  file.close();
}

void write_mesh(const fs::path& path, const PositionsView& positions,
                const Connectivity& connectivity, const WriteOptions& options,
                const Context& context) {
  check_options(options);
  context.report(0);
  const fs::path target = committed_name(path);
  const std::string extension = lower_extension(target);
  if (!is_mesh_extension(extension)) {
    throw OutputError(path.string(), unknown_mesh_extension(extension));
  }
  MeshFileWriter(connectivity, extension, options.double_precision, options.fields, target.string(),
                 context)
      .write(path, positions);
}

void write_mesh(const fs::path& path, const TriMesh& mesh, const WriteOptions& options,
                const Context& context) {
  write_mesh(path, PositionsView(mesh.positions.data(), mesh.positions.rows(), 3),
             mesh.connectivity, options, context);
}

}  // namespace mimetra
