#include "toolkit/mesh/whole_motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/measures.h"

namespace mimetra {
namespace {

/// Numbers measured for a frame. The first kSummed are sums of squared distances and are added over
/// the frames. They are the distances from the rest pose, from its moved and from its scaled copy.
/// Two more are the distances of the stillest vertices in the frame and in the moved copy.
enum Number {
  kAll,
  kLeftByMotion,
  kLeftBySimilarity,
  kOfStillest,
  kOfStillestByMotion,
  kAngle,
  kShift,
  kScale
};
constexpr int kSummed = 5, kNumbers = 8;
using Numbers = Eigen::Matrix<double, 1, kNumbers>;

/// A twentieth of `count`, plus one.
Eigen::Index count_of_least(Eigen::Index count) {
  return std::min(count, count / 20 + 1);
}

/// Indices of the count_of_least() least values, ascending; ties go to the lower index.
std::vector<Eigen::Index> least_of(const Eigen::VectorXd& values) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const Eigen::Index count = count_of_least(values.size());
  std::ranges::nth_element(order, order.begin() + count, {},
                           [&values](Eigen::Index v) { return std::pair(values[v], v); });
  order.resize(static_cast<std::size_t>(count));
  std::ranges::sort(order);
  return order;
}

Numbers numbers_of(const Positions& rest, const Eigen::Ref<const Positions>& pose) {
  const RigidTransform motion = rigid_fit(rest, pose);
  const Positions moved = motion.apply(rest);
  const Eigen::RowVector3d from = moved.colwise().mean(), to = pose.colwise().mean();
  const Positions turned = moved.rowwise() - from, there = pose.rowwise() - to;
  const double size = turned.squaredNorm();
  Numbers numbers = Numbers::Zero();
  numbers[kScale] = size > 0 ? turned.cwiseProduct(there).sum() / size : 1;
  numbers[kAll] = (pose - rest).squaredNorm();
  numbers[kLeftByMotion] = (there - turned).squaredNorm();
  numbers[kLeftBySimilarity] = (there - numbers[kScale] * turned).squaredNorm();
  const Eigen::VectorXd distances = (pose - rest).rowwise().squaredNorm();
  const std::vector<Eigen::Index> stillest = least_of(distances);
  for (const Eigen::Index v : stillest) {
    numbers[kOfStillest] += distances[v];
    numbers[kOfStillestByMotion] += (moved.row(v) - rest.row(v)).squaredNorm();
  }
  numbers[kAngle] = motion.angle();
  numbers[kShift] = (to - rest.colwise().mean()).norm();
  return numbers;
}

WholeMotion together(const Positions& rest, const Eigen::Ref<const Eigen::VectorXd>& sums,
                     const Eigen::Ref<const Eigen::MatrixXd>& of_each) {
  constexpr int kFew = 10;
  // Share of the size (RMS) that single precision alone does not reach.
  constexpr double kRounding = 1e-6;
  WholeMotion whole;
  whole.angle = of_each.col(kAngle - kSummed).maxCoeff();
  whole.shift = of_each.col(kShift - kSummed).maxCoeff();
  for (const double scale : of_each.col(kScale - kSummed)) {
    if (std::abs(scale - 1) > std::abs(whole.scale - 1)) whole.scale = scale;
  }
  const double size2 = (rest.rowwise() - rest.colwise().mean()).squaredNorm();
  const auto frames = static_cast<double>(of_each.rows());
  if (sums[kAll] > frames * kRounding * kRounding * size2 && rest.rows() >= kFew) {
    whole.left_by_motion = sums[kLeftByMotion] / sums[kAll];
    whole.left_by_similarity = sums[kLeftBySimilarity] / sums[kAll];
    // Vertices that move by less than this share of the mean may be on an axis of the motion.
    constexpr double kOnAxis = 0.01;
    const auto stillest = static_cast<double>(count_of_least(rest.rows()));
    const double least =
        kOnAxis * kOnAxis * stillest / static_cast<double>(rest.rows()) * sums[kAll];
    whole.of_stillest =
        std::sqrt((sums[kOfStillest] + least) / (sums[kOfStillestByMotion] + least));
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
  return together(rest, numbers.head<kSummed>().transpose(), numbers.tail<kNumbers - kSummed>());
}

WholeMotion whole_motion(const FrameSource& source, const Context& context) {
  const std::vector<VertexIndex> surface = surface_vertices(source.rest(), source.triangles());
  const Positions rest = source.rest()(surface, Eigen::all);
  const FrameNumbers numbers = over_frames(
      source, kSummed, kNumbers - kSummed,
      [&](int, const FrameBlock& block, FrameRows& of_block) {
        for (int row = 0; row < block.frames(); ++row) {
          const Positions pose = block.frame(row)(surface, Eigen::all);
          of_block.row(row) = numbers_of(rest, pose);
        }
      },
      context);
  return together(rest, numbers.sum, numbers.of_each);
}

}  // namespace mimetra
