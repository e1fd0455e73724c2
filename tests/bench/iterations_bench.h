#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/subjects.h"
#include "toolkit/io/image.h"

namespace mimetra::bench {

/// A decomposition that may take so many iterations, and the transfer by its regions.
struct IterationPoint {
  int allowed = 0;
  int ran = 0;
  bool converged = false;
  double energy = 0;  ///< over that of the first point, percent
  std::optional<double>
      excess;          ///< DE above the full transfer's, percent; none where that is exact
  double share = 0;    ///< of the triangles that regions hold, percent
  double seconds = 0;  ///< of the processor, all threads, for decomposition and regions
};

/// What more iterations give for one subject and number of components.
struct IterationCurve {
  std::string subject;
  int components = 0;
  std::vector<IterationPoint> points;
};

/// Curves for K = 10, 30 and 40 over 10 to 200 iterations; `quick`: for K = 5 over 2 and 4. All
/// other options are their defaults.
std::vector<IterationCurve> iteration_curves(const Subject& subject, bool quick);

/// As Markdown.
std::string table_of(const std::vector<IterationCurve>& curves);

/// A column of charts for each subject: energy, DE, share and seconds against iterations.
Image picture_of(const std::vector<IterationCurve>& curves);

}  // namespace mimetra::bench
