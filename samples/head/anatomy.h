#pragma once

#include <Eigen/Core>

#include "samples/head/head_grid.h"

/// The parts of the head, placed by formulas.
namespace mimetra::samples {

/// A point of the head without its features: an egg with jaw and neck, in millimetres; x to the
/// head's own left, y up, z forward, the origin between the eyes at the depth of the ears. `u` and
/// `v` as in HeadVertex.
Eigen::Vector3d skull_point(double u, double v);

/// Height of the line between the lips, mm.
constexpr double kMouthHeight = -66;
/// Half the distance between the corners of the mouth, mm.
constexpr double kMouthHalfWidth = 25.5;
/// Middle of the head's left eyeball, mm.
inline const Eigen::Vector3d kLeftEye{31, -0.5, 60.5};

/// The face on a bare skull: brows, sockets, nose, cheeks, lips and chin. `p` is a place on the
/// skull, moved up or down by lids and lips already; `lip` its height above the line between the
/// lips; `front` is 1 on the face and falls to 0 towards the ears. Lengths in mm.
Eigen::Vector3d with_features(const Eigen::Vector3d& p, double lip, double front);

/// The head's left ear on a place of the skull with the parameters `u` and `v` of HeadVertex.
Eigen::Vector3d with_ear(const Eigen::Vector3d& p, double u, double v);

/// A vertex of the teeth and gums, in the closed mouth, mm.
Eigen::Vector3d teeth_point(const HeadVertex& vertex);

/// The point of the tongue for one of the unit sphere, its tip for (0, 0, 1).
Eigen::Vector3d tongue_point(const Eigen::Vector3d& ball);

}  // namespace mimetra::samples
