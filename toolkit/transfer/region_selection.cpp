#include "toolkit/transfer/region_selection.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Cholesky>

#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"

namespace mimetra {

namespace {

/// A residual below this share of the wanted change is rounding, and its size is meaningless.
constexpr double kRounding = 1e-20;

/// Tolerance for a share of the triangles times their number, which rounding may leave below a
/// whole number.
constexpr double kWholeTriangle = 1e-9;

constexpr int kTrianglesPerPiece = 256;

/// Vector b of eq. 11: the changes (Q_i - I) V_i of the selected triangles' edges, in the target's
/// unit. Each triangle has six rows as in edge_rows(), and each frame one column (6 T x F).
/// `gradients` are for the target's triangles, taken at the performance's rest pose. Throws what
/// reading throws, and Cancelled.
Eigen::MatrixXd wanted_change(const DeformationGradients& gradients, const BlendshapeModel& target,
                              const FrameSource& performance, EdgeSum sum, const Context& context) {
  const std::vector<int>& selected = gradients.selected();
  const Eigen::Matrix2d factor = edge_factor(sum);
  Eigen::MatrixXd wanted(6 * selected.size(), performance.frames());
  const auto fill_frame = [&](int f) {
    const FrameBlock block(performance, f, 1);
    const auto q = gradients(block.frame(0));
    for (std::size_t s = 0; s < selected.size(); ++s) {
      const auto row = static_cast<Eigen::Index>(s);
      const Edges edges =
          edges_of(target.neutral(), target.triangles(), selected[s]).lazyProduct(factor);
      const Eigen::Matrix3d change = q.middleRows<3>(3 * row) - Eigen::Matrix3d::Identity();
      const Edges changed = change.lazyProduct(edges);
      wanted.col(f).segment<6>(6 * row) = changed.reshaped();
    }
  };
  parallel_for(performance.frames(), fill_frame, context);
  return wanted;
}

/// Residual r = b - A beta (6 T x F) of the wanted change after the weights beta (F x D). Throws
/// Cancelled.
Eigen::MatrixXd unmet_change(Eigen::MatrixXd wanted, std::span<const int> triangles,
                             const BlendshapeModel& target, const Eigen::MatrixXd& weights,
                             EdgeSum sum, const Context& context) {
  fix_product_blocking();
  const auto count = static_cast<int>(triangles.size());
  const auto subtract = [&](int piece) {
    const int first = piece * kTrianglesPerPiece;
    const int size = std::min(kTrianglesPerPiece, count - first);
    wanted.middleRows(6 * first, 6 * size).noalias() -=
        edge_rows(target, triangles.subspan(first, size), sum) * weights.transpose();
  };
  parallel_for((count + kTrianglesPerPiece - 1) / kTrianglesPerPiece, subtract, context);
  return wanted;
}

/// s^2. `wanted` is the sum of squares of the wanted change.
double variance_of(const Eigen::MatrixXd& unmet, double wanted) {
  const auto count = static_cast<double>(std::max<Eigen::Index>(1, unmet.size()));
  const double least = kRounding * wanted / count;
  const double variance = std::max(unmet.squaredNorm() / count, least);
  return variance > 0 ? variance : 1;
}

void check_bound(const SelectionBound& bound) {
  if (!(bound.share > 0 && bound.share <= 1)) {
    throw std::invalid_argument("share is " + std::to_string(bound.share) +
                                "; it must be above 0 and at most 1");
  }
  if (bound.count && *bound.count < 1) {
    throw std::invalid_argument("count is " + std::to_string(*bound.count) +
                                "; at least 1 disc is chosen");
  }
}

/// Target triangles over each of the source's; without a pairing (null), each triangle itself.
std::vector<std::vector<int>> over_each(const Pairing* pairing, int triangles) {
  if (!pairing) {
    std::vector<std::vector<int>> same(triangles);
    for (int t = 0; t < triangles; ++t) same[t] = {t};
    return same;
  }
  const Correspondence& pairs = pairing->triangles();
  std::vector<std::vector<int>> over(pairs.source_triangles);
  for (int t = 0; t < pairs.target_triangles(); ++t) {
    for (int p = pairs.offsets[t]; p < pairs.offsets[t + 1]; ++p) {
      over[pairs.parts[p].triangle].push_back(t);
    }
  }
  return over;
}

}  // namespace

Sight Sight::none(Eigen::Index expressions, Eigen::Index frames) {
  return {Eigen::MatrixXd::Zero(expressions, expressions),
          Eigen::MatrixXd::Zero(expressions, frames)};
}

Sight& Sight::operator+=(const Sight& more) {
  gram += more.gram;
  pull += more.pull;
  return *this;
}

DiscChoice::DiscChoice(Eigen::MatrixXd gram, double variance, double noise)
    : gram_(std::move(gram)),
      ridge_(kRidge * gram_.diagonal().mean()),
      variance_(noise * variance) {}

double DiscChoice::criterion(const Sight& of_regions) const {
  fix_product_blocking();
  Eigen::MatrixXd system = of_regions.gram;
  system.diagonal().array() += ridge_;
  const Eigen::LLT<Eigen::MatrixXd> factor(system);
  const Eigen::MatrixXd shift = factor.solve(of_regions.pull);
  const double bias = shift.cwiseProduct(gram_ * shift).sum();
  return bias / static_cast<double>(shift.cols()) + variance_ * factor.solve(gram_).trace();
}

/// State of the search: the chosen discs, and the contribution of each other disc.
class RegionSelection::Greedy {
 public:
  Greedy(const RegionSelection& selection, std::span<const Disc> discs)
      : selection_(selection),
        discs_(discs),
        additions_(discs.size()),
        over_(over_each(selection.options_.pairing.get(),
                        static_cast<int>(selection.target_.triangles().rows()))),
        is_chosen_(over_.size(), false),
        is_seen_(selection.row_of_.size(), false),
        sight_(Sight::none(selection.target_.expressions().size(), selection.unmet_.cols())),
        log_criterion_(std::log(selection.choice_->criterion(sight_))) {
    for (std::size_t d = 0; d < discs.size(); ++d) {
      std::vector<int>& touched = additions_[d].touched;
      for (const int triangle : discs[d].triangles) {
        touched.insert(touched.end(), over_[triangle].begin(), over_[triangle].end());
      }
      std::ranges::sort(touched);
      touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    }
  }

