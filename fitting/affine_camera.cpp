#include "fitting/affine_camera.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "fitting/landmark_mapping.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/rounding.h"

namespace mimetra {

namespace {

/// Below this share of the first singular value, the third one says nothing about depth.
constexpr double kCoplanar = 1e-3;

}  // namespace

AffineCamera estimate_affine_camera(const ModelPoints& points, const ImagePoints& image) {
  const Eigen::Index count = points.rows();
  if (count < kLandmarksOfCamera) {
    throw MismatchError(std::to_string(count) + " landmarks, an affine camera needs at least " +
                        std::to_string(kLandmarksOfCamera) + " that are not coplanar");
  }
  fix_product_blocking();
  // Both sides are centred. Their scales cancel in the closed form: a linear regression commutes
  // with scaling, and ratios of eigenvalues do not depend on it.
  const Eigen::RowVector3d centre = points.colwise().mean();
  const Eigen::RowVector2d image_centre = image.colwise().mean();
  const ModelPoints centred = points.rowwise() - centre;
  const Eigen::Matrix3d scatter = centred.transpose() * centred;
  const Eigen::Matrix<double, 2, 3> cross = (image.rowwise() - image_centre).transpose() * centred;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(scatter);
  const Eigen::Vector3d& values = eigen.eigenvalues();  // ascending; squares of singular values
  if (!(values[0] > kCoplanar * kCoplanar * values[2])) {
    throw MismatchError("the " + std::to_string(count) +
                        " landmarks are coplanar on the model, so that no affine camera can be "
                        "told from them; map some that differ in depth, such as the nose's");
  }
  const Eigen::Matrix3d& axes = eigen.eigenvectors();
  AffineCamera camera;
  camera.leftCols<3>() = cross * axes * values.cwiseInverse().asDiagonal() * axes.transpose();
  camera.col(3) = image_centre.transpose() - camera.leftCols<3>() * centre.transpose();
  return camera;
}

ImagePoints project(const AffineCamera& camera, const ModelPoints& points,
                    const Eigen::RowVector4d& depth) {
  ImagePoints image =
      (points * camera.leftCols<3>().transpose()).rowwise() + camera.col(3).transpose();
  if (!depth.head<3>().isZero(0)) {
    image.array().colwise() /= (points * depth.head<3>().transpose()).array() + depth[3];
  }
  return image;
}

double rms_radius(const Eigen::MatrixXd& points) {
  const auto centred = points.rowwise() - points.colwise().mean();
  return std::sqrt(centred.squaredNorm() / double(points.rows()));
}

ImagePoints points_of_frame(const Frames& landmarks, Eigen::Index frame) {
  const Eigen::RowVectorXd row = landmarks.row(frame);
  return row.reshaped<Eigen::RowMajor>(row.size() / 2, 2);
}

std::vector<Eigen::Index> seen_landmarks(const Frames& landmarks, Eigen::Index frame) {
  std::vector<Eigen::Index> seen;
  for (Eigen::Index i = 0; i < landmarks.cols() / 2; ++i) {
    if (landmarks.row(frame).segment<2>(2 * i).allFinite()) seen.push_back(i);
  }
  return seen;
}

Eigen::Matrix3d head_rotation(const AffineCamera& camera) {
  const Eigen::Matrix<double, 2, 3> linear = camera.leftCols<3>();
  const Eigen::JacobiSVD<Eigen::Matrix<double, 2, 3>> svd(
      linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d seen;
  seen.topRows<2>() = svd.matrixU() * svd.matrixV().leftCols<2>().transpose();
  seen.row(2) = seen.row(0).cross(seen.row(1));
  // y points down in images, so z points away from the viewer.
  return Eigen::Vector3d(1, -1, -1).asDiagonal() * seen;
}

MeshSequence turned_as_seen(const MeshSequence& sequence, const std::vector<AffineCamera>& cameras,
                            const LandmarkVertices& landmarks) {
  if (static_cast<int>(cameras.size()) != sequence.frames()) {
    throw std::invalid_argument(std::to_string(cameras.size()) + " cameras for " +
                                std::to_string(sequence.frames()) + " frames");
  }
  const Eigen::RowVector3d middle = sequence.rest().colwise().mean();
  Frames frames = sequence.positions();
  const Eigen::Matrix3d to_own_axes = looking_ahead(sequence.rest(), landmarks).transpose();
  for (int f = 0; f < sequence.frames(); ++f) {
    Eigen::Map<Positions> frame(frames.row(f).data(), sequence.vertices(), 3);
    const Eigen::Matrix3d rotation =
        to_own_axes * head_rotation(cameras[static_cast<std::size_t>(f)]);
    const Positions turned = (frame.rowwise() - middle) * rotation.transpose();
    frame = turned.rowwise() + middle;
  }
  return sequence.with_frames(std::move(frames));
}

}  // namespace mimetra
