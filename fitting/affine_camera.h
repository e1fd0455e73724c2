#pragma once

#include <vector>

#include <Eigen/Core>

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// The upper two rows of an affine camera's 3 x 4 matrix, whose last row is 0 0 0 1: image point =
/// C (x y z 1)^T, in pixels, y down.
using AffineCamera = Eigen::Matrix<double, 2, 4>;

/// Points of a model, one row each, in the model's unit.
using ModelPoints = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Points of an image, one row each: x, y in pixels, y down, 0 at the middle of the first pixel.
using ImagePoints = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Landmarks that an affine camera needs at least.
inline constexpr int kLandmarksOfCamera = 4;

/// The camera that minimises the squared distances of projected points to `image` points, by the
/// Gold Standard algorithm. Throws MismatchError where there are fewer than four points, or where
/// they are coplanar: the third singular value of the centred points is below 1e-3 of the first.
///
/// [Hartley, Zisserman. Multiple View Geometry in Computer Vision, 2nd ed., 2004], algorithm 14.1
AffineCamera estimate_affine_camera(const ModelPoints& points, const ImagePoints& image);

/// Where the camera sees the points. `depth`: the third row of a perspective camera's matrix.
ImagePoints project(const AffineCamera& camera, const ModelPoints& points,
                    const Eigen::RowVector4d& depth = {0, 0, 0, 1});

/// Root of the mean squared distance of points (n x D) from their centroid.
double rms_radius(const Eigen::MatrixXd& points);

/// The points of a frame of landmarks (F x 2n: x0 y0 x1 ...), one row each.
ImagePoints points_of_frame(const Frames& landmarks, Eigen::Index frame);

/// The landmarks of a frame (F x 2n) that are seen: both of their coordinates are finite.
std::vector<Eigen::Index> seen_landmarks(const Frames& landmarks, Eigen::Index frame);

/// How the head is turned for whoever looks through the camera: carries the model, which looks
/// along +z with y up, to how it stands before a viewer with y up. The identity for a face that is
/// seen upright from the front. It is the rotation nearest to the camera's linear part; what that
/// shears or stretches is left out. \pre the camera sees the model from some side: rank 2
Eigen::Matrix3d head_rotation(const AffineCamera& camera);

/// Each frame (F) turned by its camera's rotation about the middle of the rest pose, which stays;
/// in the model's own axes, looking_ahead(), so that a head that moves little stays near its rest
/// pose. Throws std::invalid_argument for another number of cameras.
MeshSequence turned_as_seen(const MeshSequence& sequence, const std::vector<AffineCamera>& cameras,
                            const LandmarkVertices& landmarks);

}  // namespace mimetra
