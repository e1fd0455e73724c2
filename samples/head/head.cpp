#include <mimetra/samples/head.h>

#include <mimetra/samples/expressions.h>
#include <mimetra/samples/head_shape.h>

namespace mimetra::samples {

MorphableModel parametric_head() {
  const HeadGrid grid = head_grid();
  const Positions mean = head_positions(grid);
  const auto connectivity = std::make_shared<const Connectivity>(
      Connectivity::from_polygons(static_cast<int>(grid.vertices.size()), grid.faces));
  return {connectivity, mean, head_identities(mean), head_expressions(grid)};
}

}  // namespace mimetra::samples
