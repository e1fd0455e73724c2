#pragma once

#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/transfer/deformation_gradients.h"

/// What the solvers do alike with a pairing, or without one (null). Internal to them.
namespace mimetra {

/// Throws MismatchError where rest poses have not the vertices of the pairing, or without one
/// different numbers of them.
void check_sizes(const Positions& source_rest, const Positions& target_rest,
                 const Pairing* pairing);

/// Gradients for triangles of the target; its `triangles` are the source's without a pairing.
DeformationGradients gradients_between(const Positions& source_rest, const Triangles& triangles,
                                       const Pairing* pairing, std::vector<int> selected);

}  // namespace mimetra
