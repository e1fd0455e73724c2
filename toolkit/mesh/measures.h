#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"

/// Sizes of meshes and of their triangles.
namespace mimetra {

/// Longest side of the bounding box; 0 for no positions.
double extent(const Eigen::Ref<const Positions>& positions);

/// Diagonal of the bounding box; 0 for no positions.
double box_diagonal(const Eigen::Ref<const Positions>& positions);

/// Largest distance between two of the positions (N x 3), up to rounding. It does not change if the
/// mesh is rotated or renumbered. Points with a coordinate that is not finite are ignored. 0 for
/// fewer than two points.
///
/// Branch and bound over pairs of balls around halves of the points. The time grows close to N log
/// N. On a sphere, where every point has another at the full distance, it grows about as N^1.5.
double diameter(const Eigen::Ref<const Positions>& positions);

/// Diameter of the vertices of triangles with_area(), so that stray points do not count. If no
/// triangle has area, all vertices of triangles count. Without triangles, all positions count.
double diameter(const Positions& positions, const Triangles& triangles);

/// Scale-free quality 2 A / l_max^2 of a triangle: sqrt(3)/2 if equilateral, 0 without area.
double triangle_quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c);

/// Quality below which a triangle is degenerate: it has no usable deformation gradient, and its
/// edge lengths do not determine its height. The height appears in them as an excess of about
/// quality^2, which at 1e-6 is still four digits above rounding. Faces of real meshes go down to
/// 4e-3.
constexpr double kDegenerateQuality = 1e-6;

/// Quality below which a triangle is a sliver whose orientation cannot be seen.
constexpr double kSliverQuality = 2e-3;

/// Whether triangle `t` repeats no vertex and is not degenerate.
bool has_area(const Positions& positions, const Triangles& triangles, Eigen::Index t);

/// Triangles for which has_area() holds, in their order.
Triangles with_area(const Positions& positions, const Triangles& triangles);

/// Vertices of triangles with area, ascending: the surface without stray points. If no triangle has
/// area, used_vertices() of all triangles.
std::vector<VertexIndex> surface_vertices(const Positions& positions, const Triangles& triangles);

/// A third of the area of each vertex's triangles (N).
Eigen::VectorXd vertex_areas(const Positions& positions, const Triangles& triangles);

}  // namespace mimetra
