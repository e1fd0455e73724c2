#pragma once

#include <Eigen/Core>

namespace mimetra::samples {

/// The face on a bare skull: brows, sockets, nose, cheeks, lips and chin. `p` is a place on the
/// skull, moved up or down by lids and lips already; `lip` its height above the line between the
/// lips; `front` is 1 on the face and falls to 0 towards the ears. Lengths in mm.
Eigen::Vector3d with_features(const Eigen::Vector3d& p, double lip, double front);

/// The head's left ear on a place of the skull with the parameters `u` and `v` of HeadVertex.
Eigen::Vector3d with_ear(const Eigen::Vector3d& p, double u, double v);

}  // namespace mimetra::samples
