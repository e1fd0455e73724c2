#include "toolkit/mesh/frame_shapes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "toolkit/mesh/median.h"

namespace mimetra {
namespace {

// Determinants of maps between centred poses, each scaled by its spread: of a rotation of a head or
// a mask it is above 0.01; below this one of the two is nearly flat, or they have nothing in
// common.
constexpr double kFlat = 1e-3;

Positions centred(const Eigen::Ref<const Positions>& positions) {
  return positions.rowwise() - positions.colwise().mean();
}

FrameShape shape_of(const PositionsView& pose, const Positions& rest, double rest_spread,
                    const Triangles& triangles) {
  FrameShape shape;
  const Positions moved = centred(pose);
  const auto count = static_cast<double>(pose.rows());
  shape.spread = spread(pose);
  shape.center = pose.colwise().mean().transpose();
  if (shape.spread > 0 && rest_spread > 0) {
    const Eigen::Matrix3d mixed = moved.transpose() * rest / (count * shape.spread * rest_spread);
    shape.is_mirrored = mixed.determinant() < -kFlat;
  }
  double longest2 = 0;
  for (const auto& corners : triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = corners[c], b = corners[(c + 1) % 3];
      const double length2 = (pose.row(a) - pose.row(b)).squaredNorm();
      if (length2 <= longest2) continue;
      longest2 = length2;
      shape.ends = {a, b};
    }
  }
  shape.longest_edge = std::sqrt(longest2);
  return shape;
}

}  // namespace

double spread(const Eigen::Ref<const Positions>& positions) {
  if (positions.rows() == 0) return 0;
  return std::sqrt(centred(positions).squaredNorm() / static_cast<double>(positions.rows()));
}

bool is_other_size(double spread, double usual) {
  return spread > kOtherSize * usual || usual > kOtherSize * spread;
}

std::vector<FrameShape> frame_shapes(const FrameSource& sequence, const BlockOptions& options) {
  std::vector<FrameShape> shapes(static_cast<std::size_t>(sequence.frames()));
  const Positions rest = centred(sequence.rest());
  const double rest_spread = spread(sequence.rest());
  const Frames first_pose = sequence.read(0, 1);
  const PositionsView start(first_pose.data(), sequence.vertices(), 3);
  for_each_block(sequence, options, [&](int first, const Frames& poses) {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const PositionsView pose(poses.row(row).data(), sequence.vertices(), 3);
      FrameShape& shape = shapes[static_cast<std::size_t>(first + row)];
      shape = shape_of(pose, rest, rest_spread, sequence.triangles());
      shape.from_first = std::sqrt((pose - start).rowwise().squaredNorm().maxCoeff());
    }
  });
  return shapes;
}

namespace {

/// Frames that jump away and back, in a mesh of this size.
std::vector<int> jumping_frames(const std::vector<FrameShape>& shapes, double size) {
  constexpr double kFar = 0.2, kNear = 0.1;
  std::vector<int> jumping;
  for (std::size_t f = 1; f + 1 < shapes.size(); ++f) {
    const Eigen::Vector3d &before = shapes[f - 1].center, &after = shapes[f + 1].center;
    const bool stays = (after - before).norm() < kNear * size;
    if (stays && (shapes[f].center - (before + after) / 2).norm() > kFar * size) {
      jumping.push_back(static_cast<int>(f));
    }
  }
  return jumping;
}

}  // namespace

OddFrames odd_frames(const FrameSource& sequence, const std::vector<FrameShape>& shapes) {
  std::vector<double> spreads;
  spreads.reserve(shapes.size());
  for (const FrameShape& shape : shapes) spreads.push_back(shape.spread);
  OddFrames odd;
  odd.usual_spread = median(std::move(spreads));
  const Positions rest = centred(sequence.rest());
  const double rest_spread = spread(sequence.rest());
  const FrameShape of_rest = shape_of(PositionsView(sequence.rest().data(), rest.rows(), 3), rest,
                                      rest_spread, sequence.triangles());
  const double size = sequence.diameter();
  odd.jumping = jumping_frames(shapes, size);
  for (std::size_t f = 0; f < shapes.size(); ++f) {
    const FrameShape& shape = shapes[f];
    const auto frame = static_cast<int>(f);
    if (is_other_size(shape.spread, odd.usual_spread)) odd.of_other_size.push_back(frame);
    if (shape.is_mirrored) odd.mirrored.push_back(frame);
    // A frame in another unit is not torn for that.
    const double unit = rest_spread > 0 ? std::max(1.0, shape.spread / rest_spread) : 1;
    if (shape.longest_edge > unit * std::max(size / 2, 2 * of_rest.longest_edge)) {
      odd.torn.push_back(frame);
    }
  }
  return odd;
}

}  // namespace mimetra
