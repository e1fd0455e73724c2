#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// 2D landmarks over time from a detector.
struct LandmarkTrack {
  std::vector<std::string> names;  ///< one per landmark; "1" to "68" for iBUG's landmarks
  /// F x 2n: x0 y0 x1 y1 ... in pixels, y down, 0 at the middle of the first pixel; NaN if the
  /// landmark was not seen.
  Frames points;
  Eigen::VectorXd times;       ///< seconds (F); empty if the file has none
  Eigen::VectorXd confidence;  ///< detector's confidence in [0, 1] (F); empty if the file has none
  /// Video frames from one row to the next if `times` is empty.
  double step = 1;
  /// Notes for the user from reading, for example on missing frame numbers.
  std::vector<std::string> notes = {};
  /// Whether `times` are the times of capture rather than times at a guessed rate.
  bool times_are_known = true;

  int landmarks() const { return static_cast<int>(names.size()); }
  int frames() const { return static_cast<int>(points.rows()); }
};

}  // namespace mimetra
