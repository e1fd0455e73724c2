#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace mimetra {

/// Numbers 0 .. n - 1 in sets, which are joined; the lowest member stands for its set.
class DisjointSets {
 public:
  /// Each number alone.
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

  std::vector<int> lower_;  // in the same set; itself for the lowest
};

}  // namespace mimetra
