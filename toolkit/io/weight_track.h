#pragma once

#include <limits>
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
  /// What was noticed while reading, such as times that cannot be told.
  std::vector<std::string> notes = {};
  /// Where it has no times: frames of the animation from one row to the next, 2 for rows of the
  /// frames 1001, 1003, ...
  double step = 1;
  /// Of a fit, whose coefficients may have any size.
  bool is_fit = false;
};

/// Which column of a track drives which expression.
struct WeightMatch {
  std::vector<int> column;  ///< for each expression; -1 where none
  std::vector<std::string> unmatched_columns;
  std::vector<std::string> undriven_expressions;
};

/// Names match exactly, then with Left/Right for _L/_R of the expression, then of the column, then
/// one name drives both halves; without regard to case and underscores at each step only where
/// nothing matched exactly. What matches nothing is tried without the node that its name begins
/// with (`blendShape1.jawOpen`), or where it has none, that a column's does, if one column only is
/// called so.
WeightMatch match_weights(const WeightTrack& track, const std::vector<std::string>& expressions);

/// Weights in the order of the expressions (F x D), 0 where nothing drives one. Throws
/// MismatchError where no name is known.
Eigen::MatrixXd weights_for(const WeightTrack& track, const std::vector<std::string>& expressions);

/// Stands for a weight that is missing.
inline constexpr double kMissingWeight = std::numeric_limits<double>::quiet_NaN();

/// Weights that are missing, as in rows where a capture lost the face, lie between their
/// neighbours in time: by the track's times, else by its rows. The first and the last that there
/// are stay beyond them. Adds notes on the rows and columns. \pre each column has a number
void fill_missing_weights(WeightTrack& track);

/// Multiplies the weights by `scale`. Without one, throws IoError that begins with `name` where a
/// weight is farther than 2 from 0, as those in percent are, unless they are a fit's. Columns that
/// drive none of `expressions`, such as a head's pose in degrees, may have any size.
void scale_weights(const std::string& name, WeightTrack& track,
                   const std::vector<std::string>& expressions, std::optional<double> scale);

/// Adds to the notes, once, what is odd about times that nobody captures at.
void note_odd_times(WeightTrack& track);

}  // namespace mimetra
