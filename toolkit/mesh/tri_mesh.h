#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/mesh/types.h"

namespace mimetra {

/// Polygons of any size, one after the other: face i has the corners
/// corners[offsets[i]] .. corners[offsets[i + 1] - 1], 0-based vertex indices.
struct Polygons {
  std::vector<int> corners;
  std::vector<int> offsets = {0};

  int size() const { return static_cast<int>(offsets.size()) - 1; }
  bool operator==(const Polygons&) const = default;
};

/// Texture coordinates of a mesh, kept for writing it back.
struct TextureCoordinates {
  std::vector<Eigen::Vector2d> coordinates;
  /// Index into `coordinates` for each polygon corner (as many as Polygons::corners); -1 where
  /// none.
  std::vector<int> corners;
};

/// A line of an OBJ file that is about the faces after it: `g lips`, `usemtl skin`, `s 1`.
struct FaceGroup {
  int first_face;
  std::string statement;
};

/// A file of materials, as it was read.
struct MaterialLibrary {
  std::filesystem::path path;
  std::string text;
};

/// The materials that an OBJ file names, kept for writing it back.
struct Materials {
  std::vector<MaterialLibrary> libraries;
  /// Names of libraries that are not there.
  std::vector<std::string> missing;
};

/// Which vertices form which faces. The triangles are what mimetra computes on; the polygons are
/// what the user's file holds and what is written back. Polygon fans keep the polygon's first
/// corner.
struct Connectivity {
  int vertices = 0;
  Triangles triangles;
  Polygons polygons;
  /// Polygon of each triangle (M).
  std::vector<int> polygon_of_triangle;
  TextureCoordinates texture;
  std::vector<FaceGroup> groups;
  /// Null where nothing names materials.
  std::shared_ptr<const Materials> materials = {};

  /// Triangulates each polygon as a fan. Throws std::invalid_argument that names the first polygon
  /// with fewer than three corners or with an index outside 0 .. vertices - 1.
  static Connectivity from_polygons(int vertices, Polygons polygons);
  /// Each triangle is its own polygon. Throws as from_polygons.
  static Connectivity from_triangles(int vertices, const Triangles& triangles);
};

/// True where both have the same vertex count and the same list of polygons up to cyclic rotation
/// of each; a flipped or differently split polygon is another connectivity.
bool same_faces(const Connectivity& a, const Connectivity& b);

/// Index of the first polygon in which the two differ (up to cyclic rotation), or -1.
int first_different_face(const Connectivity& a, const Connectivity& b);

/// The vertices that triangles use, ascending; all of so many where there is no triangle.
std::vector<VertexIndex> used_vertices(const Triangles& triangles, Eigen::Index vertices);

/// One mesh.
struct TriMesh {
  Positions positions;
  Connectivity connectivity;
};

/// Whether any corner of a face has texture coordinates.
bool has_texture(const Connectivity& connectivity);

/// Whether each vertex has the texture coordinates of its own number, at every corner.
bool is_textured_by_vertex(const Connectivity& connectivity);

/// The texture coordinates of each vertex (N), where all corners at a vertex have equal ones;
/// vertices at no such corner have 0. None where a vertex has several, as at the seams of a
/// texture, or the mesh has no texture coordinates.
std::optional<std::vector<Eigen::Vector2d>> texture_of_vertices(const Connectivity& connectivity);

/// What the statements of an OBJ file say of the faces after them.
enum class FaceGroupKind {
  group,    ///< `g` and `o`: each face is in all groups that the last statement of either names
  material  ///< `usemtl`
};

/// Faces that a file has a name for.
struct NamedFaces {
  std::string name;
  std::vector<int> faces;  ///< polygons, ascending
};

/// The groups or materials of a mesh that have faces, in the order of their first face.
std::vector<NamedFaces> named_faces(const Connectivity& connectivity, FaceGroupKind kind);

/// Readers refuse coordinates from this size on (8.7e99): their cubes would not be finite.
constexpr double kCoordinateLimit = 0x1p332;

/// False for numbers of that size, infinity, and what is not a number.
inline bool is_coordinate(double value) {
  return std::abs(value) < kCoordinateLimit;
}

/// The first row of positions with a number that is no coordinate; -1 if there is none.
Eigen::Index first_unusable(const Positions& positions);

}  // namespace mimetra
