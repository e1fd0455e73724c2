#pragma once

#include <vector>

#include "tests/bench/report.h"
#include "tests/bench/subjects.h"

namespace mimetra::bench {

/// Kernels full of products, their blocks cut by the cache sizes that mimetra gives Eigen against
/// those that Eigen reads from this processor: the median ratio of alternating pairs, and the
/// interval that holds it with 96 %.
std::vector<Comparison> blocking_comparisons(const Subject& subject, int count,
                                             const Settings& settings);

}  // namespace mimetra::bench
