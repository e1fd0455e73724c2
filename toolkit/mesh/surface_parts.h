#pragma once

#include <vector>

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Connected parts of a mesh in descending order of area; equal areas are ordered by lowest vertex.
/// A vertex without a triangle is a part without area.
struct SurfaceParts {
  std::vector<int> of_vertex;  ///< part of each vertex (N)
  std::vector<double> areas;   ///< area of each part, descending, in the positions' unit squared

  int count() const { return static_cast<int>(areas.size()); }
  double area() const;
  /// Share of the part in the total area; 0 if the total area is 0.
  double share(int part) const;
};

/// Parts of the surface after welding, so that UV seams do not cut it. Throws std::invalid_argument
/// if a triangle has a bad vertex index or sizes differ.
SurfaceParts surface_parts(const Positions& positions, const Triangles& triangles,
                           const Weld& weld);
/// Parts of the surface with coinciding vertices welded.
SurfaceParts surface_parts(const Positions& positions, const Triangles& triangles);

/// Vertices that a computation is about; they define the scale of its lengths.
struct Subject {
  std::vector<VertexIndex> vertices;
  /// Whether the given vertices span less than a third of their parts, as on a head and body in one
  /// piece. The subject then consists of these vertices, and lengths grow by half.
  bool is_section = false;

  double growth() const { return is_section ? 1.5 : 1; }
};

/// All vertices of the parts that contain a vertex of `with`, ascending. Throws std::out_of_range
/// for a vertex that does not exist.
std::vector<VertexIndex> vertices_of_parts(const SurfaceParts& parts,
                                           const std::vector<VertexIndex>& with);

/// Subject of the parts around some vertices, such as those that move or have a marker. Other parts
/// in the file do not count. Throws std::out_of_range for a vertex that does not exist.
/// \pre `vertices` is not empty
Subject subject_around(const Positions& positions, const SurfaceParts& parts,
                       const std::vector<VertexIndex>& vertices);

/// Bounding box of subject_around() some vertices; the diagonal includes the growth.
struct SubjectBox {
  Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
  double diagonal = 0;
  bool is_section = false;
};

/// Throws as subject_around().
SubjectBox subject_box(const Positions& positions, const SurfaceParts& parts,
                       const std::vector<VertexIndex>& vertices);

/// Largest distance between two vertices of the parts that contain one of `vertices`. Equals the
/// diameter of the mesh, bit by bit, if both agree up to rounding or `vertices` is empty.
double diameter_of_parts(const Positions& positions, const Triangles& triangles,
                         const std::vector<VertexIndex>& vertices);

/// A boundary spans a connected part if its diameter is at least this share of the part's. Necks
/// and the edges of face masks span half of it or more; open mouths and eyes at most a third.
constexpr double kRimShare = 0.4;

/// Marks the vertices on the rims of a surface and those that share a triangle with them (N). A rim
/// is where a scan ends or a face is cut out of a head.
///
/// The rim of a connected part is its longest boundary, if that spans the part; shorter boundaries
/// are openings. Boundary edges have one triangle after welding, and form boundaries through common
/// vertices. Throws std::invalid_argument if sizes differ or a triangle has a bad vertex index.
std::vector<bool> near_rims(const Positions& positions, const Triangles& triangles,
                            const Weld& weld);

}  // namespace mimetra
