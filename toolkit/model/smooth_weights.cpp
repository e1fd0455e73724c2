#include "toolkit/model/smooth_weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "toolkit/mesh/rounding.h"
#include "toolkit/model/smoothness.h"

namespace mimetra {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The system of temporal smoothing, H = blockdiag(G_f) + mu D2^T D2, where D2 are the second
/// differences over time. It acts on F x D matrices (one row per frame). It couples frames at most
/// two apart, so that blocks of two frames make it block tridiagonal.
class TemporalSystem {
 public:
  /// `grams`: D x D, one for all frames or one for each; `differences` F - 2 rows. \pre F >= 3
  TemporalSystem(std::vector<Eigen::MatrixXd> grams, SecondDifferences differences, double mu);

  /// H x (F x D).
  Rows product(const Rows& x) const;

  /// The diagonal of H (F x D).
  Rows diagonal() const;

  /// Upper bound of the largest sum of absolute entries in a row of H.
  double norm() const;

  /// Factors H + diag(extra). Unknowns with `free` = 0 (F x D of 0 and 1) are decoupled from the
  /// others. Throws std::runtime_error if the system is not positive definite.
  void factorize(const Rows& extra, const Rows& free);

  /// Solves the system that was factored last, for one right-hand side (F x D).
  Rows solve(const Rows& right) const;

 private:
  Eigen::Index first(Eigen::Index block) const { return 2 * block; }
  Eigen::Index size(Eigen::Index block) const;
  Eigen::Index blocks() const { return (frames_ + 1) / 2; }
  const Eigen::MatrixXd& gram(Eigen::Index frame) const;
  double coupling(Eigen::Index a, Eigen::Index b) const;
  Eigen::MatrixXd diagonal_block(Eigen::Index block, const Rows& extra, const Rows& free) const;
  Eigen::MatrixXd lower_block(Eigen::Index block, const Rows& free) const;

  std::vector<Eigen::MatrixXd> grams_;
  SecondDifferences differences_;
  Eigen::Index frames_;
  double mu_;
  std::vector<Eigen::MatrixXd> cholesky_;  // L_k, lower triangles
  std::vector<Eigen::MatrixXd> below_;     // W_k = H_(k+1)k L_k^-T
};

using Column = Eigen::Map<Eigen::VectorXd>;
using ConstColumn = Eigen::Map<const Eigen::VectorXd>;

TemporalSystem::TemporalSystem(std::vector<Eigen::MatrixXd> grams, SecondDifferences differences,
                               double mu)
    : grams_(std::move(grams)),
      differences_(std::move(differences)),
      frames_(differences_.rows() + 2),
      mu_(mu) {}

const Eigen::MatrixXd& TemporalSystem::gram(Eigen::Index frame) const {
  return grams_[grams_.size() == 1 ? 0 : frame];
}

Eigen::Index TemporalSystem::size(Eigen::Index block) const {
  return std::min<Eigen::Index>(2, frames_ - first(block));
}

/// Entry (a, b) of mu D2^T D2: row f of D2 has three entries, at frames f, f + 1 and f + 2.
double TemporalSystem::coupling(Eigen::Index a, Eigen::Index b) const {
  const Eigen::Index low = std::max<Eigen::Index>({0, a - 2, b - 2});
  const Eigen::Index high = std::min({a, b, frames_ - 3});
  double sum = 0;
  for (Eigen::Index f = low; f <= high; ++f) {
    sum += differences_(f, a - f) * differences_(f, b - f);
  }
  return mu_ * sum;
}

Rows TemporalSystem::product(const Rows& x) const {
  Rows result(x.rows(), x.cols());
  if (grams_.size() == 1) {
    result.noalias() = x * grams_.front();
  } else {
    for (Eigen::Index f = 0; f < frames_; ++f) result.row(f) = x.row(f) * grams_[f];
  }
  const Eigen::Index n = differences_.rows();
  const Rows second = mu_ * differences_of(differences_, x);
  for (int i = 0; i < 3; ++i) result.middleRows(i, n) += differences_.col(i).asDiagonal() * second;
  return result;
}

Rows TemporalSystem::diagonal() const {
  Rows result(frames_, grams_.front().cols());
  for (Eigen::Index f = 0; f < frames_; ++f) {
    result.row(f) = gram(f).diagonal().transpose().array() + coupling(f, f);
  }
  return result;
}

double TemporalSystem::norm() const {
  double of_grams = 0, of_couplings = 0;
  for (const Eigen::MatrixXd& gram : grams_) {
    of_grams = std::max(of_grams, gram.lpNorm<Eigen::Infinity>());
  }
  for (Eigen::Index a = 0; a < frames_; ++a) {
    double sum = 0;
    for (Eigen::Index b = std::max<Eigen::Index>(0, a - 2); b < std::min(frames_, a + 3); ++b) {
      sum += std::abs(coupling(a, b));
    }
    of_couplings = std::max(of_couplings, sum);
  }
  return of_grams + of_couplings;
}

Eigen::MatrixXd TemporalSystem::diagonal_block(Eigen::Index block, const Rows& extra,
                                               const Rows& free) const {
  const Eigen::Index d = grams_.front().rows(), start = first(block), frames = size(block);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(frames * d, frames * d);
  for (Eigen::Index a = 0; a < frames; ++a) {
    result.block(a * d, a * d, d, d) = gram(start + a);
    for (Eigen::Index b = 0; b < frames; ++b) {
      result.block(a * d, b * d, d, d).diagonal().array() += coupling(start + a, start + b);
    }
  }
  const ConstColumn mask(free.row(start).data(), frames * d);
  result = mask.asDiagonal() * result * mask.asDiagonal();
  result.diagonal() += ConstColumn(extra.row(start).data(), frames * d);
  result.diagonal().array() += 1 - mask.array();
  return result;
}

Eigen::MatrixXd TemporalSystem::lower_block(Eigen::Index block, const Rows& free) const {
  const Eigen::Index d = grams_.front().rows(), here = first(block), next = first(block + 1);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size(block + 1) * d, size(block) * d);
  for (Eigen::Index a = 0; a < size(block + 1); ++a) {
    for (Eigen::Index b = 0; b < size(block); ++b) {
      result.block(a * d, b * d, d, d).diagonal() =
          coupling(next + a, here + b) * free.row(next + a).cwiseProduct(free.row(here + b));
    }
  }
  return result;
}

