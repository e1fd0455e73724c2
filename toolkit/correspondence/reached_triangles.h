#pragma once

#include <vector>

#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Triangles of the parts that a marker reaches, and their numbers.
struct ReachedTriangles {
  ReachedTriangles(const Positions& positions, const Triangles& all,
                   const std::vector<bool>& reached) {
    for (int t = 0; t < all.rows(); ++t) {
      if (reached[all(t, 0)]) numbers.push_back(t);
    }
    triangles = Weld::exact(positions).welded(all(numbers, Eigen::all));
  }

  std::vector<int> numbers;
  Triangles triangles;  ///< on the lowest vertices of each place
};

}  // namespace mimetra
