#include "toolkit/model/smooth_weights.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "toolkit/mesh/product_blocking.h"
#include "toolkit/model/second_differences.h"
#include "toolkit/model/temporal_system.h"

namespace mimetra {

namespace {

using Rows = TemporalSystem::Rows;
using Array = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Added to the factored diagonal, as a share of its mean, so that a singular Gram matrix can be
/// factored. Residuals are those of the system itself, so it does not move the solution.
constexpr double kLift = 1e-13;

/// min x^T H x / 2 - h^T x over 0 <= x <= 1 by a primal-dual interior-point method with Mehrotra's
/// predictor and corrector; z and w are the multipliers of the lower and the upper bounds.
class InteriorPoint {
 public:
  InteriorPoint(TemporalSystem& system, const Rows& h, double lift)
      : system_(system),
        h_(h),
        lift_(lift),
        scale_(h.lpNorm<Eigen::Infinity>()),
        x_(Array::Constant(h.rows(), h.cols(), 0.5)),
        z_(Array::Constant(h.rows(), h.cols(), scale_)),
        w_(z_) {}

  void solve() {
    constexpr int kMost = 100;      // 16 to 28 steps are usual
    constexpr double kGap = 1e-13;  // of |h|: beyond that rounding takes over
    constexpr double kResidual = 1e-11;
    for (int step = 0; step < kMost; ++step) {
      const Array residual = (system_.product(x_.matrix()) - h_).array() - z_ + w_;
      if (gap() < kGap * scale_ && residual.abs().maxCoeff() < kResidual * scale_) return;
      advance(residual);
    }
    throw std::runtime_error("temporal smoothing did not converge; take a smaller smoothness");
  }

  const Array& solution() const { return x_; }

  /// -1 where the lower bound holds, 1 where the upper one does, 0 elsewhere: of a bound's distance
  /// and its multiplier one goes to 0, and the larger says which.
  Array sides() const {
    return (1 - x_ < w_ / scale_).cast<double>() - (x_ < z_ / scale_).cast<double>();
  }

 private:
  struct Direction {
    Array x, z, w;
  };

  double gap() const { return ((x_ * z_).sum() + ((1 - x_) * w_).sum()) / double(2 * x_.size()); }

  /// Largest share of the way on which `value` stays positive.
  static double room(const Array& value, const Array& change) {
    return (change < 0).select(-value / change, 1.0).minCoeff();
  }

  /// Newton direction towards complementarity products of `goal`, corrected by those of `before`.
  Direction direction(const Array& residual, double goal, const Direction* before) const {
    const Array t = 1 - x_;
    Array p = goal - x_ * z_, q = goal - t * w_;
    if (before) {
      p -= before->x * before->z;
      q += before->x * before->w;
    }
    p /= x_;
    q /= t;
    Direction d;
    d.x = system_.solve((p - q - residual).matrix()).array();
    d.z = p - z_ / x_ * d.x;
    d.w = q + w_ / t * d.x;
    return d;
  }

  void advance(const Array& residual) {
    const Array t = 1 - x_;
    system_.factorize((z_ / x_ + w_ / t + lift_).matrix(), Rows::Ones(h_.rows(), h_.cols()));
    const Direction predictor = direction(residual, 0, nullptr);
    const double primal = std::min(room(x_, predictor.x), room(t, -predictor.x));
    const double dual = std::min(room(z_, predictor.z), room(w_, predictor.w));
    const double predicted = (((x_ + primal * predictor.x) * (z_ + dual * predictor.z)).sum() +
                              ((t - primal * predictor.x) * (w_ + dual * predictor.w)).sum()) /
                             double(2 * x_.size());
    const double now = gap();
    const Direction d = direction(residual, now * std::pow(predicted / now, 3), &predictor);
    constexpr double kInside = 0.995;  // keeps every variable strictly inside
    const double step = std::min(
        1.0, kInside * std::min({room(x_, d.x), room(t, -d.x), room(z_, d.z), room(w_, d.w)}));
    x_ += step * d.x;
    z_ += step * d.z;
    w_ += step * d.w;
  }

  TemporalSystem& system_;
  const Rows& h_;
  double lift_, scale_;
  Array x_, z_, w_;
};

/// Minimum with some unknowns at their bounds.
Rows minimum_on(TemporalSystem& system, const Rows& h, const Array& sides, double lift) {
  const Rows free = (sides == 0).cast<double>().matrix();
  system.factorize(lift * free, free);
  Rows x = (sides > 0).cast<double>().matrix();
  // The second and third solve take out what the lift and rounding left.
  for (int round = 0; round < 3; ++round) {
    x += system.solve((h - system.product(x)).cwiseProduct(free));
  }
  return x;
}

/// Moves bounds until all signs are right. Returns `near` where that does not settle.
Rows polished(TemporalSystem& system, const Rows& h, Array sides, const Rows& near, double lift) {
  constexpr int kRounds = 20;
  const double tolerance = 1e-12 * h.lpNorm<Eigen::Infinity>();
  for (int round = 0; round < kRounds; ++round) {
    Rows x = minimum_on(system, h, sides, lift);
    const Array pull = (h - system.product(x)).array();
    const Array before = sides;
    sides = (before == 0 && x.array() < 0).select(-1.0, sides);
    sides = (before == 0 && x.array() > 1).select(1.0, sides);
    sides = (before * pull < -tolerance).select(0.0, sides);
    if ((sides == before).all()) return x;
  }
  return near;
}

}  // namespace

double smoothness_penalty(double smoothness, const Eigen::VectorXd& times, double mean_diagonal) {
  if (times.size() < 2) return 0;
  return std::pow(smoothness / median_step(times), 4) * mean_diagonal;
}

Eigen::MatrixXd smooth_weights(const std::vector<Eigen::MatrixXd>& grams, const Eigen::MatrixXd& h,
                               const Eigen::VectorXd& times, double mu,
                               const Eigen::MatrixXd& single) {
  if (grams.size() != 1 && static_cast<Eigen::Index>(grams.size()) != h.rows()) {
    throw std::invalid_argument("smoothness: " + std::to_string(grams.size()) +
                                " Gram matrices, expected 1 or " + std::to_string(h.rows()) +
                                ", one for each frame");
  }
  if (times.size() != h.rows()) {
    throw std::invalid_argument("smoothness: " + std::to_string(times.size()) + " times for " +
                                std::to_string(h.rows()) + " frames");
  }
  fix_product_blocking();
  if (h.rows() < 3) return single;
  // Nothing pulls upwards: the interior-point method would have no scale to work with.
  if (h.maxCoeff() <= 0) return Eigen::MatrixXd::Zero(h.rows(), h.cols());
  const Rows right = h;
  double mean = 0;
  for (const Eigen::MatrixXd& gram : grams) mean += gram.diagonal().mean() / double(grams.size());
  const double lift = kLift * mean;
  TemporalSystem system(grams, second_differences(times), mu);
  InteriorPoint method(system, right, lift);
  method.solve();
  return polished(system, right, method.sides(), method.solution().matrix(), lift);
}

}  // namespace mimetra
