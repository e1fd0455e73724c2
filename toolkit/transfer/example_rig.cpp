#include "toolkit/transfer/example_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/gradient_system.h"
#include "toolkit/transfer/seams.h"

namespace mimetra {

namespace {

/// Motion below this share of the box's diagonal is none, because examples come from files in
/// single precision.
constexpr double kUnmoved = 1e-6;

/// Strength of the prior in the first round, as a multiple of options.prior; it falls to 1. In the
/// paper it falls from 0.5 to 0.1.
constexpr double kFirstPrior = 5;

/// Rounds end if no weight changes by more.
constexpr double kSettled = 1e-4;

/// Weight of a ridge on a pose's weights, as a share of each expression's squared norm. Without it,
/// the weights of nearly equal expressions would be undetermined.
constexpr double kWeightRidge = 1e-3;

constexpr int kTrianglesAtOnce = 256;

Eigen::VectorXd flat_difference(const Positions& pose, const Positions& neutral) {
  const Positions difference = pose - neutral;
  return Eigen::Map<const Eigen::VectorXd>(difference.data(), difference.size());
}

void check_weights(const RigExample& example, const Eigen::VectorXd& weights, int expressions) {
  const bool in_box = weights.size() == expressions && weights.allFinite() &&
                      (weights.array() >= 0).all() && (weights.array() <= 1).all();
  if (in_box) return;
  throw std::invalid_argument(example.name + ": expected " + std::to_string(expressions) +
                              " weights within 0 to 1");
}

void check(const BlendshapeModel& transferred, const std::vector<RigExample>& examples,
           const Weld& weld, const ExampleRigOptions& options) {
  check_options(options);
  weld.check(transferred.neutral(), 2 * kPartedShare * box_diagonal(transferred.neutral()));
  const int expressions = transferred.expressions().size();
  std::vector<bool> is_given(expressions, false);
  for (const RigExample& example : examples) {
    if (example.pose.rows() != transferred.vertices()) {
      throw std::invalid_argument(example.name + ": " + std::to_string(example.pose.rows()) +
                                  " vertices, expected " + std::to_string(transferred.vertices()));
    }
    if (const auto* weights = std::get_if<Eigen::VectorXd>(&example.meaning)) {
      check_weights(example, *weights, expressions);
    }
    const int* expression = std::get_if<int>(&example.meaning);
    if (!expression) continue;
    if (*expression < 0 || *expression >= expressions) {
      throw std::invalid_argument(example.name + ": is expression " + std::to_string(*expression) +
                                  ", expected 0 to " + std::to_string(expressions - 1));
    }
    if (is_given[*expression]) {
      throw std::invalid_argument(
          example.name + ": a second shape of '" +
          transferred.expressions().names[static_cast<std::size_t>(*expression)] + "'");
    }
    is_given[*expression] = true;
  }
}

/// Computes gradients of displacement fields in the planes of a mesh's triangles, and fields from
/// gradients.
///
/// A gradient is 3 x 2, on an orthonormal basis of the triangle's plane. Its norm and products
/// equal the norm and products of the 3 x 3 gradient, which is 0 along the normal.
class PlaneGradients {
 public:
  /// Numbers of a triangle's gradient, stored column by column.
  static constexpr int kNumbers = 6;

  /// `rest` N x 3, `triangles` M x 3. Slivers fade out, and triangles that `weld` (N) collapses do
  /// not count.
  PlaneGradients(const Positions& rest, const Triangles& triangles, Weld weld)
      : triangles_(triangles),
        weld_(std::move(weld)),
        counts_(triangles.rows(), 0),
        hats_(triangles.rows(), Hats::Zero()) {
    const Triangles welded = weld_.welded(triangles_);
    for (int t = 0; t < triangles_.rows(); ++t) {
      const auto corners = welded.row(t);
      const bool collapses =
          corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
      const double count = collapses ? 0 : target_share(quality_of(rest, triangles_, t));
      if (count == 0) continue;
      counts_[t] = count;
      const Eigen::Matrix3d frame = triangle_frame(rest, triangles_, t);
      Gradient basis;
      basis.col(0) = frame.col(0).normalized();
      basis.col(1) = frame.col(2).cross(frame.col(0)).normalized();
      hats_[t] = basis.transpose() * hat_gradients(rest, triangles_, t);
    }
  }

