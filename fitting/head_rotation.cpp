#include "fitting/head_rotation.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace mimetra {

namespace {

// iBUG's numbers, of a first one and of the one after the last.
constexpr std::pair kRightEye{36, 42}, kLeftEye{42, 48}, kLips{48, 68};

bool is_in(int number, std::pair<int, int> part) {
  return number >= part.first && number < part.second;
}

/// \pre there is a landmark of the part
Eigen::RowVector3d middle_of(const Positions& positions, const LandmarkVertices& landmarks,
                             std::pair<int, int> part) {
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  int count = 0;
  for (const auto& [number, vertex] : landmarks) {
    if (!is_in(number, part)) continue;
    sum += positions.row(vertex);
    ++count;
  }
  return sum / count;
}

}  // namespace

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

bool tell_axes(const LandmarkVertices& landmarks) {
  return std::ranges::all_of(std::array{kRightEye, kLeftEye, kLips}, [&](const auto& part) {
    return std::ranges::any_of(landmarks,
                               [&](const auto& landmark) { return is_in(landmark.first, part); });
  });
}

Eigen::Matrix3d looking_ahead(const Positions& neutral, const LandmarkVertices& landmarks) {
  if (!tell_axes(landmarks)) return Eigen::Matrix3d::Identity();
  const Eigen::RowVector3d right_eye = middle_of(neutral, landmarks, kRightEye);
  const Eigen::RowVector3d left_eye = middle_of(neutral, landmarks, kLeftEye);
  const Eigen::RowVector3d lips = middle_of(neutral, landmarks, kLips);
  // Rows as a viewer has them: right, which is the face's own left, up, and towards him.
  Eigen::Matrix3d face;
  face.row(0) = (left_eye - right_eye).normalized();
  face.row(2) = face.row(0).cross((left_eye + right_eye) / 2 - lips).normalized();
  face.row(1) = face.row(2).cross(face.row(0));
  Eigen::Matrix3d best = Eigen::Matrix3d::Identity();
  for (int x = 0; x < 3; ++x) {
    for (const int y : {(x + 1) % 3, (x + 2) % 3}) {
      for (const int signs : {0, 1, 2, 3}) {
        Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();
        axes(x, 0) = signs & 1 ? -1 : 1;
        axes(y, 1) = signs & 2 ? -1 : 1;
        axes.col(2) = axes.col(0).cross(axes.col(1));
        if ((axes.transpose() * face).trace() > (best.transpose() * face).trace()) best = axes;
      }
    }
  }
  return best;
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
