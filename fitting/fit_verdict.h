#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fitting/landmark_fitter.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/fit_file.h"

/// Whether what was fitted can be a person. Internal to fit_operation.h.
namespace mimetra {

/// Of a fitted identity.
struct IdentityVerdict {
  double alpha_rms = 0;  ///< in standard deviations of the model
  double alpha_max = 0;  ///< the largest, by size
  int flipped = 0;       ///< triangles of the neutral that are turned against the mean face
  int triangles = 0;     ///< of the model
  /// True where a person of the model is not to be expected.
  bool is_doubtful() const;
};

IdentityVerdict verdict_of(const MorphableModel& model, const Eigen::VectorXd& alpha);

/// Distances of the vertices of two neutrals, as shares of the longest side of the model's mean.
struct NeutralDistance {
  double mean = 0;
  double largest = 0;
};

NeutralDistance neutral_distance(const MorphableModel& model, const Eigen::VectorXd& a,
                                 const Eigen::VectorXd& b);

/// Above this share of the longest side, on average, the neutrals of a clip's halves are those of
/// two people. Of one person they are 0.4 to 1.2 % apart, of two 2.5 % and more.
constexpr double kTwoPeople = 0.02;

/// How far landmarks are from the fitted face.
struct FitResiduals {
  /// RMS over the landmarks of each frame as a share of their RMS radius (F); NaN where none was
  /// seen.
  Eigen::VectorXd of_frames;
  /// RMS over the frames of each landmark, in pixels (n).
  Eigen::VectorXd of_landmarks;

  /// The median of the frames.
  double typical() const;
};

/// Above this share of the face's RMS radius landmarks are not those of the mapping. Landmarks of
/// real faces are 0.05 to 0.06 of it from the face, in the wrong order or at wrong vertices 0.2 to
/// 0.7.
constexpr double kFarLandmarks = 0.12;

/// Of the landmarks of `mapped` from where the cameras of `fit` see their vertices of the fitted
/// `sequence`.
FitResiduals residuals_of(const MeshSequence& sequence, const FittedCoefficients& fit,
                          const MappedLandmarks& mapped);

/// How many times as wide as high the cameras show things in which landmarks were seen, on average:
/// 1 for images of square pixels. Affine cameras, as cameras_at_origin().
double stretch_of(const std::vector<AffineCamera>& cameras, const FittedCoefficients& fit);

/// Farther from 1 than by this factor the images are not as wide or high as they were said to be.
/// Of real faces the stretch is 0.98 to 1.08.
constexpr double kStretched = 1.15;

/// How an expression is used in a clip.
struct ExpressionUse {
  double mean = 0;
  double at_zero = 0;  ///< share of the frames in which it is at its lower bound
  double at_one = 0;   ///< at its upper bound
  /// True where it is there all the time, as if it were a part of the face.
  bool is_constant() const;
};

/// Of each column of `beta` (F x D), bounds 0 and 1.
std::vector<ExpressionUse> expression_use(const Eigen::MatrixXd& beta);

/// How many of the landmarks at `vertices` are on a side of the mesh (N x 3) that a camera does not
/// see, by the normals there.
int averted_landmarks(const Positions& mesh, const Triangles& triangles,
                      const std::vector<int>& vertices, const AffineCamera& camera);

}  // namespace mimetra
