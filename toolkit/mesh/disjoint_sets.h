#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace mimetra {

/// Disjoint sets of the numbers 0 .. n - 1. The lowest member represents its set.
class DisjointSets {
 public:
  /// Starts with each number in a set of its own.
  explicit DisjointSets(int count) : lower_(static_cast<std::size_t>(count)) {
    std::iota(lower_.begin(), lower_.end(), 0);
  }

  /// The lowest number in the set of `member`.
  int lowest(int member) {
    while (lower(member) != member) member = lower(member) = lower(lower(member));
    return member;
  }

  void join(int a, int b) {
    const auto [low, high] = std::minmax({lowest(a), lowest(b)});
    lower(high) = low;
  }

 private:
  int& lower(int member) { return lower_[static_cast<std::size_t>(member)]; }

  std::vector<int> lower_;  // a lower member of the same set, or the number itself if lowest
};

}  // namespace mimetra
