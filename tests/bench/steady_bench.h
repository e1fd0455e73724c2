#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/subjects.h"

namespace mimetra::bench {

/// A transfer by all triangles of a clip as it is, or with noise on every source vertex.
struct SteadyRow {
  std::string space;
  std::string options;  ///< as the command has them
  bool noisy = false;
  double flicker = 0;  ///< RMS second difference of a vertex, percent of the box's diagonal
  double de = 0;       ///< against the clip without noise
  double seconds = 0;  ///< set-up and solve, all threads
  /// Of the weights of all frames, relative to the largest right-hand side; none where each frame
  /// is solved alone, and in vertex space.
  std::optional<double> violation = {};
};

/// Smoothness in both spaces, symmetry and exclusive expressions. Noise has 0.5 % of the box's
/// diagonal, RMS of a vertex's displacement, and a fixed seed.
std::vector<SteadyRow> steady_rows(const Subject& subject, bool quick);

/// As Markdown.
std::string table_of(const std::vector<SteadyRow>& rows);

}  // namespace mimetra::bench
