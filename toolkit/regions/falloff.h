#pragma once

#include <functional>
#include <span>

#include "toolkit/mesh/weld.h"

/// The soft border of a set of vertices.
namespace mimetra {

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

}  // namespace mimetra
