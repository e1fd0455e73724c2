#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra {

/// Polygons of any size, stored one after the other. The corners of face i are the 0-based vertex
/// indices corners[offsets[i]] .. corners[offsets[i + 1] - 1].
struct Polygons {
  std::vector<int> corners;
  std::vector<int> offsets = {0};

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  bool operator==(const Polygons&) const = default;
};

/// Texture coordinates of a mesh, kept to write them back.
struct TextureCoordinates {
  std::vector<Eigen::Vector2d> coordinates;
  /// Index into `coordinates` for each polygon corner (as many as Polygons::corners); -1 for none.
  std::vector<int> corners;
};

/// A line of an OBJ file that applies to the faces after it: `g lips`, `usemtl skin`, `s 1`.
struct FaceGroup {
  int first_face;
  std::string statement;
};

/// A material file as read.
struct MaterialLibrary {
  std::filesystem::path path;
  std::string text;
};

/// Materials that an OBJ file refers to, kept to write them back.
struct Materials {
  std::vector<MaterialLibrary> libraries;
  /// Names of libraries that were not found.
  std::vector<std::string> missing;
};

/// Faces of a mesh. mimetra computes on the triangles; the polygons are the faces of the user's
/// file and are written back. Triangles of a polygon form a fan from its first corner.
struct Connectivity {
  int vertices = 0;
  Triangles triangles;
  Polygons polygons;
  /// Polygon of each triangle (M).
  std::vector<int> polygon_of_triangle;
  TextureCoordinates texture;
  std::vector<FaceGroup> groups;
  /// Null if the file refers to no materials.
  std::shared_ptr<const Materials> materials = {};

  /// Triangulates each polygon as a fan. Throws std::invalid_argument if offsets do not rise from 0
  /// to the number of corners. Also throws, with the polygon's number, for fewer than three corners
  /// or an index outside 0 .. vertices - 1.
  static Connectivity from_polygons(int vertices, Polygons polygons);
  /// Uses each triangle as a polygon. Throws as from_polygons().
  static Connectivity from_triangles(int vertices, const Triangles& triangles);
};

/// Whether both have the same vertex count and the same list of polygons, up to cyclic rotation of
/// each. A flipped or differently split polygon makes another connectivity.
bool same_faces(const Connectivity& a, const Connectivity& b);

/// Index of the first polygon that differs (up to cyclic rotation), or -1.
int first_different_face(const Connectivity& a, const Connectivity& b);

/// Vertices that triangles use, ascending; all vertices if there are no triangles.
std::vector<VertexIndex> used_vertices(const Triangles& triangles, Eigen::Index vertices);

struct TriMesh {
  Positions positions;
  Connectivity connectivity;
};

/// Whether any corner of a face has texture coordinates.
bool has_texture(const Connectivity& connectivity);

/// Whether each vertex has, at every corner, the texture coordinates of its own index.
bool is_textured_by_vertex(const Connectivity& connectivity);

/// Texture coordinates of each vertex (N); 0 for vertices without any. Returns none if a vertex has
/// several, as at the seams of a texture, or if the mesh has no texture coordinates.
std::optional<std::vector<Eigen::Vector2d>> texture_of_vertices(const Connectivity& connectivity);

/// Kinds of names that an OBJ file gives to faces.
enum class FaceGroupKind {
  group,    ///< `g` and `o`: a face belongs to the groups of the last statement of each keyword
  material  ///< `usemtl`
};

/// Faces with a common name in a file.
struct NamedFaces {
  std::string name;
  std::vector<int> faces;  ///< polygons, ascending
};

/// Groups or materials of a mesh that have faces, in the order of their first face.
std::vector<NamedFaces> named_faces(const Connectivity& connectivity, FaceGroupKind kind);

/// Size from which readers refuse coordinates (8.7e99), because their cubes would overflow.
constexpr double kCoordinateLimit = 0x1p332;

/// Whether `value` is below kCoordinateLimit; false for infinity and NaN.
inline bool is_coordinate(double value) {
  return std::abs(value) < kCoordinateLimit;
}

/// Index of the first row with a value that is not a coordinate; -1 if there is none.
Eigen::Index first_unusable(const Positions& positions);

}  // namespace mimetra
