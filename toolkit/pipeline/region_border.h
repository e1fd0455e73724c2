#pragma once

#include "toolkit/pipeline/solution.h"

/// The soft border of regions: that of a painting, and what --falloff adds.
namespace mimetra {

/// Refuses, before anything is computed, a border that a transfer cannot have; `given` are regions
/// that are known already, or null. Throws what check_soft_border() throws where the border is
/// soft, OptionError (Topic::no_full_weight) where the regions have no weight 1 around which they
/// could fade out, and std::invalid_argument where regions that are to have weights of their own
/// each (SolveOptions::per_region) say how much of the motion their vertices take.
void check_border(const GivenRegions* given, const Target& target, const SolveOptions& options);

/// Weights of a source's vertices on a target (N each): each takes the mean of its carriers', by
/// their shares. One without carriers that is connected with one that has some takes the weight
/// that lies most evenly between those around it (the least sum of squared differences along
/// edges); others take 0. `weld` and `triangles` (M x 3) are the target's; a place of which a
/// vertex has carriers is between no others.
Eigen::VectorXd carried_weights(const Eigen::VectorXd& weights, const Pairing& pairing,
                                const Weld& weld, const Triangles& triangles);

/// What a transfer by regions of the source looks at on a target: selection_of(), with the weights
/// that the regions have there, faded out around the vertices of weight 1 over the falloff of the
/// options. FollowingParts take the weight of the surface around them: on a paired target, and with
/// a falloff on one with the source's faces. Without weights and falloff the border is hard, and so
/// with weights of each region, whose falloff is their own.
///
/// A falloff that is a share is one of the size of the moving_parts(), if the target has the
/// source's faces and the vertices `moving` are given, and of the parts with a weight elsewhere.
///
/// Throws OptionError (Topic::no_full_weight) where nothing has the weight 1 that could fade out,
/// MismatchError where no vertex of the target has a weight, std::invalid_argument for a falloff
/// out of range, and what distances_along() throws. \pre a MatchedTarget
Selection bordered_selection(const Regions& regions, const Target& target,
                             const SolveOptions& options,
                             const std::vector<VertexIndex>& moving = {},
                             const Context& context = {});

/// Regions of the source with the border that they have on a target of the same faces; for a paired
/// one they are what they were.
Regions with_border(Regions regions, const Selection& selection, const Target& target);

}  // namespace mimetra
