#pragma once

#include <limits>

#include "toolkit/io/weight_track.h"

namespace mimetra {

/// Stands for a weight that is missing.
inline constexpr double kMissingWeight = std::numeric_limits<double>::quiet_NaN();

/// Weights that are missing, as in rows where a capture lost the face, lie between their
/// neighbours in time: by the track's times, else by its rows. The first and the last that there
/// are stay beyond them. Adds notes on the rows and columns. \pre each column has a number
void fill_missing_weights(WeightTrack& track);

}  // namespace mimetra
