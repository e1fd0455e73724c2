#pragma once

#include <span>

#include <Eigen/Core>

namespace mimetra::samples {

/// Pushes the surface around a place, as a thumb pushes clay. Lengths in mm.
struct Stroke {
  Eigen::Vector3d center;
  Eigen::Vector3d radii;  ///< nothing moves from there on
  Eigen::Vector3d push;   ///< at the middle
};

/// Where all strokes together move `p`. Each weighs by the place before any of them.
Eigen::Vector3d sculpted(const Eigen::Vector3d& p, std::span<const Stroke> strokes);

/// The same with every stroke that has its middle beside the plane x = 0 made on both sides. A
/// mirrored `p` gives exactly the mirrored result.
Eigen::Vector3d sculpted_on_both_sides(const Eigen::Vector3d& p, std::span<const Stroke> strokes);

}  // namespace mimetra::samples
