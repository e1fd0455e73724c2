#pragma once

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra::bench {

/// The Cholesky factor of a matrix with an entry for each vertex and edge of a mesh, in the order
/// that Eigen's approximate minimum degree finds.
struct FactorSize {
  double entries = 0;       ///< below the diagonal, and on it
  double factor_flops = 0;  ///< of computing it

  /// Of one right-hand side: down and up, a multiplication and an addition for each entry.
  double solve_flops() const { return 4 * entries; }
  /// A double and an int for each entry.
  double bytes() const { return 12 * entries; }
};

FactorSize factor_size(int vertices, const Triangles& triangles);

}  // namespace mimetra::bench
