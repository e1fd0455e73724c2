#pragma once

#include <string>
#include <vector>

#include "fitting/affine_camera.h"
#include "fitting/clip_fit.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/operations/operation.h"

/// What a fit is worth, in numbers and in words. Internal to fit_operation.h.
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

/// Affine cameras that see the model's origin, and a little around it, as the fitted ones do.
std::vector<AffineCamera> cameras_at_origin(const FittedCoefficients& fit);

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

/// How many of a clip's landmarks its cameras do not see, for the face is between.
class AvertedLandmarks {
 public:
  /// One camera a frame of the fitted `sequence`; landmarks at `vertices`. Frames without landmarks
  /// in `fit` do not count.
  AvertedLandmarks(const MeshSequence& sequence, const FittedCoefficients& fit,
                   const std::vector<int>& vertices, const std::vector<AffineCamera>& cameras);

  /// Throws MismatchError where most frames' faces look away from the camera: a mirror image fits
  /// as well, as such a face, which nobody finds landmarks of. `name` of the landmarks.
  void require_facing(const std::string& name) const;

  /// The landmarks' notes of frames, with those in which the head is turned so far that landmarks
  /// are behind it, of which it warns; none where no frame has one.
  std::vector<std::string> notes(const Invocation& invocation) const;

 private:
  std::vector<int> of_frames_;  ///< -1 of unseen ones
  int landmarks_;
};

/// All of it together.
struct Judgement {
  IdentityVerdict identity;
  FitResiduals residuals;
  double stretch = 1;
  /// Without identities, cameras take what the person's proportions are.
  bool has_identities = true;
  ClipPeople people;
  std::vector<ExpressionUse> expressions;

  /// `names` of the expressions.
  Json json(const std::vector<std::string>& names) const;
  std::string words() const;
};

/// Warns where landmarks are far from the fitted face, as in the wrong order, in all frames or
/// some; where a clip's images are stretched, or its parts show two people; where no person is to
/// be expected; and of expressions that are there all the time, by their `names`.
void warn_of(const Judgement& judgement, const std::vector<std::string>& names,
             const MappedLandmarks& mapped, const FitOptions& options,
             const Invocation& invocation);

}  // namespace mimetra
