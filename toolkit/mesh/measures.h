#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"

/// Sizes of meshes and of their triangles.
namespace mimetra {

/// Longest side of the bounding box; 0 for no positions.
double extent(const Eigen::Ref<const Positions>& positions);

/// Diagonal of the bounding box; 0 for no positions.
double box_diagonal(const Eigen::Ref<const Positions>& positions);

/// The largest distance between two of the positions (N x 3): a size that does not change where a
/// mesh is turned or its vertices are renumbered. To rounding; points with a coordinate that is not
/// finite do not count. 0 for fewer than two.
///
/// Branch and bound over pairs of balls around halves of the points: close to N log N, on a sphere,
/// where every point has another that is as far, about N^1.5.
double diameter(const Eigen::Ref<const Positions>& positions);

/// The diameter of the vertices of triangles with_area(): stray points do not count. If no triangle
/// has area, all vertices of triangles count; without triangles, all positions.
double diameter(const Positions& positions, const Triangles& triangles);

/// Scale-free quality 2 A / l_max^2 of a triangle: sqrt(3)/2 for the equilateral one, 0 without
/// area.
double triangle_quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c);

/// A triangle of lower quality is degenerate: it carries no usable deformation gradient, and its
/// edge lengths do not tell its height, which is in them as an excess of about quality^2. At 1e-6
/// that is still four digits above rounding. Faces of real meshes go down to 4e-3.
constexpr double kDegenerateQuality = 1e-6;

/// Below this a triangle is a sliver, whose side nobody sees.
constexpr double kSliverQuality = 2e-3;

/// Whether triangle `t` repeats no vertex and is not degenerate.
bool has_area(const Positions& positions, const Triangles& triangles, Eigen::Index t);

/// Those that do, in their order.
Triangles with_area(const Positions& positions, const Triangles& triangles);

/// The vertices of triangles with area, ascending: those of a surface, without stray points. Where
/// no triangle has area used_vertices() of them.
std::vector<VertexIndex> surface_vertices(const Positions& positions, const Triangles& triangles);

/// A third of the area of each vertex's triangles (N).
Eigen::VectorXd vertex_areas(const Positions& positions, const Triangles& triangles);

}  // namespace mimetra
