#include "toolkit/correspondence/deformation_system.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace mimetra {
namespace {

using Entry = Eigen::Triplet<double>;

/// The matrix that takes one coordinate of vertices and fourth vertices to that row of each T_i: T
/// = [v2 - v1, v3 - v1, v4 - v1] V^-1.
Eigen::SparseMatrix<double> gradients(const Positions& rest, const Triangles& triangles) {
  const auto vertices = static_cast<int>(rest.rows());
  std::vector<Entry> entries;
  entries.reserve(12 * triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d v1 = rest.row(triangles(t, 0));
    Eigen::Matrix3d V;
    V.col(0) = rest.row(triangles(t, 1)).transpose() - v1;
    V.col(1) = rest.row(triangles(t, 2)).transpose() - v1;
    const Eigen::Vector3d normal = V.col(0).cross(V.col(1));
    V.col(2) = normal / std::sqrt(normal.norm());
    const Eigen::Matrix3d inverse = V.inverse();
    for (int row = 0; row < 3; ++row) {
      const int at = 3 * t + row;
      entries.emplace_back(at, triangles(t, 0), -inverse.col(row).sum());
      entries.emplace_back(at, triangles(t, 1), inverse(0, row));
      entries.emplace_back(at, triangles(t, 2), inverse(1, row));
      entries.emplace_back(at, vertices + t, inverse(2, row));
    }
  }
  Eigen::SparseMatrix<double> matrix(3 * triangles.rows(), vertices + triangles.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// The quadratic form of the T_i's rows: identity |T_i|^2 + smoothness * (|T_i - T_j|^2 for i and
/// each neighbour j, so that a pair counts twice).
Eigen::SparseMatrix<double> couplings(const Triangles& triangles, double smoothness,
                                      double identity) {
  std::vector<Entry> entries;
  const auto rows = static_cast<int>(3 * triangles.rows());
  entries.reserve(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) entries.emplace_back(row, row, identity);
  for (const auto& [i, j] : neighbouring_triangles(triangles)) {
    for (int row = 0; row < 3; ++row) {
      entries.emplace_back(3 * i + row, 3 * i + row, 2 * smoothness);
      entries.emplace_back(3 * j + row, 3 * j + row, 2 * smoothness);
      entries.emplace_back(3 * i + row, 3 * j + row, -2 * smoothness);
      entries.emplace_back(3 * j + row, 3 * i + row, -2 * smoothness);
    }
  }
  Eigen::SparseMatrix<double> matrix(rows, rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

std::vector<std::pair<int, int>> neighbouring_triangles(const Triangles& triangles) {
  std::vector<std::tuple<VertexIndex, VertexIndex, int>> edges;
  for (int t = 0; t < triangles.rows(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = triangles(t, c), b = triangles(t, (c + 1) % 3);
      edges.emplace_back(std::min(a, b), std::max(a, b), t);
    }
  }
  std::ranges::sort(edges);
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t first = 0; first < edges.size(); ++first) {
    const auto& [a, b, i] = edges[first];
    for (std::size_t second = first + 1; second < edges.size(); ++second) {
      const auto& [c, d, j] = edges[second];
      if (a != c || b != d) break;
      if (i != j) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

DeformationSystem::DeformationSystem(const Positions& rest, const Triangles& triangles,
                                     const std::vector<bool>& free, double smoothness,
                                     double identity) {
  const Matrix G = gradients(rest, triangles);
  const Matrix K = couplings(triangles, smoothness, identity);
  const Matrix products = G.transpose() * K * G;

  // Free vertices first, then fourth vertices; held vertices are columns of their own.
  const auto vertices = static_cast<int>(rest.rows());
  std::vector<int> row(products.rows(), -1), held_column(vertices, -1);
  for (VertexIndex v = 0; v < vertices; ++v) {
    (free[v] ? row[v] : held_column[v]) = static_cast<int>((free[v] ? free_ : held_).size());
    (free[v] ? free_ : held_).push_back(v);
  }
  const auto free_vertices = static_cast<int>(free_.size());
  for (int t = 0; t < triangles.rows(); ++t) row[vertices + t] = free_vertices + t;
  const Eigen::Index size = free_vertices + triangles.rows();

  std::vector<Entry> among_free, with_held;
  for (Eigen::Index column = 0; column < products.outerSize(); ++column) {
    for (Matrix::InnerIterator entry(products, column); entry; ++entry) {
      const int i = row[entry.row()];
      if (i < 0) continue;
      if (row[column] >= 0) {
        among_free.emplace_back(i, row[column], entry.value());
      } else {
        with_held.emplace_back(i, held_column[column], entry.value());
      }
    }
  }
  free_products_.resize(size, size);
  free_products_.setFromTriplets(among_free.begin(), among_free.end());
  held_products_.resize(size, static_cast<Eigen::Index>(held_.size()));
  held_products_.setFromTriplets(with_held.begin(), with_held.end());

  Eigen::MatrixXd identities(3 * triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    identities.middleRows<3>(3 * t) = identity * Eigen::Matrix3d::Identity();
  }
  const Eigen::MatrixXd side = G.transpose() * identities;
  identity_side_.resize(size, 3);
  for (Eigen::Index i = 0; i < side.rows(); ++i) {
    if (row[i] >= 0) identity_side_.row(row[i]) = side.row(i);
  }
}

Positions DeformationSystem::solve(const Positions& held, const Positions& drawn_to,
                                   const Eigen::VectorXd& weights) {
  Matrix matrix = free_products_;
  const Eigen::MatrixXd known = held(held_, Eigen::all);
  Eigen::MatrixXd right = identity_side_ - held_products_ * known;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const VertexIndex v = free_[i];
    const auto row = static_cast<Eigen::Index>(i);
    if (weights[v] <= 0) continue;
    matrix.coeffRef(row, row) += weights[v];
    right.row(row) += weights[v] * drawn_to.row(v);
  }
  if (!is_analysed_) factor_.analyzePattern(matrix);
  is_analysed_ = true;
  factor_.factorize(matrix);
  if (factor_.info() != Eigen::Success) {
    throw std::runtime_error("the deformation of the source has no unique solution");
  }
  const Eigen::MatrixXd solution = factor_.solve(right);
  Positions result = held;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    result.row(free_[i]) = solution.row(static_cast<Eigen::Index>(i));
  }
  return result;
}

}  // namespace mimetra
