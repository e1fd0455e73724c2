#pragma once

#include <optional>
#include <vector>

#include "fitting/fitted_frame.h"

/// Noise of a clip's landmarks, estimated from the residuals of a fit. Internal to
/// landmark_fitter.h.
namespace mimetra {

/// Parts of the noise that are fixed before a fit.
struct KnownNoise {
  bool sigma = false;  ///< the frames' own sigma is used
  std::optional<double> repeated = {};
  bool outliers = false;  ///< all landmarks have the same weight

  bool all() const { return sigma && repeated && outliers; }
};

/// Noise that the options fix when the joint solver fits a clip of `frames` frames.
KnownNoise known_noise(const FitOptions& options, std::size_t frames);

/// Estimates the noise from the median residual of the mean face, which a minority of outliers does
/// not move. Half of the noise counts as repeated if that share is unknown.
ClipNoise rough_noise(const std::vector<FittedFrame>& frames, const KnownNoise& known);

/// Sigma of landmarks on the outline, measured across it, with weights as for other landmarks.
double outline_noise(const std::vector<FittedFrame>& frames, const ClipNoise& noise);

/// Performs one step of expectation maximisation with the landmark weights of the frames. The fit
/// hides the part of the repeated error that the identities follow. `determined` is the number of
/// identities that the landmarks determine rather than the prior.
///
/// [MacKay. Bayesian interpolation. Neural Computation 4(3), 1992]
/// [Liu, Rubin. ML estimation of the t distribution using EM and its extensions, ECM and ECME.
///  Statistica Sinica 5, 1995]
ClipNoise estimated_noise(const std::vector<FittedFrame>& frames, double determined,
                          const KnownNoise& known);

/// Sets sigma and the landmark weights of the frames, including landmarks on the outline.
void set_noise(std::vector<FittedFrame>& frames, const ClipNoise& noise, const KnownNoise& known);

}  // namespace mimetra