  int source_triangles() const { return static_cast<int>(is_chosen_.size()); }

  /// Best disc that adds at least one and at most `room` triangles, if there is one.
  std::optional<int> best(int room, const Context& context) {
    parallel_for(
        static_cast<int>(discs_.size()), [this, room](int d) { judge(d, room); }, context);
    std::optional<int> best;
    for (int d = 0; d < static_cast<int>(discs_.size()); ++d) {
      if (additions_[d].cost == 0 || additions_[d].cost > room) continue;
      const double least = best ? additions_[*best].fall : 0;
      if (!best || additions_[d].fall > least + kNearTie * std::abs(least)) best = d;
    }
    return best;
  }

  /// Takes a disc that best() returned. Returns the number of source triangles that it adds.
  int take(int d) {
    for (const int triangle : discs_[d].triangles) is_chosen_[triangle] = true;
    for (const int triangle : additions_[d].fresh) is_seen_[triangle] = true;
    sight_ += additions_[d].sight;
    log_criterion_ = additions_[d].log_criterion;
    return additions_[d].cost;
  }

 private:
  struct Addition {
    std::vector<int> touched;  // target triangles with a partner in the disc
    std::vector<int> fresh;    // target triangles that the disc would newly show
    Sight sight;               // of `fresh`
    int cost = 0;              // triangles of the source that are not in L yet
    double log_criterion = 0;  // log J with the disc
    double fall = 0;           // fall of log J per triangle of `cost`
  };

  void judge(int d, int room) {
    Addition& addition = additions_[d];
    addition.cost = static_cast<int>(
        std::ranges::count_if(discs_[d].triangles, [this](int t) { return !is_chosen_[t]; }));
    if (addition.cost == 0 || addition.cost > room) return;
    std::vector<int> fresh = fresh_with(d);
    if (addition.sight.gram.size() == 0 || fresh != addition.fresh) {
      addition.fresh = std::move(fresh);
      addition.sight = selection_.sight_of(addition.fresh);
    }
    Sight with = sight_;
    with += addition.sight;
    addition.log_criterion = std::log(selection_.choice_->criterion(with));
    addition.fall = (log_criterion_ - addition.log_criterion) / addition.cost;
  }