  int triangles() const { return static_cast<int>(triangles_.rows()); }
  const Weld& weld() const { return weld_; }
  /// Weight of each triangle, 0 to 1.
  const std::vector<double>& counts() const { return counts_; }

  /// Gradients of fields (3N x D) at a triangle, 6 x D; 0 if it does not count.
  Eigen::MatrixXd at(int triangle, const Eigen::MatrixXd& fields) const {
    Eigen::MatrixXd gradients = Eigen::MatrixXd::Zero(kNumbers, fields.cols());
    for (int corner = 0; corner < 3; ++corner) {
      const auto here = fields.middleRows<3>(3 * Eigen::Index{triangles_(triangle, corner)});
      gradients.topRows<3>() += hats_[triangle](0, corner) * here;
      gradients.bottomRows<3>() += hats_[triangle](1, corner) * here;
    }
    return gradients;
  }

  /// Unknowns of vertices that are not fixed.
  VertexUnknowns unknowns(const std::vector<bool>& fixed) const {
    return number_unknowns(triangles_, counts_, fixed, weld_);
  }

  /// Field (3N) whose gradients fit `gradients` (6M) best in least squares. It is 0 at `fixed`
  /// vertices (N). Pieces without any have their pin in `unknowns` at 0. The normal equations are
  /// sum_w (sum_i c_i h_iv . h_iw) d_w = sum_i c_i F_i h_iv. \pre welded vertices are fixed
  /// together
  Eigen::VectorXd field_of(const Eigen::VectorXd& gradients, const VertexUnknowns& unknowns) const {
    using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
    Triplets entries;
    Unknowns pull = Unknowns::Zero(unknowns.count, 3);
    for (int t = 0; t < triangles(); ++t) {
      if (counts_[t] == 0) continue;
      std::array<int, 3> of_corner;
      for (int c = 0; c < 3; ++c) of_corner[c] = unknowns.of_vertex[triangles_(t, c)];
      Eigen::Matrix3d hats = Eigen::Matrix3d::Zero();
      hats.topRows<2>() = hats_[t];
      add_products<3>(hats, counts_[t], of_corner, entries);
      const Eigen::Map<const Gradient> gradient(gradients.data() + Eigen::Index{kNumbers} * t);
      for (int c = 0; c < 3; ++c) {
        if (of_corner[c] < 0) continue;
        pull.row(of_corner[c]) += counts_[t] * (gradient * hats_[t].col(c)).transpose();
      }
    }
    const geodesic::SparseFactor factor = factor_of(entries, unknowns.count);
    Unknowns ordered(unknowns.count, 3);
    for (int u = 0; u < unknowns.count; ++u) ordered.row(factor.order()[u]) = pull.row(u);
    if (unknowns.count > 0) ordered = factor.solve<3>(std::move(ordered));
    const auto vertices = static_cast<Eigen::Index>(unknowns.of_vertex.size());
    Eigen::VectorXd field = Eigen::VectorXd::Zero(3 * vertices);
    for (Eigen::Index v = 0; v < vertices; ++v) {
      const int unknown = unknowns.of_vertex[v];
      if (unknown >= 0) field.segment<3>(3 * v) = ordered.row(factor.order()[unknown]).transpose();
    }
    return field;
  }

 private:
  using Gradient = Eigen::Matrix<double, 3, 2>;
  using Hats = Eigen::Matrix<double, 2, 3>;

