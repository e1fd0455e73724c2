#include "toolkit/transfer/local_weights.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/vertex_pull.h"

namespace mimetra {

namespace {

/// Frames per block. A solve starts from the previous frame within its block only, so that blocks
/// are independent.
constexpr int kRegionalBlock = RegionalRightHandSide::kLanes;

/// Edges of one region's fields, gathered at the vertices. The product of two fields over edges is
/// a sum over vertices: one field's displacement times the other's gathered edges.
class GatheredFields {
 public:
  GatheredFields(const BlendshapeModel& target, const Eigen::VectorXd& shares,
                 const std::vector<int>& triangles, EdgeSum sum)
      : row_of_vertex_(target.vertices(), -1) {
    const Triangles& faces = target.triangles();
    std::vector<int> touched;
    for (const int t : triangles) {
      const auto corners = faces.row(t);
      if (shares[corners[0]] == 0 && shares[corners[1]] == 0 && shares[corners[2]] == 0) continue;
      touched.push_back(t);
      for (const VertexIndex v : corners) {
        if (row_of_vertex_[v] < 0) row_of_vertex_[v] = count_++;
      }
    }
    const Eigen::Matrix2d product = edge_product(sum);
    const Eigen::MatrixXd& fields = target.expressions().displacements;
    gathered_ = Eigen::MatrixXd::Zero(3 * count_, fields.cols());
    for (Eigen::Index j = 0; j < fields.cols(); ++j) {
      const PositionsView field(fields.col(j).data(), target.vertices(), 3);
      for (const int t : touched) {
        const auto corners = faces.row(t);
        const auto at = [&](int corner) {
          return (shares[corners[corner]] * field.row(corners[corner])).transpose().eval();
        };
        Edges edges;
        edges << at(1) - at(0), at(2) - at(0);
        const Edges pull = edges.lazyProduct(product);
        gathered_.col(j).segment<3>(row(corners[0])) -= pull.rowwise().sum();
        gathered_.col(j).segment<3>(row(corners[1])) += pull.col(0);
        gathered_.col(j).segment<3>(row(corners[2])) += pull.col(1);
      }
    }
  }

  /// Products with the fields of another region (D x D), which are the rows.
  Eigen::MatrixXd product(const Eigen::MatrixXd& fields, const RegionShares& shares,
                          Eigen::Index region) const {
    std::vector<std::pair<VertexIndex, double>> common;
    for (RegionShares::InnerIterator share(shares, region); share; ++share) {
      const auto vertex = static_cast<VertexIndex>(share.index());
      if (row_of_vertex_[vertex] >= 0) common.emplace_back(vertex, share.value());
    }
    const auto rows = static_cast<Eigen::Index>(3 * common.size());
    Eigen::MatrixXd theirs(rows, fields.cols()), ours(rows, fields.cols());
    for (Eigen::Index i = 0; i < rows / 3; ++i) {
      const auto& [vertex, share] = common[i];
      theirs.middleRows<3>(3 * i) = share * fields.middleRows<3>(3 * vertex);
      ours.middleRows<3>(3 * i) = gathered_.middleRows<3>(row(vertex));
    }
    return theirs.transpose() * ours;
  }

 private:
  Eigen::Index row(VertexIndex vertex) const { return 3 * row_of_vertex_[vertex]; }

