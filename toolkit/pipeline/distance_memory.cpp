#include "toolkit/pipeline/distance_memory.h"

#include <algorithm>
#include <cmath>
#include <thread>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

double exact_distance_bytes(Eigen::Index vertices, int threads, int sources) {
  // CGAL's sequence trees: measured on faces of 7 to 105 thousand vertices.
  constexpr double kOfTree = 210;
  const int most =
      threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return std::min(most, sources) * kOfTree * std::pow(static_cast<double>(vertices), 1.5);
}

double reserved_for_distances(DecompositionOptions& decomposition, GeodesicMethod method,
                              Eigen::Index vertices, int threads) {
  if (method != GeodesicMethod::exact) return 0;
  const double bytes = exact_distance_bytes(vertices, threads, decomposition.count);
  if (!decomposition.memory) return bytes;
  if (bytes > *decomposition.memory) {
    throw MismatchError("option 'memory': exact distances along " + std::to_string(vertices) +
                        " vertices take " + fixed(std::ceil(bytes / 1e6), 0) +
                        " MB on all threads; allow more, take fewer threads, or distances by heat");
  }
  *decomposition.memory -= bytes;
  return bytes;
}

}  // namespace mimetra
