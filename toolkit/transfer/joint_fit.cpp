#include "toolkit/transfer/joint_fit.h"

#include <algorithm>
#include <string>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/regions/regions.h"

namespace mimetra {

namespace {

/// Rotations have settled if they change by less. Each alternation shrinks the change to a tenth,
/// so that the remaining error is about as small.
constexpr double kSettledRotation = 1e-11;

/// Vertices of the triangles, ascending.
std::vector<VertexIndex> vertices_of(const Triangles& triangles, const std::vector<int>& selected) {
  std::vector<VertexIndex> vertices;
  for (const int triangle : selected) {
    for (const VertexIndex vertex : triangles.row(triangle)) vertices.push_back(vertex);
  }
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

void check_vertices(Eigen::Index found, Eigen::Index expected) {
  if (found == expected) return;
  throw MismatchError("a performance of " + std::to_string(found) + " vertices, expected " +
                      std::to_string(expected) + " as in the target");
}

const Positions& checked(const Positions& rest, const BlendshapeModel& target,
                         const JointFitOptions& options) {
  check_options(options);
  const Pairing* pairing = options.pairing.get();
  check_vertices(rest.rows(), pairing ? pairing->source_vertices() : target.vertices());
  fix_product_blocking();
  return rest;
}

Eigen::Vector3d mean_of_rows(const PositionsView& rows, const std::vector<VertexIndex>& numbers) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const VertexIndex number : numbers) sum += rows.row(number).transpose();
  return sum / static_cast<double>(numbers.size());
}

/// Inner product of 3 x 3 matrices.
double product(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return a.cwiseProduct(b).sum();
}

}  // namespace

JointFit::JointFit(const Positions& source_rest, const BlendshapeModel& target,
                   std::vector<int> triangles, const JointFitOptions& options,
                   const Context& context)
    : rest_(checked(source_rest, target, options)),
      gradients_(gradients_between(rest_, target.triangles(), options.pairing.get(),
                                   with_partners(std::move(triangles), options.pairing.get()))),
      gram_(gram_matrix(target, gradients_.selected(), options.edges)),
      moments_(rest_, gradients_, target, options.edges),
      vertices_(vertices_of(target.triangles(), gradients_.selected())),
      options_(options) {
  context.report(0.5);
  const Eigen::VectorXd full =
      gram_diagonal(target, all_triangles(target.triangles()), options.edges);
  upper_ = Eigen::VectorXd::Zero(gram_.rows());
  mean_fields_.resize(3, gram_.cols());
  rest_mean_ = mean_of(PositionsView(rest_.data(), rest_.rows(), 3));
  for (Eigen::Index j = 0; j < gram_.cols(); ++j) {
    if (moves_there(gram_(j, j), full[j])) upper_[j] = 1;
    const double* field = target.expressions().displacements.col(j).data();
    mean_fields_.col(j) = mean_of_rows(PositionsView(field, target.vertices(), 3), vertices_);
  }
  context.report(1);
}

/// Mean place of the triangles' vertices, or of their carriers.
Eigen::Vector3d JointFit::mean_of(const PositionsView& pose) const {
  if (!options_.pairing) return mean_of_rows(pose, vertices_);
  const Positions places = options_.pairing->carried(pose, vertices_);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < places.rows(); ++i) sum += places.row(i).transpose();
  return sum / static_cast<double>(vertices_.size());
}

/// A^T b for R^T Q_i. The second term is exactly 0 without rotation.
Eigen::VectorXd JointFit::right_hand_side(const RotationMoments::Moments& moments,
                                          const Eigen::Matrix3d& rotation) const {
  const Eigen::Matrix3d turn = rotation - Eigen::Matrix3d::Identity();
  Eigen::VectorXd h(upper_.size());
  for (Eigen::Index j = 0; j < h.size(); ++j) {
    const Eigen::Index column = 3 * (j + 1);
    h[j] = product(rotation, moments.middleCols<3>(column)) +
           product(turn, moments_.at_rest().middleCols<3>(column));
  }
  return h;
}

/// Rotation that maps the edges V~_i(beta) to Q_i V_i best.
Eigen::Matrix3d JointFit::rotation_of(const RotationMoments::Moments& moments,
                                      const Eigen::VectorXd& beta) const {
  Eigen::Matrix3d covariance = moments.leftCols<3>() + moments_.at_rest().leftCols<3>();
  for (Eigen::Index j = 0; j < beta.size(); ++j) {
    const Eigen::Index column = 3 * (j + 1);
    covariance +=
        beta[j] * (moments.middleCols<3>(column) + moments_.at_rest().middleCols<3>(column));
  }
  return nearest_rotation(covariance);
}

JointFit::Head JointFit::solve(const RotationMoments::Moments& moments,
                               const Eigen::Matrix3d& start) const {
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(upper_.size());
  Head head{start, lower};
  for (int iteration = 0;; ++iteration) {
    head.beta =
        box_least_squares(gram_, right_hand_side(moments, head.rotation), lower, upper_, head.beta);
    if (iteration == options_.iterations) return head;
    const Eigen::Matrix3d rotation = rotation_of(moments, head.beta);
    if ((rotation - head.rotation).norm() < kSettledRotation) return head;
    head.rotation = rotation;
  }
}

HeadAndExpressions JointFit::operator()(const FrameSource& performance,
                                        const std::vector<RigidTransform>& start,
                                        const Context& context) const {
  check_vertices(performance.vertices(), rest_.rows());
  const int frames = performance.frames();
  if (static_cast<int>(start.size()) != frames) {
    throw MismatchError(std::to_string(start.size()) + " rigid transforms, expected " +
                        std::to_string(frames) + ", one per frame");
  }
  fix_product_blocking();
  HeadAndExpressions found{start, Eigen::MatrixXd::Zero(frames, upper_.size())};
  constexpr int kBlock = RotationMoments::kLanes;
  const auto fit_block = [&](int number) {
    const int first = number * kBlock;
    const FrameBlock block(performance, first, std::min(kBlock, frames - first));
    const std::vector<RotationMoments::Moments> moments = moments_(block.poses());
    for (int row = 0; row < block.frames(); ++row) {
      RigidTransform& motion = found.motion[first + row];
      if (block.frame(row) == rest_) {
        motion = {};
        continue;
      }
      const Head head = solve(moments[row], motion.rotation);
      found.weights.row(first + row) = head.beta.transpose();
      if (options_.iterations == 0) continue;
      const Eigen::Vector3d predicted = rest_mean_ + mean_fields_ * head.beta;
      motion = {head.rotation, mean_of(block.frame(row)) - head.rotation * predicted};
    }
  };
  parallel_for((frames + kBlock - 1) / kBlock, fit_block, context);
  return found;
}

}  // namespace mimetra
