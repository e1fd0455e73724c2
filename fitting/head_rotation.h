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

/// What carries a model of other axes to one that looks along +z with y up, judged by how it is
/// seen: of the rotations that exchange axes the one nearest to the mean of head_rotation()s, but
/// none unless that is more than 60 degrees from none. \pre some rotations
Eigen::Matrix3d looking_ahead(const std::vector<Eigen::Matrix3d>& rotations);

/// Each frame (F) turned by its camera's rotation about the middle of the rest pose, which stays;
/// in the model's own axes, looking_ahead(), so that a head that moves little stays near its rest
/// pose. Throws std::invalid_argument for another number of cameras.
MeshSequence turned_as_seen(const MeshSequence& sequence, const std::vector<AffineCamera>& cameras);

}  // namespace mimetra
