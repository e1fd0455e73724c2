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
};

/// Reads an ARKit / Live Link Face style CSV: a header of names, one row a frame; columns `time`
/// (seconds), `frame`, `Timecode` and `BlendShapeCount` are not weights. Accepts a byte-order mark
/// and CRLF. Throws IoError that names line and column for ragged rows (decimal commas make some),
/// another separator, what is not a finite number, times that do not ascend, and duplicate names.
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
