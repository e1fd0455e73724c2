#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "toolkit/regions/falloff.h"

namespace mimetra {

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
