#pragma once

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Edges [b - a, c - a] of a triangle a b c: the V of eq. 10.
using Edges = Eigen::Matrix<double, 3, 2>;

inline Edges edges_of(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                      int triangle) {
  const auto corners = triangles.row(triangle);
  Edges edges;
  edges.col(0) = (positions.row(corners[1]) - positions.row(corners[0])).transpose();
  edges.col(1) = (positions.row(corners[2]) - positions.row(corners[0])).transpose();
  return edges;
}

}  // namespace mimetra
