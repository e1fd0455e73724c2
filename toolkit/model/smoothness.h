#pragma once

#include <Eigen/Core>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Row f holds the factors of frames f, f + 1 and f + 2 in their second difference over time.
using SecondDifferences = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// The middle one of the steps between `times` (F >= 2). Throws std::invalid_argument where it is
/// not positive.
double median_step(const Eigen::VectorXd& times);

/// Divided differences in units of the median step, so that evenly spaced frames have 1, -2, 1 (F -
/// 2 rows): their sum of squares is the integral of the squared second derivative, and a gap bends
/// as easily as its length says. `times` ascend (F >= 3). Throws as median_step.
SecondDifferences second_differences(const Eigen::VectorXd& times);

/// The second differences of F x D values: (F - 2) x D.
Eigen::MatrixXd differences_of(const SecondDifferences& differences, const Eigen::MatrixXd& values);

/// Weight mu = (smoothness * frame rate)^4 * mean_diagonal of squared second differences, with the
/// frame rate of the median time step. `smoothness` and `times` in seconds; `mean_diagonal` is
/// trace(G) / D. Throws std::invalid_argument where the median time step is not positive.
double smoothness_penalty(double smoothness, const Eigen::VectorXd& times, double mean_diagonal);

/// Motions that are steady over time: for each coordinate x of F frames, the y that minimises
///   sum_f (y_f - x_f)^2 + mu |D2 y|^2,   mu = (smoothness * frame rate)^4,
/// with the second differences D2 and the frame rate of the median time step, as for weights.
///
/// The constructor factors one pentadiagonal system of F - 2 unknowns, the second differences of y:
/// y = x - D2^T (D2 D2^T + I / mu)^-1 D2 x. So what does not move stays bit by bit, motion along a
/// straight line stays to rounding, and mean and trend of any motion are kept. Queries are const.
///
/// [Reinsch. Smoothing by spline functions. Numerische Mathematik 10, 1967]
class MotionFilter {
 public:
  /// `times` (F) and `smoothness` in seconds. Throws std::invalid_argument where the smoothness is
  /// below 0 or the median time step is not positive.
  MotionFilter(const Eigen::VectorXd& times, double smoothness);

  /// F x any number of coordinates, each on its own; the frames themselves where there are fewer
  /// than three or the smoothness is 0. Throws std::invalid_argument for another number of frames,
  /// Cancelled.
  Frames operator()(Frames frames, const Context& = {}) const;

 private:
  /// So many coordinates of 1000 frames stay in a core's cache. All blocks are as wide, so that
  /// equal motions stay equal bit by bit.
  static constexpr int kCoordinates = 32;
  using Block = Eigen::Matrix<double, Eigen::Dynamic, kCoordinates, Eigen::RowMajor>;

  void smooth(Block& x) const;

  Eigen::Index frames_;
  bool acts_ = false;
  SecondDifferences differences_;  // F - 2 rows
  // L D L^T of the system: D, and the two bands below the diagonal of L.
  Eigen::VectorXd pivots_, first_, second_;
};

}  // namespace mimetra
