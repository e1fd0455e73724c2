#pragma once

#include <optional>
#include <vector>

#include "fitting/landmark_fitter.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/mesh/context.h"

/// Fits of a clip as a whole and in parts. Internal to fit_operation.h.
namespace mimetra {

class ClipFit {
 public:
  /// Keeps references to model and landmarks. `times` covers all frames. Throws as LandmarkFitter.
  ClipFit(const MorphableModel& model, const MappedLandmarks& mapped, Eigen::VectorXd times,
          FitOptions options);

  /// Fits all frames. Throws as LandmarkFitter::fit().
  std::vector<FrameFit> all(const Context& context = {}) const;
  /// Fits `frames`, given in ascending order.
  std::vector<FrameFit> of(const std::vector<int>& frames, const Context& context = {}) const;

  const MorphableModel& model() const { return model_; }
  const MappedLandmarks& mapped() const { return mapped_; }
  FitOptions::Shape shape() const { return options_.shape; }

 private:
  const MorphableModel& model_;
  const MappedLandmarks& mapped_;
  Eigen::VectorXd times_;
  FitOptions options_;
  bool outline_;
  LandmarkFitter fitter_;
};

/// Distances between the vertices of two neutrals, as shares of the longest side of the mean face.
struct NeutralDistance {
  double mean = 0;
  double largest = 0;
};

NeutralDistance neutral_distance(const MorphableModel& model, const Eigen::VectorXd& a,
                                 const Eigen::VectorXd& b);

/// Mean distance above which the neutrals of a clip's halves belong to two people. Two halves of
/// one person are 0.4 to 1.2 % apart; two people are 2.5 % and more apart.
constexpr double kTwoPeople = 0.02;

/// Distances between the neutrals that parts of a clip give: small if the clip shows one person.
struct ClipPeople {
  /// Distance between the clip's halves, if each half has ten frames with landmarks.
  std::optional<NeutralDistance> halves;
  /// Largest distance between two places that each hold the face in 75 frames or more, as after a
  /// cut. The places of one person are 0.2 to 1.9 % apart; with only 40 frames, up to 2.1 %.
  std::optional<NeutralDistance> places;
  /// Frames in which the face is at another place than in the previous frame.
  std::vector<int> cuts;
};

/// Returns nothing if each frame has its own shape or the model has no identities. `fit` is the fit
/// of the whole clip.
ClipPeople people_in(const ClipFit& clip, const FittedCoefficients& fit,
                     const Context& context = {});

}  // namespace mimetra
