#include "fitting/head_rotation.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace mimetra {

Eigen::Matrix3d head_rotation(const AffineCamera& camera) {
  const Eigen::Matrix<double, 2, 3> linear = camera.leftCols<3>();
  const Eigen::JacobiSVD<Eigen::Matrix<double, 2, 3>> svd(
      linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d seen;
  seen.topRows<2>() = svd.matrixU() * svd.matrixV().leftCols<2>().transpose();
  seen.row(2) = seen.row(0).cross(seen.row(1));
  // Images have y down, and so z away from the viewer.
  return Eigen::Vector3d(1, -1, -1).asDiagonal() * seen;
}

Eigen::Matrix3d looking_ahead(const std::vector<Eigen::Matrix3d>& rotations) {
  constexpr double kOwnAxes = 60;  // degrees; heads that are seen from aside are turned by less
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Eigen::Matrix3d& rotation : rotations) sum += rotation;
  // The mean rotation; of a rotation A the trace of A^T M is 1 + 2 cos of the angle between them.
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Eigen::Matrix3d mean =
      svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  // 1 where all are the same; heads at 45 degrees to both sides have 0.8.
  constexpr double kAlike = 0.75;
  const double alike =
      (mean.transpose() * sum).trace() / (3 * static_cast<double>(rotations.size()));
  if (alike < kAlike || mean.trace() >= 1 + 2 * std::cos(kOwnAxes * EIGEN_PI / 180)) return best;
  for (int x = 0; x < 3; ++x) {
    for (const int y : {(x + 1) % 3, (x + 2) % 3}) {
      for (const int signs : {0, 1, 2, 3}) {
        Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
        axes(x, 0) = signs & 1 ? -1 : 1;
        axes(y, 1) = signs & 2 ? -1 : 1;
        axes.col(2) = axes.col(0).cross(axes.col(1));
        if ((axes.transpose() * mean).trace() > (best.transpose() * mean).trace()) best = axes;
      }
    }
  }
  return best;
}

MeshSequence turned_as_seen(const MeshSequence& sequence,
                            const std::vector<AffineCamera>& cameras) {
  if (static_cast<int>(cameras.size()) != sequence.frames()) {
    throw std::invalid_argument(std::to_string(cameras.size()) + " cameras for " +
                                std::to_string(sequence.frames()) + " frames");
  }
  const Eigen::RowVector3d middle = sequence.rest().colwise().mean();
  Frames frames = sequence.positions();
  std::vector<Eigen::Matrix3d> rotations;
  rotations.reserve(cameras.size());
  for (const AffineCamera& camera : cameras) rotations.push_back(head_rotation(camera));
  const Eigen::Matrix3d to_own_axes = looking_ahead(rotations).transpose();
  for (int f = 0; f < sequence.frames(); ++f) {
    Eigen::Map<Positions> frame(frames.row(f).data(), sequence.vertices(), 3);
    const Eigen::Matrix3d rotation = to_own_axes * rotations[static_cast<std::size_t>(f)];
    const Positions turned = (frame.rowwise() - middle) * rotation.transpose();
    frame = turned.rowwise() + middle;
  }
  return sequence.with_frames(std::move(frames));
}

}  // namespace mimetra
