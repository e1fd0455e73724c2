#pragma once

#include <vector>

#include <Eigen/Core>

#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Upper two rows of an affine camera's 3 x 4 matrix, whose last row is 0 0 0 1. It maps points to
/// pixels, y down: image point = C (x y z 1)^T.
using AffineCamera = Eigen::Matrix<double, 2, 4>;

/// Points of a model, one a row, in the unit of the model.
using ModelPoints = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Points of an image, one a row: x, y in pixels, y down, 0 at the middle of the first pixel.
using ImagePoints = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Number of landmarks that an affine camera needs at least.
inline constexpr int kLandmarksOfCamera = 4;

/// Camera that minimises the squared distances between projected points and `image` points, found
/// by the Gold Standard algorithm. Throws MismatchError if there are fewer than four points or if
/// they are coplanar. Coplanar means that the third singular value of the centred points is at most
/// 1e-3 of the first.
///
/// [Hartley, Zisserman. Multiple View Geometry in Computer Vision, 2nd ed., 2004], algorithm 14.1
AffineCamera estimate_affine_camera(const ModelPoints& points, const ImagePoints& image);

/// Projects the points into the image. `depth` is the third row of a perspective camera's matrix.
ImagePoints project(const AffineCamera& camera, const ModelPoints& points,
                    const Eigen::RowVector4d& depth = {0, 0, 0, 1});

/// Root of the mean squared distance between points (n x D) and their centroid.
double rms_radius(const Eigen::MatrixXd& points);

/// Points of one frame, one a row. `landmarks` is F x 2n: x0 y0 x1 ...
ImagePoints points_of_frame(const Frames& landmarks, Eigen::Index frame);

/// Landmarks (F x 2n) that are seen in a frame: both of their coordinates are finite.
std::vector<Eigen::Index> seen_landmarks(const Frames& landmarks, Eigen::Index frame);

/// Rotation of the head as seen through the camera: identity for an upright face seen from the
/// front. It maps model axes (looking along +z, y up) to the axes of a viewer with y up. It is the
/// rotation nearest to the camera's linear part; shear and stretch are dropped. \pre The camera's
/// linear part has rank 2.
Eigen::Matrix3d head_rotation(const AffineCamera& camera);

/// Turns each frame (F) by its camera's rotation about the middle of the rest pose, which stays.
/// The rotation acts in the model's own axes (looking_ahead()), so a head that moves little stays
/// near its rest pose. Throws std::invalid_argument if the number of cameras is not F.
MeshSequence turned_as_seen(const MeshSequence& sequence, const std::vector<AffineCamera>& cameras,
                            const LandmarkVertices& landmarks);

}  // namespace mimetra
