#pragma once

#include <utility>
#include <vector>

#include "toolkit/io/weight_track.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra::samples {

/// The built-in sample: a head made by formulas, with eyes that close, a mouth
/// that opens on teeth and tongue, nose and ears, 12 expressions named as ARKit names them and 4
/// identities. The same numbers on every machine.
MorphableModel parametric_head();

/// The head's vertex of each of iBUG's landmarks (1 to 68), in their order, without those of the
/// outline that depend on the view (1 to 8 and 10 to 17).
std::vector<std::pair<int, VertexIndex>> head_landmarks();

/// A performance of 120 frames at 30 per second for its expressions: it talks, blinks, smiles and
/// is surprised; it begins and ends neutral.
WeightTrack parametric_performance();

}  // namespace mimetra::samples
