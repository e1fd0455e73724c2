#pragma once

#include "samples/head/head_grid.h"

namespace mimetra::samples {

/// A vertex of the teeth and gums, in the closed mouth, mm.
Eigen::Vector3d teeth_point(const HeadVertex& vertex);

/// The point of the tongue for one of the unit sphere, its tip for (0, 0, 1).
Eigen::Vector3d tongue_point(const Eigen::Vector3d& ball);

}  // namespace mimetra::samples
