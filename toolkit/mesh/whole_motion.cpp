#include "toolkit/mesh/whole_motion.h"

#include <cmath>

#include "toolkit/mesh/alignment.h"

namespace mimetra {
namespace {

/// What is measured of a frame: of squared distances from the rest pose, all, and what the motion
/// and the similarity leave, which are added over frames; the others are of each.
enum Number { kAll, kLeftByMotion, kLeftBySimilarity, kAngle, kShift, kScale };
constexpr int kSummed = 3, kNumbers = 6;
using Numbers = Eigen::Matrix<double, 1, kNumbers>;

Numbers numbers_of(const Positions& rest, const Eigen::Ref<const Positions>& pose) {
  const RigidTransform motion = rigid_fit(rest, pose);
  const Positions moved = motion.apply(rest);
  const Eigen::RowVector3d from = moved.colwise().mean(), to = pose.colwise().mean();
  const Positions turned = moved.rowwise() - from, there = pose.rowwise() - to;
  const double size = turned.squaredNorm();
  Numbers numbers;
  numbers[kScale] = size > 0 ? turned.cwiseProduct(there).sum() / size : 1;
  numbers[kAll] = (pose - rest).squaredNorm();
  numbers[kLeftByMotion] = (there - turned).squaredNorm();
  numbers[kLeftBySimilarity] = (there - numbers[kScale] * turned).squaredNorm();
  numbers[kAngle] = motion.angle();
  numbers[kShift] = (to - rest.colwise().mean()).norm();
  return numbers;
}

WholeMotion together(Eigen::Index vertices, const Eigen::Ref<const Eigen::VectorXd>& sums,
                     const Eigen::Ref<const Eigen::MatrixXd>& of_each) {
  constexpr int kFew = 10;
  WholeMotion whole;
  whole.angle = of_each.col(kAngle - kSummed).maxCoeff();
  whole.shift = of_each.col(kShift - kSummed).maxCoeff();
  for (const double scale : of_each.col(kScale - kSummed)) {
    if (std::abs(scale - 1) > std::abs(whole.scale - 1)) whole.scale = scale;
  }
  if (sums[kAll] > 0 && vertices >= kFew) {
    whole.left_by_motion = sums[kLeftByMotion] / sums[kAll];
    whole.left_by_similarity = sums[kLeftBySimilarity] / sums[kAll];
  }
  return whole;
}

}  // namespace

bool WholeMotion::is_scaled() const {
  constexpr double kSeen = 0.05;
  return left_by_similarity < kMostlyMoved * left_by_motion && std::abs(scale - 1) > kSeen;
}

WholeMotion whole_motion(const Positions& rest, const Positions& pose) {
  const Numbers numbers = numbers_of(rest, pose);
  return together(rest.rows(), numbers.head<kSummed>().transpose(),
                  numbers.tail<kNumbers - kSummed>());
}

WholeMotion whole_motion(const FrameSource& source, const BlockOptions& options) {
  const FrameNumbers numbers = over_frames(source, kSummed, kNumbers - kSummed, options,
                                           [&](int, const FrameBlock& block, FrameRows& of_block) {
                                             for (int row = 0; row < block.frames(); ++row) {
                                               of_block.row(row) =
                                                   numbers_of(source.rest(), block.frame(row));
                                             }
                                           });
  return together(source.vertices(), numbers.sum, numbers.of_each);
}

}  // namespace mimetra
