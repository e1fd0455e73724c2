#pragma once

#include <vector>

#include <Eigen/Core>

#include "fitting/affine_camera.h"
#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// How the head is turned for whoever looks through the camera: carries the model, which looks
/// along +z with y up, to how it stands before a viewer with y up. The identity for a face that is
/// seen upright from the front. It is the rotation nearest to the camera's linear part; what that
/// shears or stretches is left out. \pre the camera sees the model from some side: rank 2
Eigen::Matrix3d head_rotation(const AffineCamera& camera);

/// What carries a model to one that looks along +z with y up, by where iBUG's landmarks (0 to 67)
/// are on it: of the rotations that exchange axes the nearest to how its eyes and mouth lie. The
/// identity where it has no landmark of an eye or of the mouth.
Eigen::Matrix3d looking_ahead(const Positions& neutral, const LandmarkVertices& landmarks);

/// True for landmarks of both eyes and the mouth.
bool tell_axes(const LandmarkVertices& landmarks);

/// Each frame (F) turned by its camera's rotation about the middle of the rest pose, which stays;
/// in the model's own axes, looking_ahead(), so that a head that moves little stays near its rest
/// pose. Throws std::invalid_argument for another number of cameras.
MeshSequence turned_as_seen(const MeshSequence& sequence, const std::vector<AffineCamera>& cameras,
                            const LandmarkVertices& landmarks);

}  // namespace mimetra
