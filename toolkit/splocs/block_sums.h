#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "toolkit/mesh/parallel.h"

namespace mimetra {

/// Calls `add(block, sum)` for all blocks, with one sum for each of some runs of them, and returns
/// the sums in order. The runs are fixed, so that what is added up from them is the same for every
/// number of threads, and few, so that they take little memory. Internal to the decomposition.
template <typename Sum>
std::vector<Sum> sums_over_runs(int blocks, int threads,
                                const std::function<void(int, Sum&)>& add) {
  constexpr int kMostRuns = 32;
  const int runs = std::min(kMostRuns, blocks);
  std::vector<Sum> sums(runs);
  parallel_for(runs, threads, [&](int run) {
    for (int b = run * blocks / runs; b < (run + 1) * blocks / runs; ++b) add(b, sums[run]);
  });
  return sums;
}

}  // namespace mimetra
