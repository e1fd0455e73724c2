#include "fitting/head_rotation.h"

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

MeshSequence turned_as_seen(const MeshSequence& sequence,
                            const std::vector<AffineCamera>& cameras) {
  if (static_cast<int>(cameras.size()) != sequence.frames()) {
    throw std::invalid_argument(std::to_string(cameras.size()) + " cameras for " +
                                std::to_string(sequence.frames()) + " frames");
  }
  const Eigen::RowVector3d middle = sequence.rest().colwise().mean();
  Frames frames = sequence.positions();
  for (int f = 0; f < sequence.frames(); ++f) {
    Eigen::Map<Positions> frame(frames.row(f).data(), sequence.vertices(), 3);
    const Eigen::Matrix3d rotation = head_rotation(cameras[static_cast<std::size_t>(f)]);
    const Positions turned = (frame.rowwise() - middle) * rotation.transpose();
    frame = turned.rowwise() + middle;
  }
  return sequence.with_frames(std::move(frames));
}

}  // namespace mimetra
