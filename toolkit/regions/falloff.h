#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "toolkit/mesh/weld.h"

namespace mimetra {

// Soft borders of sets of vertices, and shares of several sets.

/// Distances from the nearest of some vertices to all vertices (N), +infinity if there is no path.
using NearestDistance = std::function<Eigen::VectorXd(std::span<const VertexIndex>)>;

/// Weights of vertices (N). Vertices at one welded place get the largest of their weights.
Eigen::VectorXd joined_weights(const Eigen::VectorXd& weights, const Weld& weld);

/// Weights (N) that fade out around the vertices of weight 1. Elsewhere a vertex gets the larger of
/// its own weight and (1 - t)^2 (1 + 2 t), whose slope is 0 at both ends. Here t = distance /
/// `falloff` along the surface; the weight is 0 beyond t = 1.
///
/// Distances are measured from the rim: vertices of weight 1 that share a triangle with another
/// weight. Without a rim the weights do not change. `triangles` are M x 3. A welded place has one
/// weight, as in joined_weights(). Throws std::invalid_argument unless falloff > 0 is finite, and
/// whatever the distances throw.
Eigen::VectorXd fading_out(const Eigen::VectorXd& weights, const Triangles& triangles,
                           const Weld& weld, double falloff, const NearestDistance& distances);

/// Shares of K regions and of the background at each vertex: N x (K + 1), with the background in
/// the last column. Shares are not negative, and each row adds up to 1.
///
/// A region's bump is 1 inside and fades out to 0 at the distance `falloff` from its rim along the
/// surface (fading_out()). The background gets prod (1 - bump) over all regions; the regions divide
/// the rest in proportion to their bumps. All columns are as smooth as the distances.
///
/// `regions` are lists of vertices; a region that contains one vertex of a welded place contains
/// all of them. A region without a rim (a whole connected part) has no soft border. Throws
/// std::invalid_argument unless falloff > 0 is finite, MismatchError that names a vertex that the
/// mesh does not have, and whatever the distances throw.
Eigen::SparseMatrix<double> partition_of_unity(const Triangles& triangles, const Weld& weld,
                                               const std::vector<std::vector<VertexIndex>>& regions,
                                               double falloff, const NearestDistance& distances);

}  // namespace mimetra