  Triangles triangles_;
  Weld weld_;
  std::vector<double> counts_;
  std::vector<Hats> hats_;
};

/// Step A of the paper, for the differences E_j from the transferred expressions, at one triangle:
///   min sum_s |R_s - sum_j a_sj E_j|^2 + sum_jk <E_j, (C^-1)_jk E_k>
/// R_s is the part of example s that the transferred expressions do not explain. The paper's prior
/// is C = diag(1 / w_j). Added to it is share <M_j, M_k>, the covariance of E_j = B M_j for an
/// unknown linear map B of gradients. If an expression differs from its source, expressions that
/// move the triangle alike then differ in the same way. The dual needs an S x S system: E = C A^T
/// (A C A^T + N)^-1 R. N is the prior for a pose, and 0 for the true shape of an expression.
class ExampleFit {
 public:
  ExampleFit(const BlendshapeModel& transferred, const std::vector<RigExample>& examples,
             const Weld& weld, const ExampleRigOptions& options, const Context& context)
      : model_(transferred),
        examples_(examples),
        options_(options),
        context_(context),
        gradients_(transferred.neutral(), transferred.triangles(), weld),
        size_(box_diagonal(transferred.neutral())),
        poses_(transferred.neutral().size(), static_cast<Eigen::Index>(examples.size())) {
    for (std::size_t s = 0; s < examples_.size(); ++s) {
      poses_.col(static_cast<Eigen::Index>(s)) =
          flat_difference(examples_[s].pose, model_.neutral());
    }
    const std::vector<bool> none(model_.vertices(), false);
    pieces_ = gradients_.unknowns(none).floating;
  }

  ExampleRig solve() const;

 private:
  /// Mean displacements of each piece (3 x D), by its lowest vertex.
  using Shifts = std::map<VertexIndex, Eigen::MatrixXd>;

  const Eigen::MatrixXd& prior() const { return model_.expressions().displacements; }
  bool looks_for_weights(std::size_t example) const {
    return std::holds_alternative<std::monostate>(examples_[example].meaning);
  }

  Eigen::MatrixXd first_weights() const;
  Eigen::VectorXd weights_of(std::size_t example, const Eigen::MatrixXd& displacements) const;
  Eigen::MatrixXd fitted(const Eigen::MatrixXd& weights, double strength,
                         const Context& context) const;
  Eigen::MatrixXd correction(const Eigen::MatrixXd& before, const Eigen::MatrixXd& left,
                             const Eigen::MatrixXd& weights, double strength) const;
  Eigen::MatrixXd corrections(const Eigen::MatrixXd& left, const Eigen::MatrixXd& weights,
                              double strength, const Context& context) const;
  Shifts shifts(const Eigen::MatrixXd& left, const Eigen::MatrixXd& weights, double strength) const;
  std::vector<bool> fixed(int expression, const Eigen::MatrixXd& left,
                          const Eigen::MatrixXd& weights) const;
  void add_shifts(Eigen::VectorXd& field, const std::vector<FloatingPiece>& floating,
                  const Shifts& shifts, Eigen::Index expression) const;