void TemporalSystem::factorize(const Rows& extra, const Rows& free) {
  cholesky_.clear();
  below_.clear();
  for (Eigen::Index block = 0; block < blocks(); ++block) {
    Eigen::MatrixXd schur = diagonal_block(block, extra, free);
    if (block > 0) {
      schur.selfadjointView<Eigen::Lower>().rankUpdate(below_.back(), -1);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(schur);
    if (factor.info() != Eigen::Success) {
      throw std::runtime_error("temporal smoothing: the system is not positive definite");
    }
    cholesky_.push_back(factor.matrixL());
    if (block + 1 == blocks()) break;
    below_.push_back(cholesky_.back()
                         .triangularView<Eigen::Lower>()
                         .solve(lower_block(block, free).transpose())
                         .transpose());
  }
}

Rows TemporalSystem::solve(const Rows& right) const {
  Rows x = right;
  const auto part = [&](Eigen::Index block) {
    return Column(x.row(first(block)).data(), size(block) * x.cols());
  };
  for (Eigen::Index block = 0; block < blocks(); ++block) {
    if (block > 0) part(block) -= below_[block - 1] * part(block - 1);
    cholesky_[block].triangularView<Eigen::Lower>().solveInPlace(part(block));
  }
  for (Eigen::Index block = blocks() - 1; block >= 0; --block) {
    if (block + 1 < blocks()) part(block) -= below_[block].transpose() * part(block + 1);
    cholesky_[block].triangularView<Eigen::Lower>().transpose().solveInPlace(part(block));
  }
  return x;
}

using Array = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Share of the mean diagonal that is added to the factored system, so that a singular Gram matrix
/// can be factored. Residuals use the system itself, so the solution does not move.
constexpr double kLift = 1e-13;

/// Bounds of the unknowns. `free` is 1, or 0 if both bounds are equal.
struct Box {
  Array lower, upper, free;

  Array middle() const { return (lower + upper) / 2; }
  Array nearest_to_zero() const { return lower.max(0.0).min(upper); }
};

Box box_of(const WeightBounds& bounds, const Eigen::MatrixXd& h) {
  const auto checked = [&h](const Eigen::MatrixXd& given, double usual) -> Array {
    if (given.size() == 0) return Array::Constant(h.rows(), h.cols(), usual);
    if (given.rows() == h.rows() && given.cols() == h.cols()) return given.array();
    throw std::invalid_argument("smoothness: bounds of another number of weights");
  };
  Box box{checked(bounds.lower, 0), checked(bounds.upper, 1), {}};
  if (!(box.lower <= box.upper).all()) {
    throw std::invalid_argument("smoothness: a lower bound is above its upper bound");
  }
  box.free = (box.lower < box.upper).cast<double>();
  return box;
}

/// Upper bound of the rounding of H x: a few units in the last place of its terms.
double rounding_of(const TemporalSystem& system, const Box& box) {
  constexpr double kUnits = 4 * std::numeric_limits<double>::epsilon();
  return kUnits * system.norm() * box.lower.abs().max(box.upper.abs()).maxCoeff();
}

/// Minimises x^T H x / 2 - h^T x over a box by a primal-dual interior-point method with Mehrotra's
/// predictor and corrector. The multipliers of the lower and upper bounds are z and w. Unknowns
/// that are not free keep their value and have multipliers of 0.
class InteriorPoint {
 public:
  /// `scale`: magnitude of the multipliers.
  InteriorPoint(TemporalSystem& system, const Rows& h, const Box& box, double scale, double lift)
      : system_(system),
        h_(h),
        box_(box),
        lift_(lift),
        scale_(scale),
        rounding_(rounding_of(system, box)),
        unknowns_(std::max(1.0, box.free.sum())),
        x_(box.middle()),
        below_((box.free > 0).select(x_ - box.lower, 1.0)),
        above_((box.free > 0).select(box.upper - x_, 1.0)),
        z_(scale * box.free),
        w_(z_) {}

  /// Iterates until the mean product of distance and multiplier is below `gap` times the scale. May
  /// be called again with a smaller gap.
  void solve(double gap) {
    constexpr int kMost = 100;  // 16 to 30 steps are usual
    constexpr double kResidual = 1e-11;
    for (int step = 0; step < kMost; ++step) {
      const Array residual = ((system_.product(x_.matrix()) - h_).array() - z_ + w_) * box_.free;
      const bool is_feasible = residual.abs().maxCoeff() < std::max(kResidual * scale_, rounding_);
      if (is_feasible && mean_product() < gap * scale_) return;
      advance(residual);
    }
    throw std::runtime_error("temporal smoothing did not converge; take a smaller smoothness");
  }

  const Array& solution() const { return x_; }

  /// -1 if the lower bound is active, 1 if the upper bound is, 0 otherwise. Of a bound's distance
  /// and its multiplier one goes to 0, and the larger one decides. The stiffness turns a distance
  /// into the multiplier that moves a weight that far; a stiff penalty makes such distances far
  /// smaller than 1.
  Array sides() const {
    const Array stiffness = system_.diagonal().array();
    const Array sides =
        (above_ * stiffness < w_).cast<double>() - (below_ * stiffness < z_).cast<double>();
    return (box_.free > 0).select(sides, -1.0);
  }

 private:
  struct Direction {
    Array x, z, w;
  };

  double mean_product() const {
    return ((below_ * z_).sum() + (above_ * w_).sum()) / (2 * unknowns_);
  }

  /// Largest share of the step for which `value` stays positive.
  static double room(const Array& value, const Array& change) {
    return (change < 0).select(-value / change, 1.0).minCoeff();
  }

  /// Newton direction towards complementarity products of `goal`, corrected by the products of
  /// `before`.
  Direction direction(const Array& residual, double goal, const Direction* before) const {
    const Array &s = below_, &t = above_;
    Array p = goal - s * z_, q = goal - t * w_;
    if (before) {
      p -= before->x * before->z;
      q += before->x * before->w;
    }
    p *= box_.free / s;
    q *= box_.free / t;
    Direction d;
    d.x = system_.solve((p - q - residual).matrix()).array();
    d.z = p - z_ / s * d.x;
    d.w = q + w_ / t * d.x;
    return d;
  }

  void advance(const Array& residual) {
    const Array &s = below_, &t = above_;
    system_.factorize((z_ / s + w_ / t + lift_ * box_.free).matrix(), box_.free.matrix());
    const Direction predictor = direction(residual, 0, nullptr);
    const double primal = std::min(room(s, predictor.x), room(t, -predictor.x));
    const double dual = std::min(room(z_, predictor.z), room(w_, predictor.w));
    const double predicted = (((s + primal * predictor.x) * (z_ + dual * predictor.z)).sum() +
                              ((t - primal * predictor.x) * (w_ + dual * predictor.w)).sum()) /
                             (2 * unknowns_);
    const double now = mean_product();
    const Direction d = direction(residual, now * std::pow(predicted / now, 3), &predictor);
    constexpr double kInside = 0.995;  // keeps every variable strictly inside
    const double step = std::min(
        1.0, kInside * std::min({room(s, d.x), room(t, -d.x), room(z_, d.z), room(w_, d.w)}));
    x_ += step * d.x;
    below_ += step * d.x;
    above_ -= step * d.x;
    z_ += step * d.z;
    w_ += step * d.w;
  }

  TemporalSystem& system_;
  const Rows& h_;
  const Box& box_;
  double lift_, scale_, rounding_, unknowns_;
  Array x_;
  /// Distances from the bounds, 1 for fixed unknowns. They are kept beside x, because a distance
  /// far below x's last place still shows which bounds are active.
  Array below_, above_;
  Array z_, w_;
};

/// Minimum with some unknowns at their bounds; the others start near `near`.
Rows minimum_on(TemporalSystem& system, const Rows& h, const Box& box, const Array& sides,
                const Array& near, double lift) {
  const Rows free = (sides == 0).cast<double>().matrix();
  system.factorize(lift * free, free);
  Rows x = (sides == 0).select(near, (sides > 0).select(box.upper, box.lower)).matrix();
  // The second and third solve remove what the lift and rounding left.
  for (int round = 0; round < 3; ++round) {
    x += system.solve((h - system.product(x)).cwiseProduct(free));
  }
  return x;
}

/// Moves bounds until all signs are right; nullopt if that does not settle.
std::optional<Rows> polished(TemporalSystem& system, const Rows& h, const Box& box, Array sides,
                             const Array& near, double scale, double lift) {
  constexpr int kRounds = 20;
  const double tolerance = std::max(1e-12 * scale, rounding_of(system, box));
  for (int round = 0; round < kRounds; ++round) {
    Rows x = minimum_on(system, h, box, sides, near, lift);
    const Array pull = (h - system.product(x)).array();
    const Array before = sides;
    sides = (before == 0 && x.array() < box.lower).select(-1.0, sides);
    sides = (before == 0 && x.array() > box.upper).select(1.0, sides);
    sides = (box.free > 0 && before * pull < -tolerance).select(0.0, sides);
    if ((sides == before).all()) return x;
  }
  return {};
}

void check_counts(const std::vector<Eigen::MatrixXd>& grams, const Eigen::MatrixXd& h,
                  const Eigen::VectorXd& times) {
  if (grams.size() != 1 && static_cast<Eigen::Index>(grams.size()) != h.rows()) {
    throw std::invalid_argument("smoothness: " + std::to_string(grams.size()) +
                                " Gram matrices, expected 1 or " + std::to_string(h.rows()) +
                                ", one for each frame");
  }
  if (times.size() != h.rows()) {
    throw std::invalid_argument("smoothness: " + std::to_string(times.size()) + " times for " +
                                std::to_string(h.rows()) + " frames");
  }
}

/// Largest multiplier of `x` with the wrong sign.
double wrong_pull(const Array& pull, const Box& box, const Array& x) {
  const Array up = (x < box.upper).select(pull, 0.0), down = (x > box.lower).select(-pull, 0.0);
  return std::max({up.maxCoeff(), down.maxCoeff(), 0.0});
}

}  // namespace

