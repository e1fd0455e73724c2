#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/io/weight_track.h"

namespace mimetra {

/// What was fitted to a clip: the coefficients of a morphable model and the cameras.
struct FittedCoefficients {
  std::vector<std::string> identities;   ///< names, one per column of alpha
  std::vector<std::string> expressions;  ///< names, one per column of beta
  Eigen::VectorXd times;                 ///< seconds (F), ascending
  Eigen::MatrixXd alpha;                 ///< F x identities
  Eigen::MatrixXd beta;                  ///< F x expressions
  /// Upper two rows of cameras: image point in pixels = C (x y z 1)^T (F), divided by the third
  /// row's product where there are `depths`.
  std::vector<Eigen::Matrix<double, 2, 4>> cameras;
  Eigen::Matrix<double, Eigen::Dynamic, 4> depths =
      {};                      ///< third rows of perspective cameras, or none
  Eigen::VectorXd rms;         ///< reprojection error in pixels (F); NaN where nothing was seen
  Eigen::VectorXi landmarks;   ///< those seen (F)
  Eigen::VectorXi iterations;  ///< of the solver (F)
  /// `rms` with landmarks on the outline (F), or none; it is not read again.
  Eigen::VectorXd rms_all = {};
  /// What was noticed in each frame (F, "" for nothing), or none.
  std::vector<std::string> notes = {};

  bool has_one_identity() const { return (alpha.rowwise() - alpha.row(0)).isZero(0); }
  int frames() const { return static_cast<int>(alpha.rows()); }
  /// The one alpha of all frames; the mean over the frames that were seen where they differ.
  Eigen::VectorXd identity() const;
  /// The expressions over time.
  WeightTrack performance() const { return {expressions, beta, times, {}, 1, true}; }
};

/// The text of a fit.json: {"identities": [names], "expressions": [names], "frames": [{"time",
/// "rms_px" (null: nothing was seen), "rms_px_all", "note" (where there is one), "landmarks",
/// "iterations", "alpha", "beta", "camera":
/// [[4 numbers], [4]], and a third row of a perspective one}]}, with the shortest digits that read
/// back equal.
std::string fit_json(const FittedCoefficients& fit);

/// Reads it; other keys are left out. Throws IoError that names the element, and what was expected
/// there.
FittedCoefficients read_fit(const std::filesystem::path& path);

}  // namespace mimetra
