#pragma once

#include <functional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "toolkit/mesh/weld.h"

namespace mimetra {

// The soft border of a set of vertices, and the shares of several sets.

/// Distances from the nearest of some vertices to all vertices (N), +infinity where there is no
/// way.
using NearestDistance = std::function<Eigen::VectorXd(std::span<const VertexIndex>)>;

/// Weights of vertices (N), at each welded place the largest of its vertices.
Eigen::VectorXd joined_weights(const Eigen::VectorXd& weights, const Weld& weld);

/// Weights (N) that fade out around the vertices of weight 1: elsewhere the larger one of a
/// vertex's own weight and (1 - t)^2 (1 + 2 t), whose slope is 0 at both ends, for t = distance /
/// `falloff` up to 1 along the surface; 0 beyond. Distances are asked for from the rim: vertices of
/// weight 1 that share a triangle with another one. Without a rim the weights are what they were.
///
/// `triangles` are M x 3. A welded place has one weight, as joined_weights(). Throws
/// std::invalid_argument unless falloff > 0 is finite, and what the distances throw.
Eigen::VectorXd fading_out(const Eigen::VectorXd& weights, const Triangles& triangles,
                           const Weld& weld, double falloff, const NearestDistance& distances);

/// How much each of K regions, and what lies around them, counts at each vertex: N x (K + 1), the
/// last column is the background's. Rows are not negative and add up to 1.
///
/// A region's bump is 1 in it and fades out to 0 at the distance `falloff` from its rim along the
/// surface (fading_out()). The background has prod (1 - bump) over all regions; they divide the
/// rest in proportion to their bumps. Where distances are smooth, so are all columns.
///
/// `regions` are lists of vertices; what a region holds of a welded place it holds of all of it. A
/// region without a rim (a whole connected part) ends where it ends. Throws std::invalid_argument
/// unless falloff > 0 is finite, MismatchError that names a vertex the mesh does not have, and what
/// the distances throw.
Eigen::SparseMatrix<double> partition_of_unity(const Triangles& triangles, const Weld& weld,
                                               const std::vector<std::vector<VertexIndex>>& regions,
                                               double falloff, const NearestDistance& distances);

}  // namespace mimetra
