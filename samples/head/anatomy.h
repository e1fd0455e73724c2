#pragma once

#include <Eigen/Core>

#include "samples/head/head_grid.h"

/// Formulas for the parts of the head.
namespace mimetra::samples {

/// Point of the head without its features, in millimetres: an egg with jaw and neck. Axis x points
/// to the head's own left, y up and z forward. The origin is between the eyes at the depth of the
/// ears. `u` and `v` are as in HeadVertex.
Eigen::Vector3d skull_point(double u, double v);

/// Height of the line between the lips, mm.
constexpr double kMouthHeight = -66;
/// Half the distance between the corners of the mouth, mm.
constexpr double kMouthHalfWidth = 25.5;
/// Centre of the head's left eyeball, mm.
inline const Eigen::Vector3d kLeftEye{31, -0.5, 60.5};

/// Adds the features to a place `p` on the bare skull: brows, sockets, nose, cheeks, lips and chin.
/// Lids and lips have already moved `p` up or down. `lip` is its height above the line between the
/// lips. `front` is 1 on the face and falls to 0 towards the ears. Lengths are in mm.
Eigen::Vector3d with_features(const Eigen::Vector3d& p, double lip, double front);

/// Adds the head's left ear to a place `p` of the skull; `u` and `v` are as in HeadVertex.
Eigen::Vector3d with_ear(const Eigen::Vector3d& p, double u, double v);

/// Position of a vertex of the teeth and gums in the closed mouth, mm.
Eigen::Vector3d teeth_point(const HeadVertex& vertex);

/// Point of the tongue (mm) for a point of the unit sphere; (0, 0, 1) is the tip.
Eigen::Vector3d tongue_point(const Eigen::Vector3d& ball);

}  // namespace mimetra::samples
