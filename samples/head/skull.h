#pragma once

#include <Eigen/Core>

namespace mimetra::samples {

/// Last row of the skull's surface, where the neck ends.
constexpr double kNeckRow = 12;

/// A point of the head without its features: an egg with jaw and neck, in millimetres; x to the
/// head's own left, y up, z forward, the origin between the eyes at the depth of the ears. `u` and
/// `v` as in HeadVertex.
Eigen::Vector3d skull_point(double u, double v);

}  // namespace mimetra::samples
