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

/// Quality of a fit, as numbers and as text. Internal to fit_operation.h.
namespace mimetra {

/// Plausibility of a fitted identity.
struct IdentityVerdict {
  double alpha_rms = 0;  ///< in standard deviations of the model
  double alpha_max = 0;  ///< largest absolute coefficient
  int flipped = 0;       ///< triangles of the neutral that face away from those of the mean face
  int triangles = 0;     ///< number of triangles of the model
  /// True if the model is not likely to contain such a person.
  bool is_doubtful() const;
};

IdentityVerdict verdict_of(const MorphableModel& model, const Eigen::VectorXd& alpha);

/// Distances between landmarks and the fitted face.
struct FitResiduals {
  /// RMS over the landmarks of each frame, as a share of their RMS radius (F). NaN if no landmark
  /// is seen.
  Eigen::VectorXd of_frames;
  /// RMS over the frames of each landmark, in pixels (n).
  Eigen::VectorXd of_landmarks;

  /// Median over the frames.
  double typical() const;
};

/// Residual, as a share of the face's RMS radius, above which landmarks do not fit the mapping.
/// Real faces reach 0.05 to 0.06; landmarks in a wrong order or at wrong vertices reach 0.2 to 0.7.
constexpr double kFarLandmarks = 0.12;

/// Distances between the landmarks of `mapped` and the projections of their vertices of `sequence`
/// by the cameras of `fit`.
FitResiduals residuals_of(const MeshSequence& sequence, const FittedCoefficients& fit,
                          const MappedLandmarks& mapped);

/// Affine cameras that agree with the fitted ones at and near the model's origin.
std::vector<AffineCamera> cameras_at_origin(const FittedCoefficients& fit);

/// Ratio of the horizontal to the vertical scale of the cameras, as the geometric mean over the
/// frames with landmarks: 1 for square pixels. `cameras` are affine, as from cameras_at_origin().
double stretch_of(const std::vector<AffineCamera>& cameras, const FittedCoefficients& fit);

/// Largest plausible stretch_of(), or its inverse. Beyond it, the given size of the images is
/// probably wrong. Real faces have 0.98 to 1.08.
constexpr double kStretched = 1.15;

/// Use of one expression in a clip.
struct ExpressionUse {
  double mean = 0;
  double at_zero = 0;  ///< share of the frames at its lower bound
  double at_one = 0;   ///< share of the frames at its upper bound
  /// True if the expression is active all the time, like a part of the face.
  bool is_constant() const;
};

/// Use of each column of `beta` (F x D), which is bounded by 0 and 1.
std::vector<ExpressionUse> expression_use(const Eigen::MatrixXd& beta);

/// Number of landmarks whose vertex normal points away from the camera. `mesh` is N x 3.
int averted_landmarks(const Positions& mesh, const Triangles& triangles,
                      const std::vector<int>& vertices, const AffineCamera& camera);

/// Landmarks of a clip that the face hides from its cameras.
class AvertedLandmarks {
 public:
  /// `sequence` has one camera a frame and its landmarks at `vertices`. Frames without landmarks in
  /// `fit` are ignored.
  AvertedLandmarks(const MeshSequence& sequence, const FittedCoefficients& fit,
                   const std::vector<int>& vertices, const std::vector<AffineCamera>& cameras);

  /// Throws MismatchError if the face looks away from the camera in most frames. Mirrored landmarks
  /// fit such a face, and no detector finds one. `name` is the name of the landmarks.
  void require_facing(const std::string& name) const;

  /// Returns a note for each frame (F), or nothing if there are none. It notes frames with at least
  /// a quarter of the landmarks behind the face, and warns the user.
  std::vector<std::string> notes(const Invocation& invocation) const;

 private:
  std::vector<int> of_frames_;  ///< number of averted landmarks; -1 in frames without landmarks
  int landmarks_;
};

/// All judgements of one fit.
struct Judgement {
  IdentityVerdict identity;
  FitResiduals residuals;
  double stretch = 1;
  /// Without identities, the cameras absorb the person's proportions.
  bool has_identities = true;
  ClipPeople people;
  std::vector<ExpressionUse> expressions;

  /// `names` are the names of the expressions.
  Json json(const std::vector<std::string>& names) const;
  std::string words() const;
};

/// Warns the user about landmarks far from the face in all or some frames, and about stretched
/// images. Warns about parts that show two people, an implausible identity, and expressions that
/// are always active. `names` are the names of the expressions.
void warn_of(const Judgement& judgement, const std::vector<std::string>& names,
             const MappedLandmarks& mapped, const FitOptions& options,
             const Invocation& invocation);

}  // namespace mimetra
