#pragma once

#include <optional>
#include <vector>

#include "fitting/fitted_frame.h"

/// The noise of a clip's landmarks, estimated from what a fit leaves of them. Internal to
/// landmark_fitter.h.
namespace mimetra {

/// What is known of the noise before a fit.
struct KnownNoise {
  bool sigma = false;  ///< that of the frames is
  std::optional<double> repeated = {};
  bool outliers = false;  ///< there are none

  bool all() const { return sigma && repeated && outliers; }
};

/// What the options say of it for the joint solver and a clip of so many frames with one shape.
KnownNoise known_noise(const FitOptions& options, std::size_t frames);

/// By the median of what the mean face leaves, which no outlier among less than half of them moves.
/// Half of it is taken as repeated where that is not known.
ClipNoise rough_noise(const std::vector<FittedFrame>& frames, const KnownNoise& known);

/// Sigma, across the outline, of landmarks there, weighed as others are.
double outline_noise(const std::vector<FittedFrame>& frames, const ClipNoise& noise);

/// One step of expectation maximisation with the landmarks' weights of the frames. Of the repeated
/// error the fit hides what the identities follow: `determined` is the number of them that the
/// landmarks determine and not the prior.
///
/// [MacKay. Bayesian interpolation. Neural Computation 4(3), 1992]
/// [Liu, Rubin. ML estimation of the t distribution using EM and its extensions, ECM and ECME.
///  Statistica Sinica 5, 1995]
ClipNoise estimated_noise(const std::vector<FittedFrame>& frames, double determined,
                          const KnownNoise& known);

/// Sets sigma and the landmarks' weights of the frames, also those on the outline.
void set_noise(std::vector<FittedFrame>& frames, const ClipNoise& noise, const KnownNoise& known);

}  // namespace mimetra