  const BlendshapeModel& model_;
  const std::vector<RigExample>& examples_;
  const ExampleRigOptions& options_;
  const Context& context_;
  PlaneGradients gradients_;
  double size_;
  Eigen::MatrixXd poses_;  // displacements of the examples, 3N x S
  std::vector<FloatingPiece> pieces_;
};

/// Given weights, and for other examples the best fit of the transferred expressions.
Eigen::MatrixXd ExampleFit::first_weights() const {
  Eigen::MatrixXd weights =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(examples_.size()), prior().cols());
  for (std::size_t s = 0; s < examples_.size(); ++s) {
    auto row = weights.row(static_cast<Eigen::Index>(s));
    if (const int* expression = std::get_if<int>(&examples_[s].meaning)) {
      row[*expression] = 1;
    } else if (const auto* given = std::get_if<Eigen::VectorXd>(&examples_[s].meaning)) {
      row = given->transpose();
    } else {
      row = weights_of(s, prior()).transpose();
    }
  }
  return weights;
}

/// Step B of the paper.
Eigen::VectorXd ExampleFit::weights_of(std::size_t example,
                                       const Eigen::MatrixXd& displacements) const {
  Eigen::MatrixXd gram = displacements.transpose() * displacements;
  const Eigen::VectorXd h =
      displacements.transpose() * poses_.col(static_cast<Eigen::Index>(example));
  gram.diagonal() *= 1 + kWeightRidge;
  const Eigen::Index count = gram.rows();
  return box_least_squares(gram, h, Eigen::VectorXd::Zero(count), Eigen::VectorXd::Ones(count));
}

/// Corrections of the expressions at one place (q x D). `before` (q x D) are the transferred
/// expressions there, and `left` (q x S) is the unexplained part of the examples.
Eigen::MatrixXd ExampleFit::correction(const Eigen::MatrixXd& before, const Eigen::MatrixXd& left,
                                       const Eigen::MatrixXd& weights, double strength) const {
  if (left.isZero(0)) return Eigen::MatrixXd::Zero(before.rows(), before.cols());
  const Eigen::ArrayXd norms = before.colwise().norm().transpose();
  const Eigen::VectorXd freedom =
      ((options_.kappa + norms) / (1 + norms)).pow(options_.theta).matrix();
  const Eigen::MatrixXd shared =
      options_.share * before.transpose() * (before * weights.transpose()).eval();
  const Eigen::MatrixXd covariance = freedom.asDiagonal() * weights.transpose() + shared;
  Eigen::MatrixXd system = weights * covariance;
  for (std::size_t s = 0; s < examples_.size(); ++s) {
    const auto row = static_cast<Eigen::Index>(s);
    if (!std::holds_alternative<int>(examples_[s].meaning)) system(row, row) += strength;
  }
  return left * system.llt().solve(covariance.transpose());
}

/// Corrections of every triangle's gradients, 6M x D.
Eigen::MatrixXd ExampleFit::corrections(const Eigen::MatrixXd& left, const Eigen::MatrixXd& weights,
                                        double strength, const Context& context) const {
  constexpr int kNumbers = PlaneGradients::kNumbers;
  const int triangles = gradients_.triangles();
  Eigen::MatrixXd result =
      Eigen::MatrixXd::Zero(Eigen::Index{kNumbers} * triangles, prior().cols());
  const auto fit_block = [&](int block) {
    const int first = block * kTrianglesAtOnce;
    for (int t = first; t < std::min(triangles, first + kTrianglesAtOnce); ++t) {
      if (gradients_.counts()[t] == 0) continue;
      result.middleRows<kNumbers>(Eigen::Index{kNumbers} * t) =
          correction(gradients_.at(t, prior()), gradients_.at(t, left), weights, strength);
    }
  };
  parallel_for((triangles + kTrianglesAtOnce - 1) / kTrianglesAtOnce, fit_block, context);
  return result;
}

/// Mean displacement of each connected piece, which gradients do not determine. It comes from the
/// same fit, in units of the mesh's size.
ExampleFit::Shifts ExampleFit::shifts(const Eigen::MatrixXd& left, const Eigen::MatrixXd& weights,
                                      double strength) const {
  Shifts result;
  for (const FloatingPiece& piece : pieces_) {
    const auto mean_of = [&](const Eigen::MatrixXd& fields) {
      Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3, fields.cols());
      for (const VertexIndex v : piece.vertices) sum += fields.middleRows<3>(Eigen::Index{3} * v);
      return Eigen::MatrixXd(sum / (static_cast<double>(piece.vertices.size()) * size_));
    };
    result.emplace(piece.vertices.front(),
                   size_ * correction(mean_of(prior()), mean_of(left), weights, strength));
  }
  return result;
}

/// Vertices (N) that nothing moves in an expression.
std::vector<bool> ExampleFit::fixed(int expression, const Eigen::MatrixXd& left,
                                    const Eigen::MatrixXd& weights) const {
  const std::vector<VertexIndex>& one = gradients_.weld().representative;
  std::vector<bool> moves(one.size(), false);
  const auto look_at = [&](const auto& field) {
    for (std::size_t v = 0; v < one.size(); ++v) {
      if (field.template segment<3>(static_cast<Eigen::Index>(3 * v)).norm() > kUnmoved * size_) {
        moves[one[v]] = true;
      }
    }
  };
  look_at(prior().col(expression));
  for (Eigen::Index s = 0; s < weights.rows(); ++s) {
    if (weights(s, expression) > 0) look_at(left.col(s));
  }
  std::vector<bool> result(one.size());
  for (std::size_t v = 0; v < one.size(); ++v) result[v] = !moves[one[v]];
  return result;
}

