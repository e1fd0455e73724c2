#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Blendshape weights over time, as a capture delivers them.
struct WeightTrack {
  std::vector<std::string> names;  ///< one per column
  Eigen::MatrixXd weights;         ///< F x names
  Eigen::VectorXd times;           ///< seconds (F); empty where the file has none
  /// What was noticed while reading: times that cannot be told, weights that look like percent.
  std::vector<std::string> notes = {};
};

/// Reads weights. An ARKit / Live Link Face style CSV has a header of names and one row a frame;
/// columns `time` (seconds), `frame`, `Timecode` and `BlendShapeCount` are not weights. Timecodes
/// give times from 0 on, at the rate that their frames are counted by. A byte-order mark and CRLF
/// are accepted.
///
/// NAME.json holds rows of objects ([{"time": 0, "jawOpen": 0.5}], or these as "rows" or "frames"),
/// or "names" and "weights" (F x names) with "times" or "fps", by Audio2Face's keys too, or is what
/// `mimetra fit` wrote.
///
/// Throws IoError that names line and column for ragged rows (decimal commas make some), another
/// separator, what is not a finite number, times that do not ascend, duplicate names, JSON in a CSV
/// and the other way round.
WeightTrack read_weights(const std::filesystem::path& path);

/// Writes `time` and one column per name, the shortest digits that read back equal. Throws
/// OutputError; std::invalid_argument where names, times and weights differ in number.
void write_weights(const std::filesystem::path& path, const WeightTrack& track, bool overwrite);

/// Which column of a track drives which expression.
struct WeightMatch {
  std::vector<int> column;  ///< for each expression; -1 where none
  std::vector<std::string> unmatched_columns;
  std::vector<std::string> undriven_expressions;
};

/// Names match exactly, then with Left/Right for _L/_R, then one name drives both halves; without
/// regard to case and underscores at each step only where nothing matched exactly.
WeightMatch match_weights(const WeightTrack& track, const std::vector<std::string>& expressions);

/// Weights in the order of the expressions (F x D), 0 where nothing drives one. Throws
/// MismatchError where no name is known.
Eigen::MatrixXd weights_for(const WeightTrack& track, const std::vector<std::string>& expressions);

}  // namespace mimetra
