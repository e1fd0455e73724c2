#include "toolkit/regions/farthest_discs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/near_tie.h"

namespace mimetra {

namespace {

/// Discs that are measured at a time: their distances (N each) are not kept.
constexpr std::size_t kDiscsPerBatch = 16;

void check_spread(const Positions& positions, const FarthestDiscsOptions& options) {
  if (!(options.radius > 0 && std::isfinite(options.radius))) {
    throw std::invalid_argument("radius is " + std::to_string(options.radius) +
                                "; it must be above 0");
  }
  if (options.count < 1) {
    throw std::invalid_argument("count is " + std::to_string(options.count) + "; at least 1 disc");
  }
  const auto vertices = static_cast<std::size_t>(positions.rows());
  if (!options.inside.empty() && options.inside.size() != vertices) {
    throw std::invalid_argument("inside: " + std::to_string(options.inside.size()) +
                                " vertices, expected " + std::to_string(vertices));
  }
}

/// The first vertex whose number is the largest, but for near ties; -1 where none is above 0.
VertexIndex farthest_vertex(const Eigen::VectorXd& squares) {
  VertexIndex best = -1;
  double most = 0;
  for (VertexIndex v = 0; v < squares.size(); ++v) {
    if (squares[v] <= (1 + kNearTie) * most) continue;
    most = squares[v];
    best = v;
  }
  return best;
}

std::vector<VertexIndex> spread_vertices(const Positions& positions, const Triangles& triangles,
                                         const FarthestDiscsOptions& options) {
  std::vector<bool> may_be(positions.rows(), false);
  for (const VertexIndex v : triangles.reshaped()) {
    may_be[v] = options.inside.empty() || options.inside[v];
  }
  const Eigen::RowVector3d middle = positions.colwise().mean();
  Eigen::VectorXd squares = (positions.rowwise() - middle).rowwise().squaredNorm();
  for (VertexIndex v = 0; v < squares.size(); ++v) {
    if (!may_be[v]) squares[v] = 0;
  }
  std::vector<VertexIndex> centers;
  while (static_cast<int>(centers.size()) < options.count) {
    const VertexIndex next = farthest_vertex(squares);
    if (next < 0) break;
    const Eigen::VectorXd from_next =
        (positions.rowwise() - positions.row(next)).rowwise().squaredNorm();
    if (centers.empty()) {
      squares = from_next;
      for (VertexIndex v = 0; v < squares.size(); ++v) {
        if (!may_be[v]) squares[v] = 0;
      }
    } else {
      squares = squares.cwiseMin(from_next);
    }
    centers.push_back(next);
  }
  return centers;
}

}  // namespace

std::vector<Disc> farthest_discs(const Positions& positions, const Triangles& triangles,
                                 const DistanceFunction& distances,
                                 const FarthestDiscsOptions& options) {
  check_spread(positions, options);
  const auto of_vertex = triangles_of_vertices(static_cast<int>(positions.rows()), triangles);
  const std::vector<VertexIndex> centers = spread_vertices(positions, triangles, options);
  std::vector<Disc> discs;
  for (std::size_t first = 0; first < centers.size(); first += kDiscsPerBatch) {
    const auto batch =
        std::span(centers).subspan(first, std::min(kDiscsPerBatch, centers.size() - first));
    const Eigen::MatrixXd from_centers = distances(batch);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      discs.push_back(disc_around(batch[i], from_centers.col(static_cast<Eigen::Index>(i)),
                                  options.radius, of_vertex, options.inside));
    }
  }
  return discs;
}

}  // namespace mimetra