/// Translates the floating pieces of a field so that their means match `shifts`.
void ExampleFit::add_shifts(Eigen::VectorXd& field, const std::vector<FloatingPiece>& floating,
                            const Shifts& shifts, Eigen::Index expression) const {
  const std::vector<VertexIndex>& one = gradients_.weld().representative;
  Positions by = Positions::Zero(static_cast<Eigen::Index>(one.size()), 3);
  for (const FloatingPiece& piece : floating) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const VertexIndex v : piece.vertices) mean += field.segment<3>(Eigen::Index{3} * v);
    mean /= static_cast<double>(piece.vertices.size());
    const Eigen::Vector3d shift = shifts.at(piece.vertices.front()).col(expression) - mean;
    for (const VertexIndex v : piece.vertices) by.row(v) = shift.transpose();
  }
  for (std::size_t v = 0; v < one.size(); ++v) {
    field.segment<3>(static_cast<Eigen::Index>(3 * v)) += by.row(one[v]).transpose();
  }
}

/// Expressions (3N x D) that fit the examples with these weights (S x D).
Eigen::MatrixXd ExampleFit::fitted(const Eigen::MatrixXd& weights, double strength,
                                   const Context& context) const {
  const Eigen::MatrixXd left = poses_ - prior() * weights.transpose();
  const Eigen::MatrixXd gradients = corrections(left, weights, strength, context);
  const auto of_piece = shifts(left, weights, strength);
  Eigen::MatrixXd result = prior();
  std::vector<bool> is_given(static_cast<std::size_t>(result.cols()), false);
  for (std::size_t s = 0; s < examples_.size(); ++s) {
    const int* expression = std::get_if<int>(&examples_[s].meaning);
    if (!expression) continue;
    is_given[*expression] = true;
    result.col(*expression) = poses_.col(static_cast<Eigen::Index>(s));
  }
  const auto follow = [&](int j) {
    if (is_given[j]) return;
    const auto differs = [j](const auto& shift) { return !shift.second.col(j).isZero(0); };
    if (gradients.col(j).isZero(0) && std::ranges::none_of(of_piece, differs)) return;
    const VertexUnknowns unknowns = gradients_.unknowns(fixed(j, left, weights));
    Eigen::VectorXd field = gradients_.field_of(gradients.col(j), unknowns);
    add_shifts(field, unknowns.floating, of_piece, j);
    result.col(j) += field;
  };
  parallel_for(static_cast<int>(result.cols()), follow, context);
  return result;
}

ExampleRig ExampleFit::solve() const {
  ExampleRig rig{{}, first_weights()};
  bool is_open = false;
  double reported = 0;
  for (std::size_t s = 0; s < examples_.size(); ++s) is_open |= looks_for_weights(s);
  for (int round = 0; is_open && round < options_.rounds; ++round) {
    reported = static_cast<double>(round) / (options_.rounds + 1);
    context_.report(reported);
    const double done = static_cast<double>(round) / options_.rounds;
    rig.displacements =
        fitted(rig.weights, options_.prior * (kFirstPrior + (1 - kFirstPrior) * done),
               context_.part(reported, reported));
    double change = 0;
    for (std::size_t s = 0; s < examples_.size(); ++s) {
      if (!looks_for_weights(s)) continue;
      auto row = rig.weights.row(static_cast<Eigen::Index>(s));
      const Eigen::VectorXd weights = weights_of(s, rig.displacements);
      change = std::max(change, (weights.transpose() - row).cwiseAbs().maxCoeff());
      row = weights.transpose();
    }
    if (change < kSettled) break;
  }
  rig.displacements = fitted(rig.weights, options_.prior, context_.part(reported, reported));
  context_.report(1);
  return rig;
}

}  // namespace

ExampleRig fit_to_examples(const BlendshapeModel& transferred,
                           const std::vector<RigExample>& examples, const Weld& weld,
                           const ExampleRigOptions& options, const Context& context) {
  fix_product_blocking();
  check(transferred, examples, weld, options);
  if (examples.empty() || transferred.expressions().size() == 0) {
    return {transferred.expressions().displacements,
            Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(examples.size()),
                                  transferred.expressions().size())};
  }
  return ExampleFit(transferred, examples, weld, options, context).solve();
}

}  // namespace mimetra