  std::vector<int> fresh_with(int d) const {
    const std::vector<int>& disc = discs_[d].triangles;
    const auto is_in_source = [&](int triangle) {
      return is_chosen_[triangle] || std::ranges::binary_search(disc, triangle);
    };
    const Pairing* pairing = selection_.options_.pairing.get();
    std::vector<int> fresh;
    for (const int t : additions_[d].touched) {
      if (is_seen_[t] || selection_.row_of_[t] < 0) continue;
      if (!pairing || is_over(pairing->triangles(), t, is_in_source)) fresh.push_back(t);
    }
    return fresh;
  }

  const RegionSelection& selection_;
  std::span<const Disc> discs_;
  std::vector<Addition> additions_;
  std::vector<std::vector<int>> over_;
  std::vector<char> is_chosen_;  // triangles of the source
  std::vector<char> is_seen_;    // triangles of the target
  Sight sight_;
  double log_criterion_;
};

RegionSelection::RegionSelection(const FrameSource& performance, const BlendshapeModel& target,
                                 const RegionSelectionOptions& options, const Context& context)
    : target_(target), options_(options) {
  check_options(options);
  // Each process solves on its own.
  const Context alone = context.without_ranks();
  const Eigen::MatrixXd weights =
      BlendshapeTransfer(performance.rest(), target, all_triangles(target.triangles()),
                         {.edges = options.edges, .pairing = options.pairing}, alone.part(0, 0.2))
          .weights(performance, alone.part(0.2, 0.6));
  const Pairing* pairing = options.pairing.get();
  const DeformationGradients gradients =
      gradients_between(performance.rest(), target.triangles(), pairing,
                        with_partners(all_triangles(target.triangles()), pairing));
  fix_product_blocking();
  row_of_.assign(target.triangles().rows(), -1);
  for (std::size_t s = 0; s < gradients.selected().size(); ++s) {
    row_of_[gradients.selected()[s]] = static_cast<int>(s);
  }
  unmet_ = wanted_change(gradients, target, performance, options.edges, alone.part(0.6, 0.8));
  const double wanted = unmet_.squaredNorm();
  unmet_ = unmet_change(std::move(unmet_), gradients.selected(), target, weights, options.edges,
                        alone.part(0.8, 1));
  choice_.emplace(gram_matrix(target, gradients.selected(), options.edges),
                  variance_of(unmet_, wanted), options.noise);
}

Sight RegionSelection::sight_of(std::span<const int> triangles) const {
  Sight sight = Sight::none(target_.expressions().size(), unmet_.cols());
  if (triangles.empty()) return sight;
  const Eigen::MatrixXd rows = edge_rows(target_, triangles, options_.edges);
  Eigen::MatrixXd unmet(rows.rows(), unmet_.cols());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    unmet.middleRows<6>(6 * static_cast<Eigen::Index>(i)) =
        unmet_.middleRows<6>(6 * Eigen::Index{row_of_[triangles[i]]});
  }
  sight.gram.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  sight.gram.triangularView<Eigen::StrictlyUpper>() = sight.gram.transpose();
  sight.pull.noalias() = rows.transpose() * unmet;
  return sight;
}

std::vector<int> RegionSelection::choose(std::span<const Disc> discs, const SelectionBound& bound,
                                         const Context& context) const {
  check_bound(bound);
  fix_product_blocking();
  Greedy greedy(*this, discs);
  const double triangles = greedy.source_triangles();
  const auto all = static_cast<int>(std::floor(bound.share * triangles + kWholeTriangle));
  const auto most = static_cast<std::size_t>(bound.count.value_or(std::numeric_limits<int>::max()));
  int room = all;
  double done = 0;
  std::vector<int> chosen;
  while (chosen.size() < most) {
    const std::optional<int> best = greedy.best(room, context.part(done, done));
    if (!best) break;
    room -= greedy.take(*best);
    chosen.push_back(*best);
    done = 1 - static_cast<double>(room) / all;
    context.report(done);
  }
  return chosen;
}

double RegionSelection::criterion(const std::vector<int>& triangles) const {
  fix_product_blocking();
  std::vector<int> counting;
  std::ranges::copy_if(triangles, std::back_inserter(counting),
                       [this](int triangle) { return row_of_[triangle] >= 0; });
  return choice_->criterion(sight_of(counting));
}

}  // namespace mimetra
