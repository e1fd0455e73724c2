#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "geodesic/surface_components.h"

namespace mimetra::geodesic {

/// A triangle laid out in its own plane: the gradients of its hat functions, one over length. The
/// one of corner 0 is minus the sum of the others.
struct FlatTriangle {
  Eigen::Vector2d gradient1, gradient2;
  double area;
};

/// The discrete heat method of one component, on its rows (N).
struct HeatOperators {
  /// Mass + t L and L, N x N: L the cotangent Laplacian, t the mean edge length squared.
  Eigen::SparseMatrix<double> heat, laplacian;
  /// The triangulation that both belong to (M), which need not be the component's own.
  Triangles triangles;
  std::vector<FlatTriangle> flat;
};

/// Those of CGAL's Heat_method_3, up to rounding on a manifold, on its intrinsic Delaunay
/// triangulation or on the component's own triangles. Throws std::runtime_error.
HeatOperators heat_operators(const SurfaceComponent& component, bool intrinsic_delaunay);

}  // namespace mimetra::geodesic
