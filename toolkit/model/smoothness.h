#pragma once

#include <Eigen/Core>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// Row f contains the factors of frames f, f + 1 and f + 2 in their second difference over time.
using SecondDifferences = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Median of the steps between `times` (F >= 2). Throws std::invalid_argument if it is not
/// positive.
double median_step(const Eigen::VectorXd& times);

/// Divided differences in units of the median step (F - 2 rows); evenly spaced frames have 1, -2,
/// 1. Their sum of squares is the integral of the squared second derivative, so a longer gap bends
/// more easily in proportion to its length. `times` ascend (F >= 3). Throws as median_step().
SecondDifferences second_differences(const Eigen::VectorXd& times);

/// Second differences of F x D values: (F - 2) x D.
Eigen::MatrixXd differences_of(const SecondDifferences& differences, const Eigen::MatrixXd& values);

/// Weight mu = (smoothness * frame rate)^4 * mean_diagonal of squared second differences, with the
/// frame rate of the median time step. `smoothness` and `times` in seconds; `mean_diagonal` is
/// trace(G) / D. Returns 0 for fewer than two times. Throws std::invalid_argument if the median
/// time step is not positive.
double smoothness_penalty(double smoothness, const Eigen::VectorXd& times, double mean_diagonal);

/// Filter that makes motion steady over time. For each coordinate x of F frames, it finds the y
/// that minimises
///   sum_f (y_f - x_f)^2 + mu |D2 y|^2,   mu = (smoothness * frame rate)^4,
/// with the second differences D2 and the frame rate of the median time step, as for weights.
///
/// The constructor factors one pentadiagonal system of F - 2 unknowns: y = x - D2^T (D2 D2^T +
/// I / mu)^-1 D2 x. So coordinates that do not move stay bit by bit, and motion along a straight
/// line stays to rounding. The mean and the linear trend of any motion are kept. Queries are const.
///
/// [Reinsch. Smoothing by spline functions. Numerische Mathematik 10, 1967]
class MotionFilter {
 public:
  /// `times` (F) and `smoothness` in seconds. Throws std::invalid_argument if the smoothness is
  /// negative or the median time step is not positive.
  MotionFilter(const Eigen::VectorXd& times, double smoothness);

  /// Filters frames (F x any number of coordinates), each coordinate on its own. Returns them
  /// unchanged if there are fewer than three or the smoothness is 0. Throws std::invalid_argument
  /// for another number of frames, and Cancelled.
  Frames operator()(Frames frames, const Context& = {}) const;

 private:
  /// 32 coordinates of 1000 frames fit in a core's cache. All blocks have the same width, so that
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
