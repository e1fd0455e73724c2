#include "toolkit/transfer/linear_transfer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/model/smooth_weights.h"
#include "toolkit/model/smoothness.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {
namespace {

/// Frames per block. A frame's solve starts from the weights of the previous frame within its
/// block.
constexpr int kWeightsPerBlock = 16;

/// Pull of one of the source's expressions on the target's vertices (3N). It is dQ_i V_i times the
/// edges' weights, gathered at the corners.
Eigen::VectorXd pull_of(const Eigen::Ref<const Eigen::VectorXd>& field,
                        const BlendshapeModel& source, const BlendshapeModel& target,
                        const DeformationGradients& gradients, const Eigen::Matrix2d& product) {
  const PositionsView moved(field.data(), source.vertices(), 3);
  Positions pull = Positions::Zero(target.vertices(), 3);
  const std::vector<int>& selected = gradients.selected();
  for (std::size_t s = 0; s < selected.size(); ++s) {
    Eigen::Matrix3d change = Eigen::Matrix3d::Zero();
    for (const auto& [triangle, share] : gradients.parts(static_cast<int>(s))) {
      change += share *
                triangle_frame_change(edges_of(source.neutral(), gradients.triangles(), triangle),
                                      edges_of(moved, gradients.triangles(), triangle)) *
                gradients.inverse_frame(triangle);
    }
    const Edges asked =
        change * edges_of(target.neutral(), target.triangles(), selected[s]) * product;
    const auto corners = target.triangles().row(selected[s]);
    pull.row(corners[0]) -= asked.rowwise().sum().transpose();
    pull.row(corners[1]) += asked.col(0).transpose();
    pull.row(corners[2]) += asked.col(1).transpose();
  }
  return Eigen::Map<const Eigen::VectorXd>(pull.data(), pull.size());
}

void check_models(const BlendshapeModel& source, const BlendshapeModel& target,
                  const BlendshapeTransferOptions& options) {
  check_options(options);
  check_sizes(source.neutral(), target.neutral(), options.pairing.get());
  if (source.expressions().size() == 0) throw MismatchError("the source has no expressions");
  if (target.expressions().size() == 0) throw MismatchError("the target has no expressions");
}

}  // namespace

Eigen::Matrix3d triangle_frame_change(const Edges& edges, const Edges& change) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  result.leftCols<2>() = change;
  const Eigen::Vector3d first = edges.col(0), second = edges.col(1);
  const Eigen::Vector3d normal = first.cross(second);
  const double length = normal.norm();
  if (!(length > 0)) return result;
  const Eigen::Vector3d moved =
      Eigen::Vector3d(change.col(0)).cross(second) + first.cross(Eigen::Vector3d(change.col(1)));
  // d(n / |n|^(1/2)) = (dn - n (n . dn) / (2 |n|^2)) / |n|^(1/2)
  result.col(2) =
      (moved - normal * (normal.dot(moved) / (2 * length * length))) / std::sqrt(length);
  return result;
}

Retargeting linear_transfer(const BlendshapeModel& source, const BlendshapeModel& target,
                            std::vector<int> triangles, const BlendshapeTransferOptions& options,
                            const Context& context) {
  check_models(source, target, options);
  fix_product_blocking();
  const DeformationGradients gradients =
      gradients_between(source.neutral(), target.triangles(), options.pairing.get(),
                        with_partners(std::move(triangles), options.pairing.get()));
  const Eigen::MatrixXd& fields = source.expressions().displacements;
  const Eigen::Matrix2d product = edge_product(options.edges);
  Eigen::MatrixXd pulls(3 * static_cast<Eigen::Index>(target.vertices()), fields.cols());
  const auto pull = [&](int j) {
    pulls.col(j) = pull_of(fields.col(j), source, target, gradients, product);
  };
  parallel_for(static_cast<int>(fields.cols()), pull, context.part(0, 0.8));
  Retargeting map;
  map.source_names = source.expressions().names;
  map.target_names = target.expressions().names;
  map.linear = target.expressions().displacements.transpose() * pulls;
  map.gram = gram_matrix(target, gradients.selected(), options.edges);
  map.lower = map.upper = Eigen::VectorXd::Zero(map.gram.rows());
  const Eigen::VectorXd all =
      gram_diagonal(target, all_triangles(target.triangles()), options.edges);
  for (Eigen::Index j = 0; j < map.upper.size(); ++j) {
    if (moves_there(map.gram(j, j), all[j])) map.upper[j] = 1;
  }
  context.report(1);
  return map;
}

void check_map(const Retargeting& map, const BlendshapeTransferOptions& options) {
  map.check();
  check_options(options);
  if (options.sparsity == 0) return;
  for (Eigen::Index j = 0; j < map.lower.size(); ++j) {
    if (map.lower[j] >= 0) continue;
    throw MismatchError("'" + map.target_names[static_cast<std::size_t>(j)] +
                        "' may be negative, for which an L1 term is not defined");
  }
}

Eigen::MatrixXd retargeted(const Retargeting& map, const Eigen::MatrixXd& weights,
                           const Eigen::VectorXd& times, const BlendshapeTransferOptions& options,
                           const Context& context) {
  check_map(map, options);
  if (weights.cols() != map.linear.cols()) {
    throw std::invalid_argument(std::to_string(weights.cols()) +
                                " weights a frame for a source of " +
                                std::to_string(map.linear.cols()) + " expressions");
  }
  fix_product_blocking();
  const auto frames = static_cast<int>(weights.rows());
  const std::vector<Eigen::Index> free = map.free();
  Eigen::MatrixXd beta = map.lower.transpose().replicate(frames, 1);
  if (free.empty() || frames == 0) return beta;
  const double mean_diagonal = map.gram.diagonal()(free).mean();
  Eigen::MatrixXd system = map.gram;
  system.diagonal().array() += options.ridge * mean_diagonal;
  const Eigen::MatrixXd h =
      (weights * map.linear.transpose()).array() - options.sparsity * mean_diagonal;
  const int blocks = (frames + kWeightsPerBlock - 1) / kWeightsPerBlock;
  const auto solve_block = [&](int number) {
    const int first = number * kWeightsPerBlock;
    Eigen::VectorXd current = map.lower;
    for (int f = first; f < std::min(first + kWeightsPerBlock, frames); ++f) {
      current = box_least_squares(system, h.row(f).transpose(), map.lower, map.upper, current);
      beta.row(f) = current.transpose();
    }
  };
  parallel_for(blocks, solve_block, context);
  if (options.smoothness > 0) {
    const double mu = smoothness_penalty(options.smoothness, times, mean_diagonal);
    beta = smooth_weights(
        {std::move(system)}, h, times, mu, beta,
        {map.lower.transpose().replicate(frames, 1), map.upper.transpose().replicate(frames, 1)});
  }
  return beta;
}

}  // namespace mimetra
