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

/// A third of the area of each vertex's triangles (N).
Eigen::VectorXd vertex_areas(const Positions& positions, const Triangles& triangles);

}  // namespace mimetra
