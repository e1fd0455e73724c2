#pragma once

#include <utility>
#include <vector>

#include "toolkit/io/weight_track.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra::samples {

/// The built-in sample: a head made by formulas, with the same numbers on every machine. Its eyes
/// close, and its mouth opens on teeth and tongue. It has 12 expressions, named as in ARKit, and 4
/// identities.
MorphableModel parametric_head();

/// Vertices of the head at iBUG's landmarks (1 to 68), in ascending order. Landmarks of the outline
/// that depend on the view (1 to 8 and 10 to 17) are missing.
std::vector<std::pair<int, VertexIndex>> head_landmarks();

/// A performance of 120 frames at 30 per second for the head's expressions. The head talks, blinks,
/// smiles and is surprised; it begins and ends neutral.
WeightTrack parametric_performance();

}  // namespace mimetra::samples
