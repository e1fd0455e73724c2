#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Scale-free quality 2 A / l_max^2 of a triangle: sqrt(3)/2 for the equilateral one, 0 without
/// area.
double triangle_quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c);

/// Triangles of lower quality carry no usable deformation gradient; valid faces go down to 4e-3.
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

}  // namespace mimetra
