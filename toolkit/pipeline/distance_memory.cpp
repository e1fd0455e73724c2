#include "toolkit/pipeline/distance_memory.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

double distance_bytes(GeodesicMethod method, Eigen::Index vertices, int sources,
                      const Context& context) {
  if (method != GeodesicMethod::exact) return 0;
  // CGAL's sequence trees: measured on faces of 7 to 105 thousand vertices.
  constexpr double kOfTree = 210;
  const int most = context.threads() > 0
                       ? context.threads()
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return std::min(most, sources) * kOfTree * std::pow(static_cast<double>(vertices), 1.5);
}

Context beside_distances(GeodesicMethod method, Eigen::Index vertices, int sources,
                         const Context& context) {
  const double bytes = distance_bytes(method, vertices, sources, context);
  const std::optional<double> memory = context.memory();
  if (!memory || bytes == 0) return context;
  if (bytes > *memory) {
    throw MismatchError("option 'memory': exact distances along " + std::to_string(vertices) +
                        " vertices take " + fixed(std::ceil(bytes / 1e6), 0) +
                        " MB on all threads; allow more, take fewer threads, or distances by heat");
  }
  return context.with_memory(*memory - bytes);
}

}  // namespace mimetra