Eigen::MatrixXd smooth_weights(const std::vector<Eigen::MatrixXd>& grams, const Eigen::MatrixXd& h,
                               const Eigen::VectorXd& times, double mu,
                               const Eigen::MatrixXd& single, const WeightBounds& bounds) {
  check_counts(grams, h, times);
  const Box box = box_of(bounds, h);
  fix_product_blocking();
  if (h.rows() < 3) return single;
  const Rows right = h;
  double mean = 0;
  for (const Eigen::MatrixXd& gram : grams) mean += gram.diagonal().mean() / double(grams.size());
  const double lift = kLift * mean;
  TemporalSystem system(grams, second_differences(times), mu);
  const Array still = box.nearest_to_zero();
  const Array pull = (right - system.product(still.matrix())).array();
  // Nothing pulls away from `still`: the interior-point method would have no scale to work with.
  if (wrong_pull(pull, box, still) == 0) return still.matrix();
  const double scale = std::max(right.lpNorm<Eigen::Infinity>(), pull.abs().maxCoeff());
  InteriorPoint method(system, right, box, scale, lift);
  // If the penalty is 10^7 times the data, free weights can be as close as 1e-9 to their bounds.
  // The products must then be far below the rounding of x to show which bounds are active.
  const auto polished_here = [&] {
    return polished(system, right, box, method.sides(), method.solution(), scale, lift);
  };
  method.solve(1e-18);
  if (auto found = polished_here()) return *found;
  const Array settled = method.solution();
  try {
    method.solve(1e-22);
  } catch (const std::runtime_error&) {
    // If the penalty is much larger than the data, such a small gap is below rounding.
    return settled.matrix();
  }
  if (auto found = polished_here()) return *found;
  return method.solution().matrix();
}

double smooth_optimality_violation(const std::vector<Eigen::MatrixXd>& grams,
                                   const Eigen::MatrixXd& h, const Eigen::VectorXd& times,
                                   double mu, const Eigen::MatrixXd& beta,
                                   const WeightBounds& bounds) {
  check_counts(grams, h, times);
  const Box box = box_of(bounds, h);
  fix_product_blocking();
  const TemporalSystem system(grams, second_differences(times), mu);
  const Array x = beta;
  const Array pull = (Rows(h) - system.product(beta)).array();
  const double norm = h.lpNorm<Eigen::Infinity>();
  const double outside = std::max((box.lower - x).maxCoeff(), (x - box.upper).maxCoeff());
  return std::max({outside, wrong_pull(pull, box, x) / (norm > 0 ? norm : 1), 0.0});
}

}  // namespace mimetra
