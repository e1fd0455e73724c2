#pragma once

#include "toolkit/pipeline/solution.h"

/// The soft border of regions: that of a painting, and what --falloff adds.
namespace mimetra {

/// Refuses a border that a transfer cannot have, before anything is computed. `given` are regions
/// of an earlier run, or null. Throws what check_soft_border() throws for a soft border;
/// OptionError (Topic::no_full_weight) if no vertex has the weight 1 around which regions could
/// fade out; and std::invalid_argument for SolveOptions::per_region with regions whose vertices
/// have weights.
void check_border(const GivenRegions* given, const Target& target, const SolveOptions& options);

/// Carries weights of a source's vertices (N) to a target's vertices (N). A vertex takes the mean
/// of its carriers' weights, by their shares. A vertex without carriers takes the harmonic
/// interpolation of the weights around it (least sum of squared differences along edges), or 0 if
/// no connected vertex has carriers. `weld` and `triangles` (M x 3) belong to the target; vertices
/// at one place have carriers if one of them has.
Eigen::VectorXd carried_weights(const Eigen::VectorXd& weights, const Pairing& pairing,
                                const Weld& weld, const Triangles& triangles);

/// The selection_of() regions of the source on a target, with the regions' weights there. The
/// weights fade out around the vertices of weight 1, over the falloff of the options.
/// FollowingParts take the weight of the surface around them on a paired target, and with a falloff
/// on any target. The border is hard without weights and falloff, and with
/// SolveOptions::per_region, where the falloff belongs to the weights of each region.
///
/// A relative falloff is a share of the size of the moving_parts(), if the target has the source's
/// faces and `moving` lists vertices. Otherwise it is a share of the size of the parts with
/// weights.
///
/// Throws OptionError (Topic::no_full_weight) if no vertex has the weight 1; MismatchError if no
/// vertex of the target has a weight; std::invalid_argument for a falloff out of range; and what
/// distances_along() throws. \pre a MatchedTarget
Selection bordered_selection(const Regions& regions, const Target& target,
                             const SolveOptions& options,
                             const std::vector<VertexIndex>& moving = {},
                             const Context& context = {});

/// The regions with the border that they have on a target with the source's faces. Regions of a
/// paired target stay as they are.
Regions with_border(Regions regions, const Selection& selection, const Target& target);

}  // namespace mimetra
