#pragma once

#include <vector>

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// A mesh's connected parts, the largest surface first; of equal ones that with the lowest vertex.
/// A vertex without triangle is a part without area.
struct SurfaceParts {
  std::vector<int> of_vertex;  ///< part of each vertex (N)
  std::vector<double> areas;   ///< of each part, descending, in the positions' unit squared

  int count() const { return static_cast<int>(areas.size()); }
  double area() const;
  /// Share of the whole surface; 0 where that has no area.
  double share(int part) const;
};

/// Parts of the surface whose vertices are welded: UV seams do not cut it. Throws
/// std::invalid_argument for a triangle with a vertex that is not there, or where sizes differ.
SurfaceParts surface_parts(const Positions& positions, const Triangles& triangles,
                           const Weld& weld);
/// The same with the vertices at one place welded.
SurfaceParts surface_parts(const Positions& positions, const Triangles& triangles);

/// What a computation is about, by which it measures lengths.
struct Subject {
  std::vector<VertexIndex> vertices;
  /// True if the given vertices span less than a third of the parts that they are in, as on a head
  /// and body in one piece. The subject is then these vertices, and lengths grow by half.
  bool is_section = false;

  double growth() const { return is_section ? 1.5 : 1; }
};

/// Vertices of the parts with one of some vertices, ascending. Throws std::out_of_range for one
/// that is not there.
std::vector<VertexIndex> vertices_of_parts(const SurfaceParts& parts,
                                           const std::vector<VertexIndex>& with);

/// The parts with one of some vertices, such as those that move or have a marker: what else is in
/// the file does not count. `vertices` must not be empty. Throws std::out_of_range for one that is
/// not there.
Subject subject_around(const Positions& positions, const SurfaceParts& parts,
                       const std::vector<VertexIndex>& vertices);

/// The box of a subject_around() some vertices.
struct SubjectBox {
  Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
  double diagonal = 0;
  bool is_section = false;
};

/// Throws as subject_around().
SubjectBox subject_box(const Positions& positions, const SurfaceParts& parts,
                       const std::vector<VertexIndex>& vertices);

/// Largest distance between two vertices of the parts with one of some vertices: that of the mesh,
/// bit by bit, where both are equal to rounding or there is no vertex.
double diameter_of_parts(const Positions& positions, const Triangles& triangles,
                         const std::vector<VertexIndex>& vertices);

/// A boundary spans a connected part if the farthest of its vertices are apart by this share of the
/// part's diameter. Necks and the edges of face masks span half of it and more, mouths and eyes
/// that a face leaves open a third at most.
constexpr double kRimShare = 0.4;

/// Vertices on the rims of a surface, where a scan ends or a face is cut out of a head, and those
/// that share a triangle with them (N). Of each connected part that is the longest boundary, if it
/// spans the part; shorter ones are openings in the surface. Edges of one triangle are a boundary,
/// where coinciding vertices are welded; the parts of a boundary hang together by vertices. Throws
/// std::invalid_argument where sizes differ, or for a triangle with a vertex that is not there.
std::vector<bool> near_rims(const Positions& positions, const Triangles& triangles,
                            const Weld& weld);

}  // namespace mimetra
