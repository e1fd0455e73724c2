#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

/// Weights over time as the files of scenes have them. Internal to their formats.
namespace mimetra {

/// Weights of the targets of one part over time: keys, and what lies between them.
struct WeightCurve {
  enum class Between { step, linear, cubic };

  Between between = Between::linear;
  Eigen::VectorXd times;   ///< of the keys (K), rising
  Eigen::MatrixXd values;  ///< K x targets; one row without times for weights that stay
  /// Slopes before and after each key, K x targets, of cubic curves.
  Eigen::MatrixXd slopes_in, slopes_out;

  /// The weights at a time; those of the nearest key outside of the keys. \pre there is a row
  Eigen::RowVectorXd at(double time) const;
  /// Whether they are the same at all times. \pre there is a row
  bool is_still() const;
};

/// The times of the frames that show all curves: their keys, those that only rounding parts as the
/// first curve has them; between the keys of splines, which move on a line nowhere, as often as
/// frames without times are; and a frame before each jump of steps, unless another curve has one
/// there. They rise. Throws IoError that begins with `path` where splines last too long.
Eigen::VectorXd shown_times(const std::string& path, const std::vector<const WeightCurve*>& curves);

}  // namespace mimetra
