#pragma once

#include <Eigen/Core>

namespace mimetra {

/// The upper two rows of an affine camera's 3 x 4 matrix, whose last row is 0 0 0 1: image point =
/// C (x y z 1)^T, in pixels, y down.
using AffineCamera = Eigen::Matrix<double, 2, 4>;

/// Points of a model, one row each, in the model's unit.
using ModelPoints = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// Points of an image, one row each: x, y in pixels, y down, 0 at the middle of the first pixel.
using ImagePoints = Eigen::Matrix<double, Eigen::Dynamic, 2>;

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

}  // namespace mimetra
