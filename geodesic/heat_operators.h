#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "geodesic/surface_components.h"

namespace mimetra::geodesic {

/// A triangle laid out in its own plane, with the gradients of its hat functions in 1 / length. The
/// gradient of corner 0 is minus the sum of the others.
struct FlatTriangle {
  Eigen::Vector2d gradient1, gradient2;
  double area;
};

/// Discrete operators of the heat method on one component (N rows).
struct HeatOperators {
  /// Mass + t L, and L (N x N): L is the cotangent Laplacian, t the mean edge length squared.
  Eigen::SparseMatrix<double> heat, laplacian;
  /// Triangulation of both operators (M), which may differ from the component's own.
  Triangles triangles;
  std::vector<FlatTriangle> flat;
};

/// Operators of CGAL's Heat_method_3, equal up to rounding on a manifold. They use its intrinsic
/// Delaunay triangulation or the component's own triangles. Throws std::runtime_error if the
/// intrinsic Delaunay flips do not end.
HeatOperators heat_operators(const SurfaceComponent& component, bool intrinsic_delaunay);

}  // namespace mimetra::geodesic
