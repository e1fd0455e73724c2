#pragma once

#include <utility>
#include <vector>

#include <Eigen/SparseCholesky>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// Positions of vertices and fourth vertices that keep triangles' deformations smooth and small,
/// with some vertices held and others drawn to places. The unknowns of all solves are the same, so
/// that one analysis serves them.
class DeformationSystem {
 public:
  /// `rest` N x 3; vertices that are not `free` stay where a solve holds them. \pre each
  /// triangle has an area, each free vertex a triangle, and each connected part a held vertex
  DeformationSystem(const Positions& rest, const Triangles& triangles,
                    const std::vector<bool>& free, double smoothness, double identity);

  /// Positions (N x 3) where each free vertex v is drawn to row v of `drawn_to` with weight
  /// weights[v], 0 for not at all, and the others are held at their rows of `held`. Throws
  /// std::runtime_error where the system has no solution.
  Positions solve(const Positions& held, const Positions& drawn_to, const Eigen::VectorXd& weights);

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  std::vector<VertexIndex> free_;  ///< vertex of each free row
  std::vector<VertexIndex> held_;  ///< vertex of each held column
  Matrix free_products_, held_products_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> identity_side_;
  Eigen::SimplicialLDLT<Matrix> factor_;
  bool is_analysed_ = false;
};

/// Pairs of triangles that share an edge, the lower one first.
std::vector<std::pair<int, int>> neighbouring_triangles(const Triangles& triangles);

}  // namespace mimetra
