#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/bench/subjects.h"

namespace mimetra::bench {

/// Weights of each region beside those of the whole face. DE is over all triangles; distances are
/// in percent of the target's diameter.
struct PerRegionRow {
  std::string subject;
  int regions = 0;
  double falloff = 0;  ///< share of the diameter
  double ridge = 0;
  double de_whole = 0, de_regions = 0;
  /// Weights found on a random half of the triangles, measured on the other half; both ways.
  double held_out_whole = 0, held_out_regions = 0;
  /// From what the target truly does, over vertices and frames: mean and largest.
  struct Distance {
    double mean = 0, largest = 0;
  };
  std::optional<Distance> true_whole = {}, true_regions = {};
  double seconds_whole = 0, seconds_regions = 0;
  double violation = 0;
};

/// Rows for 10 and 30 regions and falloffs of 0.1 and 0.25, with other ridges for the first of
/// them; `quick`: one row. Of long performances 60 frames are taken, evenly. Halves are drawn with
/// a fixed seed.
std::vector<PerRegionRow> per_region_rows(const Subject& subject, bool quick);

/// In Markdown.
std::string table_of(const std::vector<PerRegionRow>& rows);

}  // namespace mimetra::bench
