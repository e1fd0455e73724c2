#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/io/weight_track.h"

namespace mimetra {

/// Result of a fit to a clip: the coefficients of a morphable model and the cameras.
struct FittedCoefficients {
  std::vector<std::string> identities;   ///< names, one per column of alpha
  std::vector<std::string> expressions;  ///< names, one per column of beta
  Eigen::VectorXd times;                 ///< seconds (F), ascending
  Eigen::MatrixXd alpha;                 ///< F x identities
  Eigen::MatrixXd beta;                  ///< F x expressions
  /// Upper two rows of the cameras (F): image point in pixels = C (x y z 1)^T. If there are
  /// `depths`, divide it by the product of the third row with (x y z 1)^T.
  std::vector<Eigen::Matrix<double, 2, 4>> cameras;
  Eigen::Matrix<double, Eigen::Dynamic, 4> depths =
      {};                      ///< third rows of perspective cameras, or none
  Eigen::VectorXd rms;         ///< reprojection error in pixels (F); NaN if nothing was seen
  Eigen::VectorXi landmarks;   ///< number of landmarks seen (F)
  Eigen::VectorXi iterations;  ///< iterations of the solver (F)
  /// Reprojection error including landmarks on the outline (F, pixels), or empty. read_fit() leaves
  /// it empty.
  Eigen::VectorXd rms_all = {};
  /// Note on each frame (F, "" for none), or empty. read_fit() leaves it empty.
  std::vector<std::string> notes = {};

  bool has_one_identity() const { return (alpha.rowwise() - alpha.row(0)).isZero(0); }
  int frames() const { return static_cast<int>(alpha.rows()); }
  /// Alpha of the clip. If the frames differ, the mean over frames with landmarks, or over all
  /// frames if none has any.
  Eigen::VectorXd identity() const;
  WeightTrack performance() const { return {expressions, beta, times, {}, 1, true}; }
};

/// Text of a fit.json: {"identities": [names], "expressions": [names], "frames": [{"time",
/// "rms_px", "landmarks", "iterations", "alpha", "beta", "camera": [[4 numbers], [4]],
/// "rms_px_all", "note"}]}.
///
/// "rms_px" is null if nothing was seen; "rms_px_all" and "note" are optional. A perspective camera
/// has a third row. Numbers have the shortest digits that read back equal.
std::string fit_json(const FittedCoefficients& fit);

/// Reads a fit.json; ignores other keys. Throws IoError with the place of the bad element and what
/// was expected there.
FittedCoefficients read_fit(const std::filesystem::path& path);

}  // namespace mimetra
