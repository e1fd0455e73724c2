#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Blendshape weights over time, such as from a capture.
struct WeightTrack {
  std::vector<std::string> names;  ///< one per column
  Eigen::MatrixXd weights;         ///< F x names
  Eigen::VectorXd times;           ///< seconds (F); empty if the file has none
  /// Notes from reading, such as on times that cannot be determined.
  std::vector<std::string> notes = {};
  /// For tracks without times: animation frames from one row to the next, such as 2 for rows of the
  /// frames 1001, 1003, ...
  double step = 1;
  /// True for the result of a fit, whose coefficients may have any size.
  bool is_fit = false;
};

/// Columns of a track that drive the expressions.
struct WeightMatch {
  std::vector<int> column;  ///< for each expression; -1 if none
  std::vector<std::string> unmatched_columns;
  std::vector<std::string> undriven_expressions;
};

/// Matches expressions with columns. Each step compares names exactly, and then without case and
/// underscores:
///  - the names as given;
///  - the expression's name with Left/Right for _L/_R, and then also the column's;
///  - the expression's name without its side, so that one column drives both halves.
///
/// An expression without match is compared without the node at the start of its name
/// (`blendShape1.jawOpen`). If its name has no node, column names are compared without theirs,
/// unless that makes them ambiguous.
WeightMatch match_weights(const WeightTrack& track, const std::vector<std::string>& expressions);

/// Weights in the order of the expressions (F x D), 0 for expressions without column. Throws
/// MismatchError if no name matches.
Eigen::MatrixXd weights_for(const WeightTrack& track, const std::vector<std::string>& expressions);

/// Value of a missing weight.
inline constexpr double kMissingWeight = std::numeric_limits<double>::quiet_NaN();

/// Fills missing weights, as in rows in which a capture lost the face, by linear interpolation in
/// time. Tracks without times use row numbers. Before the first and after the last known weight,
/// the value stays constant. Adds notes on the rows and columns.
/// \pre each column has a number
void fill_missing_weights(WeightTrack& track);

/// Multiplies the weights by `scale`. Without a scale, throws IoError, which begins with `name`, if
/// a weight is farther than 2 from 0, such as one in percent. Weights of a fit are not checked.
/// Columns that drive none of `expressions`, such as a head's pose in degrees, may have any size.
void scale_weights(const std::string& name, WeightTrack& track,
                   const std::vector<std::string>& expressions, std::optional<double> scale);

/// Adds a note, once, if the times are implausible for a capture.
void note_odd_times(WeightTrack& track);

}  // namespace mimetra
