#include "samples/head/head.h"

#include "samples/head/expressions.h"
#include "samples/head/head_shape.h"

namespace mimetra::samples {

MorphableModel parametric_head() {
  const HeadGrid grid = head_grid();
  const Positions mean = head_positions(grid);
  const auto connectivity = std::make_shared<const Connectivity>(
      Connectivity::from_polygons(static_cast<int>(grid.vertices.size()), grid.faces));
  return {connectivity, mean, head_identities(mean), head_expressions(grid)};
}

}  // namespace mimetra::samples
