#include "fitting/affine_camera.h"

#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/product_blocking.h"

namespace mimetra {

namespace {

/// Below this share of the first singular value the third says nothing about depth.
constexpr double kCoplanar = 1e-3;
constexpr Eigen::Index kFewest = 4;

}  // namespace

AffineCamera estimate_affine_camera(const ModelPoints& points, const ImagePoints& image) {
  const Eigen::Index count = points.rows();
  if (count < kFewest) {
    throw MismatchError(std::to_string(count) +
                        " landmarks, an affine camera needs at least 4 that are not coplanar");
  }
  fix_product_blocking();
  // Normalised coordinates are centred on both sides. Their scales cancel in the closed form: a
  // linear regression commutes with them, and the eigenvalues' ratios do not depend on them.
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

}  // namespace mimetra
