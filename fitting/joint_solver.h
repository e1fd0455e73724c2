#pragma once

#include "fitting/clip_noise.h"
#include "fitting/face_outline.h"
#include "fitting/fitted_frame.h"
#include "toolkit/mesh/context.h"

/// The solver of all unknowns together. Internal to landmark_fitter.h.
namespace mimetra {

/// Gauss-Newton on cameras, the one alpha of the frames, and beta within its box; between steps the
/// noise is estimated, unless it is known, and landmarks on the
/// outline are matched to it anew. `options.ridge` is set. The energies are those of the
/// last noise.
FittedClip fit_jointly(std::vector<FittedFrame> frames, const FitOptions& options,
                       const ClipOutline& outline = {}, const Context& context = {});

/// Adds options.smoothness to frames that were fitted jointly, at `times`: beta and cameras change,
/// the one alpha and the noise stay.
FittedClip smoothed(std::vector<FittedFrame> frames, const FitOptions& options,
                    const Eigen::VectorXd& times, const Context& context = {});

}  // namespace mimetra
