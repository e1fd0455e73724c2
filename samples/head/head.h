#pragma once

#include <mimetra/io/weight_track.h>
#include <mimetra/model/morphable_model.h>

namespace mimetra::samples {

/// The built-in sample: a head made by formulas, with eyes that close, a mouth
/// that opens, nose and ears, 12 expressions named as ARKit names them and 4 identities. The same
/// numbers on every machine.
MorphableModel parametric_head();

/// A performance of 120 frames at 30 per second for its expressions: it talks, blinks, smiles and
/// is surprised; it begins and ends neutral.
WeightTrack parametric_performance();

}  // namespace mimetra::samples