  std::vector<int> row_of_vertex_;
  Eigen::Index count_ = 0;
  Eigen::MatrixXd gathered_;  // three rows a vertex
};

/// A^T A of eq. 11 over some triangles, if each region has its own weights (R D x R D). Entry (r D
/// + j, s D + m) sums over edges the products of the fields share_r dV_j and share_s dV_m. Blocks
/// of regions without a common triangle are exactly 0. Throws Cancelled.
Eigen::MatrixXd regional_gram(const BlendshapeModel& target, const RegionShares& shares,
                              const std::vector<int>& triangles, EdgeSum sum,
                              const Context& context) {
  fix_product_blocking();
  const Eigen::MatrixXd& fields = target.expressions().displacements;
  const Eigen::Index D = fields.cols(), R = shares.cols();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(R * D, R * D);
  const auto fill = [&](int s) {
    const GatheredFields gathered(target, shares.col(s), triangles, sum);
    for (Eigen::Index r = 0; r <= s; ++r) {
      const Eigen::MatrixXd block = gathered.product(fields, shares, r);
      gram.block(r * D, s * D, D, D) = block;
      gram.block(s * D, r * D, D, D) = block.transpose();
    }
    // The block is made exactly symmetric, since a solver may read either half.
    const Eigen::MatrixXd own = gram.block(s * D, s * D, D, D);
    gram.block(s * D, s * D, D, D) = (own + own.transpose()) / 2;
  };
  parallel_for(static_cast<int>(R), fill, context);
  return gram;
}

void check_regional(const Positions& source_rest, const BlendshapeModel& target,
                    const RegionShares& shares, const LocalWeightsOptions& options) {
  check_sizes(source_rest, target.neutral(), options.pairing.get());
  check_options(options);
  if (target.expressions().size() == 0) throw MismatchError("the target has no expressions");
  if (shares.rows() == target.vertices()) return;
  throw std::invalid_argument("shares of " + std::to_string(shares.rows()) +
                              " vertices, the target has " + std::to_string(target.vertices()));
}

void check_performance(const FrameSource& performance, int vertices) {
  if (performance.vertices() == vertices) return;
  throw MismatchError("the performance has " + std::to_string(performance.vertices()) +
                      " vertices, its rest pose " + std::to_string(vertices));
}

}  // namespace

struct LocalWeights::State {
  State(const Positions& source_rest, const BlendshapeModel& given, const RegionShares& shares,
        std::vector<int> selected, const LocalWeightsOptions& of_call, const Context& context)
      : options(of_call),
        vertices(static_cast<int>(source_rest.rows())),
        expressions(given.expressions().size()),
        gradients(gradients_between(source_rest, given.triangles(), of_call.pairing.get(),
                                    with_partners(std::move(selected), of_call.pairing.get()))),
        gram(regional_gram(given, shares, gradients.selected(), of_call.edges, context)),
        right_hand_side(source_rest, gradients, given, shares, of_call.edges) {}

  void set_up(const BlendshapeModel& target);
  /// Solves for the weights of one frame, given the whole face's. `current` is the start, or empty,
  /// and is replaced by the solution. Returns its box_optimality_violation().
  double solve(const Eigen::VectorXd& h, const Eigen::VectorXd& global,
               Eigen::VectorXd& current) const;

