#include "toolkit/transfer/blendshape_transfer.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include <Eigen/Eigenvalues>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/model/ruled_least_squares.h"
#include "toolkit/model/smooth_weights.h"
#include "toolkit/model/smoothness.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/vertex_pull.h"

namespace mimetra {

namespace {

/// Frames per block. A frame's solve starts from the weights of the previous frame, but only within
/// its block, so that blocks are independent.
constexpr int kFramesPerBlock = RightHandSide::kLanes;

/// Below this share of a column's energy, the regions say little about it.
constexpr double kWeaklySeenShare = 0.05;

/// Thresholds for a rest pose that is not neutral. A weight at 0 wants to be negative if it would
/// move below kWantedStep on its own. The share of such weights, over frames and expressions, must
/// exceed kUnneutralShare. Measured on a real capture transferred to other identities: 0 with the
/// neutral as rest pose (1e-4 with noise of 0.1 % of the face). With another frame or the mean pose
/// as rest pose, 19 to 38 %.
constexpr double kWantedStep = -0.02;
constexpr double kUnneutralShare = 0.05;

int degenerate_triangles(const BlendshapeModel& target, const std::vector<int>& selected) {
  return static_cast<int>(std::ranges::count_if(selected, [&target](int triangle) {
    return quality_of(target.neutral(), target.triangles(), triangle) < kDegenerateQuality;
  }));
}

void check(const Positions& source_rest, const BlendshapeModel& target,
           const BlendshapeTransferOptions& options) {
  check_sizes(source_rest, target.neutral(), options.pairing.get());
  check_options(options);
  const Eigen::VectorXd& weights = options.triangle_weights;
  if (weights.size() == 0) return;
  if (weights.size() != target.triangles().rows() || !weights.allFinite() ||
      weights.minCoeff() < 0) {
    throw std::invalid_argument("triangle_weights: expected one that is not negative for each of " +
                                std::to_string(target.triangles().rows()) + " triangles, found " +
                                std::to_string(weights.size()));
  }
}

}  // namespace

struct BlendshapeTransfer::State {
  State(const Positions& source_rest, const BlendshapeModel& target, std::vector<int> selected,
        const BlendshapeTransferOptions& given)
      : gradients(gradients_between(source_rest, target.triangles(), given.pairing.get(),
                                    with_partners(std::move(selected), given.pairing.get()))),
        gram(gram_matrix(target, gradients.selected(), given.edges, given.triangle_weights)),
        right_hand_side(source_rest, gradients, target, given.edges, given.triangle_weights),
        vertices(static_cast<int>(source_rest.rows())),
        options(given),
        rules(target.expressions().names, given.rules, given.exclusive) {}

  void judge(const BlendshapeModel& target);
  void set_up(const std::vector<std::string>& names);
  void check_size(const FrameSource& performance) const;
  void smooth(const FrameSource& performance, const Eigen::MatrixXd& h,
              Eigen::MatrixXd& beta) const;

