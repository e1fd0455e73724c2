#pragma once

#include <string>

namespace mimetra::bench {

struct Machine {
  std::string processor;
  int threads = 1;
  double cache_bytes = 0;  ///< last level
  double load = 0;         ///< threads that wanted to run in the minute before
};

Machine this_machine();

/// What the machine can do at most with all its threads: the best of several rounds, because
/// whoever else uses the machine only makes it slower.
struct Limits {
  double flops = 0;  ///< a second, in products of large matrices (Eigen, double)
  double bytes = 0;  ///< a second, summing a block far larger than the last cache
};

Limits measured_limits(const Machine& machine, bool quick);

/// The better of both.
Limits best_of(const Limits& a, const Limits& b);

/// What a computation cannot do without. Additions and multiplications each count as one.
struct Work {
  double flops = 0;
  double bytes = 0;  ///< from or to memory
};

/// Least time that the limits allow, seconds.
double floor_seconds(const Work& work, const Limits& limits);

/// Bytes that `times` passes over a block bring from memory: what fits into the cache comes once.
double passes(double block_bytes, double times, const Machine& machine);

}  // namespace mimetra::bench