  LocalWeightsOptions options;
  int vertices;
  Eigen::Index expressions;
  DeformationGradients gradients;
  Eigen::MatrixXd gram;
  RegionalRightHandSide right_hand_side;
  Eigen::VectorXd pull;
  std::vector<Eigen::Index> seen;
  Eigen::MatrixXd system;  // gram and pull of the unknowns in `seen`
};

/// Finds the unknowns that move the target, and sets how strongly the ridge pulls each.
void LocalWeights::State::set_up(const BlendshapeModel& target) {
  const Eigen::VectorXd full =
      gram_diagonal(target, all_triangles(target.triangles()), options.edges);
  pull = Eigen::VectorXd::Zero(gram.rows());
  for (Eigen::Index first = 0; first < gram.rows(); first += expressions) {
    std::vector<Eigen::Index> in_region;
    for (Eigen::Index j = 0; j < expressions; ++j) {
      if (moves_there(gram(first + j, first + j), full[j])) in_region.push_back(first + j);
    }
    if (in_region.empty()) continue;
    pull(in_region).array() = options.ridge * gram.diagonal()(in_region).mean();
    seen.insert(seen.end(), in_region.begin(), in_region.end());
  }
  system = gram(seen, seen);
  system.diagonal() += pull(seen);
}

double LocalWeights::State::solve(const Eigen::VectorXd& h, const Eigen::VectorXd& global,
                                  Eigen::VectorXd& current) const {
  const Eigen::VectorXd everywhere = global.replicate(gram.rows() / expressions, 1);
  const auto unknowns = static_cast<Eigen::Index>(seen.size());
  const Eigen::VectorXd right = (h + pull.cwiseProduct(everywhere))(seen);
  const Eigen::VectorXd lower = Eigen::VectorXd::Zero(unknowns);
  const Eigen::VectorXd upper = Eigen::VectorXd::Ones(unknowns);
  const Eigen::VectorXd start = (current.size() > 0 ? current : everywhere)(seen);
  const Eigen::VectorXd found = block_pivoting(system, right, lower, upper, start);
  // Expressions that do not move in a region keep the whole face's weight.
  current = everywhere;
  current(seen) = found;
  return box_optimality_violation(system, right, lower, upper, found);
}

LocalWeights::LocalWeights(const Positions& source_rest, const BlendshapeModel& target,
                           const RegionShares& shares, std::vector<int> triangles,
                           const LocalWeightsOptions& options, const Context& context) {
  check_regional(source_rest, target, shares, options);
  fix_product_blocking();
  state_ = std::make_unique<State>(source_rest, target, shares, std::move(triangles), options,
                                   context.part(0, 0.9));
  state_->set_up(target);
  context.report(1);
}

LocalWeights::~LocalWeights() = default;
LocalWeights::LocalWeights(LocalWeights&&) noexcept = default;
LocalWeights& LocalWeights::operator=(LocalWeights&&) noexcept = default;

RegionalWeights LocalWeights::weights(const FrameSource& performance, const Eigen::MatrixXd& global,
                                      const Context& context) const {
  const State& state = *state_;
  check_performance(performance, state.vertices);
  if (global.rows() != performance.frames() || global.cols() != state.expressions) {
    throw MismatchError("the weights of the whole face are not those of the performance");
  }
  fix_product_blocking();
  const int frames = performance.frames();
  const Eigen::Index unknowns = state.gram.rows();
  RegionalWeights result{Eigen::MatrixXd(frames, unknowns)};
  Eigen::VectorXd violations(frames);
  const auto solve_block = [&](int first, int count) {
    const FrameBlock block(performance, first, count);
    const Eigen::MatrixXd h = state.right_hand_side(block.poses());
    FrameRows solved(count, unknowns + 1);
    Eigen::VectorXd current;
    for (int row = 0; row < count; ++row) {
      solved(row, unknowns) =
          state.solve(h.row(row).transpose(), global.row(first + row).transpose(), current);
      solved.row(row).head(unknowns) = current.transpose();
    }
    return solved;
  };
  const auto take = [&](int first, const FrameRows& solved) {
    result.beta.middleRows(first, solved.rows()) = solved.leftCols(unknowns);
    violations.segment(first, solved.rows()) = solved.col(unknowns);
  };
  context.for_each_block(frames, kRegionalBlock, unknowns + 1, solve_block, take);
  if (frames > 0) result.violation = violations.maxCoeff();
  return result;
}

const Eigen::MatrixXd& LocalWeights::gram() const {
  return state_->gram;
}

const Eigen::VectorXd& LocalWeights::pull() const {
  return state_->pull;
}

Eigen::VectorXd LocalWeights::right_hand_side(const Eigen::Ref<const Positions>& frame) const {
  if (frame.rows() != state_->vertices) {
    throw MismatchError("the frame has " + std::to_string(frame.rows()) +
                        " vertices, the rest pose " + std::to_string(state_->vertices));
  }
  fix_product_blocking();
  const Positions copy = frame;
  const Eigen::Map<const Frames> row(copy.data(), 1, copy.size());
  return state_->right_hand_side(row).transpose();
}

}  // namespace mimetra
