#pragma once

#include <vector>

#include <Eigen/Core>

#include "fitting/affine_camera.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// How the head is turned for whoever looks through the camera: carries the model, which looks
/// along +z with y up, to how it stands before a viewer with y up. The identity for a face that is
/// seen upright from the front. It is the rotation nearest to the camera's linear part; what that
/// shears or stretches is left out. \pre the camera sees the model from some side: rank 2
Eigen::Matrix3d head_rotation(const AffineCamera& camera);

/// Each frame (F) turned by its camera's rotation about the middle of the rest pose, which stays.
/// Throws std::invalid_argument for another number of cameras.
MeshSequence turned_as_seen(const MeshSequence& sequence, const std::vector<AffineCamera>& cameras);

}  // namespace mimetra
