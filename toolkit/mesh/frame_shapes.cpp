#include "toolkit/mesh/frame_shapes.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "toolkit/mesh/median.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

// Determinants of maps between centred poses, each scaled by its spread: of a rotation of a head or
// a mask it is above 0.01; below this one of the two is nearly flat, or they have nothing in
// common.
constexpr double kFlat = 1e-3;

Positions centred(const Eigen::Ref<const Positions>& positions) {
  return positions.rowwise() - positions.colwise().mean();
}

/// Distances of vertices from the middle of their neighbours (N).
Eigen::VectorXd distances_from_neighbors(const PositionsView& pose, const Triangles& triangles) {
  Positions sums = Positions::Zero(pose.rows(), 3);
  Eigen::VectorXd counts = Eigen::VectorXd::Zero(pose.rows());
  for (const auto& corners : triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      sums.row(corners[c]) += pose.row(corners[(c + 1) % 3]) + pose.row(corners[(c + 2) % 3]);
      counts[corners[c]] += 2;
    }
  }
  Eigen::VectorXd distances = Eigen::VectorXd::Zero(pose.rows());
  for (Eigen::Index v = 0; v < pose.rows(); ++v) {
    if (counts[v] > 0) distances[v] = (pose.row(v) - sums.row(v) / counts[v]).norm();
  }
  return distances;
}

/// Of the edges at each vertex (N).
Eigen::VectorXd longest_edges(const Positions& positions, const Triangles& triangles) {
  Eigen::VectorXd longest = Eigen::VectorXd::Zero(positions.rows());
  for (const auto& corners : triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = corners[c], b = corners[(c + 1) % 3];
      const double length = (positions.row(a) - positions.row(b)).norm();
      longest[a] = std::max(longest[a], length);
      longest[b] = std::max(longest[b], length);
    }
  }
  return longest;
}

/// The mesh that frames are poses of.
struct RestShape {
  explicit RestShape(const FrameSource& sequence)
      : centred_rest(centred(sequence.rest())),
        of_spread(spread(sequence.rest())),
        from_neighbors(distances_from_neighbors(
            PositionsView(sequence.rest().data(), sequence.vertices(), 3), sequence.triangles())),
        edges(longest_edges(sequence.rest(), sequence.triangles())) {}

  Positions centred_rest;
  double of_spread;
  Eigen::VectorXd from_neighbors, edges;
};

FrameShape shape_of(const PositionsView& pose, const RestShape& rest, const Triangles& triangles) {
  FrameShape shape;
  const Positions moved = centred(pose);
  const auto count = static_cast<double>(pose.rows());
  shape.spread = spread(pose);
  shape.center = pose.colwise().mean().transpose();
  if (shape.spread > 0 && rest.of_spread > 0) {
    const Eigen::Matrix3d mixed =
        moved.transpose() * rest.centred_rest / (count * shape.spread * rest.of_spread);
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
  if (triangles.rows() > 0) {
    shape.stray = (distances_from_neighbors(pose, triangles) - rest.from_neighbors)
                      .maxCoeff(&shape.stray_vertex);
  }
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
  const RestShape rest(sequence);
  const Frames first_pose = sequence.read(0, 1);
  const PositionsView start(first_pose.data(), sequence.vertices(), 3);
  for_each_block(sequence, options, [&](int first, const Frames& poses) {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const PositionsView pose(poses.row(row).data(), sequence.vertices(), 3);
      FrameShape& shape = shapes[static_cast<std::size_t>(first + row)];
      shape = shape_of(pose, rest, sequence.triangles());
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

/// Whether a vertex that strays in a frame does not in the frames beside it.
bool strays_alone(const FrameSource& sequence, const RestShape& rest, int frame,
                  const FrameShape& shape, double least) {
  for (const int beside : {frame - 1, frame + 1}) {
    if (beside < 0 || beside >= sequence.frames()) continue;
    const FrameBlock block(sequence, beside, 1);
    const Eigen::VectorXd there = distances_from_neighbors(block.frame(0), sequence.triangles());
    const VertexIndex v = shape.stray_vertex;
    if (there[v] - rest.from_neighbors[v] > shape.stray - least) return false;
  }
  return sequence.frames() > 1;
}

/// "frames 7, 9 are WHAT".
std::string told(const std::vector<int>& frames, const std::string& what) {
  const bool several = frames.size() > 1;
  return (several ? "frames " : "frame ") + listed(words_of(frames)) +
         (several ? " are " : " is ") + what;
}

}  // namespace

OddFrames odd_frames(const FrameSource& sequence, const std::vector<FrameShape>& shapes) {
  std::vector<double> spreads;
  spreads.reserve(shapes.size());
  for (const FrameShape& shape : shapes) spreads.push_back(shape.spread);
  OddFrames odd;
  odd.usual_spread = median(std::move(spreads));
  constexpr double kStray = 0.05;
  const RestShape rest(sequence);
  const FrameShape of_rest = shape_of(PositionsView(sequence.rest().data(), sequence.vertices(), 3),
                                      rest, sequence.triangles());
  const double size = sequence.diameter();
  odd.jumping = jumping_frames(shapes, size);
  for (std::size_t f = 0; f < shapes.size(); ++f) {
    const FrameShape& shape = shapes[f];
    const auto frame = static_cast<int>(f);
    if (is_other_size(shape.spread, odd.usual_spread)) odd.of_other_size.push_back(frame);
    if (shape.is_mirrored) odd.mirrored.push_back(frame);
    // A frame in another unit is not torn for that.
    const double unit = rest.of_spread > 0 ? std::max(1.0, shape.spread / rest.of_spread) : 1;
    const double least = unit * kStray * size;
    if (shape.longest_edge > unit * std::max(size / 2, 2 * of_rest.longest_edge)) {
      odd.torn.push_back(frame);
    } else if (shape.stray > least && shape.stray > unit * rest.edges[shape.stray_vertex] &&
               strays_alone(sequence, rest, frame, shape, least)) {
      odd.spiked.push_back(frame);
    }
  }
  return odd;
}

std::vector<std::string> described(const OddFrames& odd, const std::vector<FrameShape>& shapes) {
  const auto of_first = [&shapes](const std::vector<int>& frames) -> const FrameShape& {
    return shapes[static_cast<std::size_t>(frames.front())];
  };
  std::vector<std::string> texts;
  if (!odd.of_other_size.empty()) {
    texts.push_back(told(odd.of_other_size, "of another size than the others: vertices lie ") +
                    readable(of_first(odd.of_other_size).spread) +
                    " from their mean there (RMS), " + readable(odd.usual_spread) + " elsewhere");
  }
  if (!odd.mirrored.empty()) {
    texts.push_back(told(odd.mirrored, "mirrored against the rest pose, or numbered otherwise"));
  }
  if (!odd.torn.empty()) {
    const FrameShape& shape = of_first(odd.torn);
    texts.push_back(told(odd.torn, "torn: vertices ") + std::to_string(shape.ends.first) + " and " +
                    std::to_string(shape.ends.second) + ", which share an edge, lie " +
                    readable(shape.longest_edge) + " apart");
  }
  if (!odd.spiked.empty()) {
    const FrameShape& shape = of_first(odd.spiked);
    texts.push_back(told(odd.spiked, "spiked: vertex ") + std::to_string(shape.stray_vertex) +
                    " alone lies " + readable(shape.stray) +
                    " farther from its neighbours than at rest, not so in the frames beside");
  }
  if (!odd.jumping.empty()) {
    texts.push_back(told(odd.jumping, "far from the frames before and after"));
  }
  return texts;
}

}  // namespace mimetra
