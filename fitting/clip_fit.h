#pragma once

#include <optional>
#include <vector>

#include "fitting/landmark_fitter.h"
#include "fitting/landmark_mapping.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/mesh/context.h"

/// A clip that is fitted as a whole and in parts. Internal to fit_operation.h.
namespace mimetra {

/// Fits all frames of a clip, or some of them.
class ClipFit {
 public:
  /// Keeps references to model and landmarks; `times` of all frames. Throws as LandmarkFitter.
  ClipFit(const MorphableModel& model, const MappedLandmarks& mapped, Eigen::VectorXd times,
          FitOptions options);

  /// Throws as LandmarkFitter::fit().
  std::vector<FrameFit> all(const Context& context = {}) const;
  /// Fits `frames`, which ascend.
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

/// Whether a clip shows one person: distances of the neutrals that parts of it give.
struct ClipPeople {
  /// Of its two halves, where each has ten frames with landmarks.
  std::optional<NeutralDistance> halves;
  /// The largest of any two places at which the face is in 75 frames and more, as after a cut. Of
  /// one person they are 0.2 to 1.9 % apart, in 40 frames up to 2.1 %.
  std::optional<NeutralDistance> places;
  /// Frames in which the face is at another place than in the one before.
  std::vector<int> cuts;
};

/// Nothing where each frame has its shape, or the model no identities. `fit` of the whole clip.
ClipPeople people_in(const ClipFit& clip, const FittedCoefficients& fit,
                     const Context& context = {});

}  // namespace mimetra
