#pragma once

#include <vector>

#include "tests/bench/suite.h"

namespace mimetra::bench {

/// 300 frames of 50 landmarks of a random model as large as Surrey's: five iterations by both
/// solvers, with an identity in every frame as in the paper, and with one for the clip.
std::vector<Row> fitting_rows(const Settings& settings);

}  // namespace mimetra::bench