  DeformationGradients gradients;
  Eigen::MatrixXd gram;
  RightHandSide right_hand_side;
  int vertices;
  BlendshapeTransferOptions options;
  ExpressionRules rules;
  BlendshapeConditions conditions;
  std::vector<Eigen::Index> seen;
  double mean_diagonal = 0;                 // of gram, over the columns in `seen`
  std::optional<RuledLeastSquares> solver;  // for gram and ridge; other columns are held
};

/// Finds the expressions that L sees, and the condition of their Gram matrix.
void BlendshapeTransfer::State::judge(const BlendshapeModel& target) {
  Eigen::VectorXd full = gram_diagonal(target, all_triangles(target.triangles()), options.edges);
  // A fit does not depend on the scale of the triangle weights. G is therefore scaled as if all
  // triangles had the largest weight in L.
  const Eigen::VectorXd& counts = options.triangle_weights;
  const std::vector<int>& in_l = gradients.selected();
  if (counts.size() > 0 && !in_l.empty()) full *= counts(in_l).maxCoeff();
  const std::vector<std::string>& names = target.expressions().names;
  for (Eigen::Index j = 0; j < gram.rows(); ++j) {
    if (!moves_there(gram(j, j), full[j])) {
      conditions.unseen.push_back(names[j]);
      continue;
    }
    if (gram(j, j) < kWeaklySeenShare * full[j]) conditions.weakly_seen.push_back(names[j]);
    seen.push_back(j);
  }
  if (seen.empty()) {
    throw MismatchError("none of the target's " + std::to_string(names.size()) +
                        " expressions moves in the " + std::to_string(gradients.selected().size()) +
                        " chosen triangles; choose other regions");
  }
  const Eigen::MatrixXd part = gram(seen, seen);
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(part, Eigen::EigenvaluesOnly).eigenvalues();
  conditions.condition = values[0] > 0 ? values[values.size() - 1] / values[0]
                                       : std::numeric_limits<double>::infinity();
  conditions.degenerate_source_triangles = gradients.replaced();
  conditions.degenerate_target_triangles = degenerate_triangles(target, gradients.selected());
}

void BlendshapeTransfer::State::set_up(const std::vector<std::string>& names) {
  mean_diagonal = gram.diagonal()(seen).mean();
  Eigen::MatrixXd system = gram;
  system.diagonal().array() += options.ridge * mean_diagonal;
  UnknownRules unknowns = rules.unknowns();
  unknowns.pair_weight = options.symmetry * mean_diagonal;
  for (int j = 0; j < static_cast<int>(gram.rows()); ++j) {
    if (options.sparsity > 0 && unknowns.lower[j] < 0) {
      throw MismatchError(options.rules.name + ": '" + names[j] +
                          "' may be negative, for which an L1 term is not defined");
    }
    if (!std::ranges::binary_search(seen, Eigen::Index{j})) unknowns.hold(j);
  }
  solver.emplace(std::move(system), std::move(unknowns));
}

void BlendshapeTransfer::State::check_size(const FrameSource& performance) const {
  if (performance.vertices() == vertices) return;
  throw MismatchError("the performance has " + std::to_string(performance.vertices()) +
                      " vertices, its rest pose " + std::to_string(vertices));
}

/// Replaces the weights of single frames by weights that are smooth over time.
void BlendshapeTransfer::State::smooth(const FrameSource& performance, const Eigen::MatrixXd& h,
                                       Eigen::MatrixXd& beta) const {
  const double mu = smoothness_penalty(options.smoothness, performance.times(), mean_diagonal);
  beta = solver->smooth(h, performance.times(), mu, beta);
}

BlendshapeTransfer::BlendshapeTransfer(const Positions& source_rest, const BlendshapeModel& target,
                                       std::vector<int> triangles,
                                       const BlendshapeTransferOptions& options,
                                       const Context& context) {
  check(source_rest, target, options);
  fix_product_blocking();
  context.report(0);
  state_ = std::make_unique<State>(source_rest, target, std::move(triangles), options);
  context.report(0.5);
  state_->judge(target);
  state_->set_up(target.expressions().names);
  context.report(1);
}

BlendshapeTransfer::~BlendshapeTransfer() = default;
BlendshapeTransfer::BlendshapeTransfer(BlendshapeTransfer&&) noexcept = default;
BlendshapeTransfer& BlendshapeTransfer::operator=(BlendshapeTransfer&&) noexcept = default;

Eigen::MatrixXd BlendshapeTransfer::weights(const FrameSource& performance,
                                            const Context& context) const {
  const State& state = *state_;
  state.check_size(performance);
  fix_product_blocking();
  const Eigen::Index unknowns = state.gram.cols();
  const double penalty = state.options.sparsity * state.mean_diagonal;
  const int frames = performance.frames();
  const bool smooths = state.options.smoothness > 0;
  Eigen::MatrixXd beta(frames, unknowns), h(smooths ? frames : 0, unknowns);
  // Weights, followed by the right-hand sides that smoothing needs.
  const Eigen::Index columns = smooths ? 2 * unknowns : unknowns;
  const auto solve_block = [&](int first, int count) {
    const FrameBlock block(performance, first, count);
    const Eigen::MatrixXd of_block = state.right_hand_side(block.poses()).array() - penalty;
    FrameRows solved(count, columns);
    if (smooths) solved.rightCols(unknowns) = of_block;
    Eigen::VectorXd current = state.solver->rules().lower;
    for (int row = 0; row < count; ++row) {
      current = (*state.solver)(of_block.row(row).transpose(), current);
      solved.row(row).head(unknowns) = current.transpose();
    }
    return solved;
  };
  const auto take = [&](int first, const FrameRows& solved) {
    beta.middleRows(first, solved.rows()) = solved.leftCols(unknowns);
    if (smooths) h.middleRows(first, solved.rows()) = solved.rightCols(unknowns);
  };
  context.for_each_block(frames, kFramesPerBlock, columns, solve_block, take);
  if (smooths) state.smooth(performance, h, beta);
  return state.rules.written(beta);
}

const Eigen::MatrixXd& BlendshapeTransfer::gram() const {
  return state_->gram;
}

Eigen::VectorXd BlendshapeTransfer::right_hand_side(
    const Eigen::Ref<const Positions>& frame) const {
  if (frame.rows() != state_->vertices) {
    throw MismatchError("the frame has " + std::to_string(frame.rows()) +
                        " vertices, the rest pose " + std::to_string(state_->vertices));
  }
  fix_product_blocking();
  const Positions copy = frame;
  const Eigen::Map<const Frames> row(copy.data(), 1, copy.size());
  return state_->right_hand_side(row).transpose();
}

const BlendshapeConditions& BlendshapeTransfer::conditions() const {
  return state_->conditions;
}

bool BlendshapeTransfer::rest_looks_unneutral(const FrameSource& performance,
                                              const Eigen::MatrixXd& weights,
                                              const Context& context) const {
  const State& state = *state_;
  state.check_size(performance);
  fix_product_blocking();
  if (weights.rows() != performance.frames() || weights.cols() != state.gram.cols()) {
    throw MismatchError("the weights are not those of the performance");
  }
  const Eigen::VectorXd diagonal = state.gram.diagonal();
  const Eigen::MatrixXd solved = state.rules.solved(weights);
  std::vector<Eigen::Index> counted = state.seen;
  std::erase_if(counted, [&state](Eigen::Index j) { return state.solver->rules().lower[j] != 0; });
  const int frames = performance.frames();
  Eigen::VectorXd below(frames);
  const auto count_below = [&](int first, int count) {
    const auto beta = solved.middleRows(first, count);
    const FrameBlock block(performance, first, count);
    const Eigen::MatrixXd pull = state.right_hand_side(block.poses()) - beta * state.gram;
    FrameRows found = FrameRows::Zero(count, 1);
    for (const Eigen::Index j : counted) {
      found.array() += (beta.col(j).array() == 0 && pull.col(j).array() < kWantedStep * diagonal[j])
                           .cast<double>();
    }
    return found;
  };
  context.for_each_block(
      frames, kFramesPerBlock, 1, count_below,
      [&](int first, const FrameRows& found) { below.segment(first, found.rows()) = found; });
  const double wanted = below.sum(), all = static_cast<double>(frames * counted.size());
  return wanted > kUnneutralShare * all;
}

}  // namespace mimetra
