#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// 2D landmarks over time, as a detector delivers them.
struct LandmarkTrack {
  std::vector<std::string> names;  ///< one per landmark; "1" to "68" for iBUG's
  /// F x 2n: x0 y0 x1 y1 ... in pixels, y down, 0 at the middle of the first pixel; NaN where a
  /// landmark was not seen.
  Frames points;
  Eigen::VectorXd times;       ///< seconds (F); empty where the file has none
  Eigen::VectorXd confidence;  ///< of the detector, in [0, 1] (F); empty where the file has none
  /// Where it has no times: frames of the video from one to the next.
  double step = 1;
  /// What was noticed while reading: numbers of frames that are missing.
  std::vector<std::string> notes = {};
  /// Whether `times` tell when the frames were taken, not at a rate that is guessed.
  bool times_are_known = true;

  int landmarks() const { return static_cast<int>(names.size()); }
  int frames() const { return static_cast<int>(points.rows()); }
};

}  // namespace mimetra
