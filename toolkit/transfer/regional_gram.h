#pragma once

#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/model/regional_animation.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

/// A^T A of eq. 11 over some triangles where each region has weights of its own (R D x R D): entry
/// (r D + j, s D + m) sums over edges the products of the fields share_r dV_j and share_s dV_m.
/// Regions without a common triangle have exactly 0. Throws Cancelled.
Eigen::MatrixXd regional_gram(const BlendshapeModel& target, const RegionShares& shares,
                              const std::vector<int>& triangles, EdgeSum sum,
                              const Context& context = {});

}  // namespace mimetra
