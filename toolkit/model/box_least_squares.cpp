#include "toolkit/model/box_least_squares.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "toolkit/mesh/rounding.h"

namespace mimetra {

namespace {

enum class Side { lower, free, upper };

/// Rounding of a multiplier: a few units in the last place of its terms, |h| and |G| |x|.
constexpr double kMultiplierRounding = 16 * std::numeric_limits<double>::epsilon();

/// Pivots below this share of the largest indicate a singular system, for which the solution of
/// LDLT is unreliable.
constexpr double kSingularPivot = 1e-13;

/// A problem of D unknowns needs about D passes. If rounding makes it run for ten times as many,
/// the tolerance of the multipliers grows tenfold, and it starts kGrowths times before it fails.
constexpr int kPatience = 10;
constexpr int kGrowths = 6;

class ActiveSet {
 public:
  ActiveSet(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h, const Eigen::VectorXd& lower,
            const Eigen::VectorXd& upper, const Eigen::VectorXd& start)
      : gram_(gram),
        h_(h),
        lower_(lower),
        upper_(upper),
        x_(start.size() > 0 ? start.cwiseMax(lower).cwiseMin(upper).eval() : lower),
        sides_(h.size(), Side::lower),
        held_(h.size(), false) {
    for (Eigen::Index j = 0; j < h.size(); ++j) {
      if (x_[j] > lower[j]) sides_[j] = x_[j] < upper[j] ? Side::free : Side::upper;
    }
  }

  Eigen::VectorXd solve() {
    const Eigen::Index passes = kPatience * (h_.size() + 1);
    Eigen::Index released = -1;
    for (int growth = 0; growth < kGrowths; ++growth, rounding_ *= 10) {
      for (Eigen::Index pass = 0; pass < passes; ++pass) {
        const Eigen::VectorXd before = x_;
        while (!reach_minimum()) {
        }
        // A variable that rounding sends straight back to its bound stays there until others move.
        if (x_ != before) {
          std::ranges::fill(held_, false);
        } else if (released >= 0) {
          held_[released] = true;
        }
        released = release();
        if (released < 0) return x_;
      }
    }
    throw std::runtime_error("bounded least squares did not end; is the Gram matrix semidefinite?");
  }

 private:
  /// Moves towards the minimum over the free variables. The first variable that meets its bound is
  /// fixed there, which ends the move. Returns true if the minimum is reached.
  bool reach_minimum() {
    std::vector<Eigen::Index> free;
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      if (sides_[j] == Side::free) free.push_back(j);
    }
    if (free.empty()) return true;
    const Eigen::VectorXd goal = minimum(free);
    double share = 1;
    Eigen::Index first = -1;
    for (Eigen::Index i = 0; i < goal.size(); ++i) {
      const Eigen::Index j = free[i];
      if (goal[i] >= lower_[j] && goal[i] <= upper_[j]) continue;
      const double room = goal[i] < lower_[j] ? lower_[j] - x_[j] : upper_[j] - x_[j];
      if (first < 0 || room / (goal[i] - x_[j]) < share) {
        share = room / (goal[i] - x_[j]);
        first = i;
      }
    }
    if (first < 0) {
      x_(free) = goal;
      return true;
    }
    for (Eigen::Index i = 0; i < goal.size(); ++i) {
      const Eigen::Index j = free[i];
      x_[j] = std::clamp(x_[j] + share * (goal[i] - x_[j]), lower_[j], upper_[j]);
    }
    const Eigen::Index met = free[first];
    sides_[met] = goal[first] < lower_[met] ? Side::lower : Side::upper;
    x_[met] = sides_[met] == Side::lower ? lower_[met] : upper_[met];
    return false;
  }

  /// Minimum over the free variables with the others at their bounds; the shortest if it is not
  /// unique. It depends on the set of free variables only, not on the path to it.
  Eigen::VectorXd minimum(const std::vector<Eigen::Index>& free) const {
    Eigen::VectorXd bound = x_;
    for (const Eigen::Index j : free) bound[j] = 0;
    const Eigen::VectorXd right = (h_ - gram_ * bound)(free);
    const Eigen::MatrixXd system = gram_(free, free);
    const Eigen::LDLT<Eigen::MatrixXd> factor(system);
    const auto pivots = factor.vectorD();
    if (pivots.minCoeff() > kSingularPivot * pivots.maxCoeff()) return factor.solve(right);
    return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(system).solve(right);
  }

  /// Frees the bound variable with the strongest inward pull and returns its index; -1 at the
  /// optimum.
  Eigen::Index release() {
    const Eigen::VectorXd pull = h_ - gram_ * x_;
    const double tolerance = rounding_ * (h_.lpNorm<Eigen::Infinity>() +
                                          gram_.lpNorm<Eigen::Infinity>() * x_.lpNorm<1>());
    Eigen::Index best = -1;
    double most = tolerance;
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      if (sides_[j] == Side::free || held_[j] || lower_[j] == upper_[j]) continue;
      const double inwards = sides_[j] == Side::lower ? pull[j] : -pull[j];
      if (inwards > most) {
        most = inwards;
        best = j;
      }
    }
    if (best >= 0) sides_[best] = Side::free;
    return best;
  }

  const Eigen::MatrixXd& gram_;
  const Eigen::VectorXd& h_;
  const Eigen::VectorXd& lower_;
  const Eigen::VectorXd& upper_;
  Eigen::VectorXd x_;
  std::vector<Side> sides_;
  std::vector<char> held_;
  double rounding_ = kMultiplierRounding;
};

void check(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h, const Eigen::VectorXd& lower,
           const Eigen::VectorXd& upper, const Eigen::VectorXd& start) {
  const Eigen::Index size = h.size();
  if (gram.rows() != size || gram.cols() != size || lower.size() != size || upper.size() != size ||
      (start.size() != 0 && start.size() != size)) {
    throw std::invalid_argument("bounded least squares: the sizes disagree");
  }
  if (!(lower.array() <= upper.array()).all()) {
    throw std::invalid_argument("bounded least squares: a lower bound is above its upper bound");
  }
  if (!gram.allFinite() || !h.allFinite()) {
    throw std::runtime_error("bounded least squares: the system is not finite");
  }
}

}  // namespace

Eigen::VectorXd box_least_squares(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                                  const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                  const Eigen::VectorXd& start) {
  check(gram, h, lower, upper, start);
  return ActiveSet(gram, h, lower, upper, start).solve();
}

double box_optimality_violation(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                                const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                                const Eigen::VectorXd& x) {
  const Eigen::VectorXd pull = h - gram * x;
  const double norm = h.size() > 0 ? h.lpNorm<Eigen::Infinity>() : 0;
  const double scale = norm > 0 ? norm : 1;
  double violation = 0;
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const bool at_lower = x[j] <= lower[j], at_upper = x[j] >= upper[j];
    const double wrong_up = at_upper ? 0 : std::max(pull[j], 0.0);
    const double wrong_down = at_lower ? 0 : std::max(-pull[j], 0.0);
    violation = std::max(
        {violation, wrong_up / scale, wrong_down / scale, lower[j] - x[j], x[j] - upper[j]});
  }
  return violation;
}

namespace {

/// Well conditioned problems take three to six passes. Exchanging whole blocks can cycle, so the
/// method gives up after this number of passes.
constexpr int kMostPasses = 40;

/// Rounding of an unknown in units of the box, and of a multiplier in units of its terms.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

class BlockExchange {
 public:
  BlockExchange(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h, const Eigen::VectorXd& lower,
                const Eigen::VectorXd& upper, const Eigen::VectorXd& start)
      : gram_(gram),
        h_(h),
        lower_(lower),
        upper_(upper),
        scale_(gram.lpNorm<Eigen::Infinity>()),
        x_(start.size() > 0 ? start.cwiseMax(lower).cwiseMin(upper).eval() : lower),
        sides_(h.size(), Side::lower) {
    for (Eigen::Index j = 0; j < h.size(); ++j) {
      if (x_[j] > lower[j]) sides_[j] = x_[j] < upper[j] ? Side::free : Side::upper;
    }
  }

  /// Returns false if the passes do not end or the system is not definite.
  bool solve() {
    for (int pass = 0; pass < kMostPasses; ++pass) {
      if (!solve_for_free()) return false;
      if (!exchange()) {
        x_ = x_.cwiseMax(lower_).cwiseMin(upper_);
        return true;
      }
    }
    return false;
  }
  const Eigen::VectorXd& x() const { return x_; }

 private:
  /// Solves for the free unknowns without bounds, with the others at their bounds.
  bool solve_for_free() {
    free_.clear();
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      if (sides_[j] == Side::free) free_.push_back(j);
      if (sides_[j] == Side::free) x_[j] = 0;
      if (sides_[j] == Side::lower) x_[j] = lower_[j];
      if (sides_[j] == Side::upper) x_[j] = upper_[j];
    }
    if (free_.empty()) return true;
    const Eigen::VectorXd right = (h_ - gram_ * x_)(free_);
    const Eigen::LLT<Eigen::MatrixXd> factor(gram_(free_, free_));
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd minimum = factor.solve(right);
    x_(free_) = minimum;
    return x_.allFinite();
  }

  /// Moves unknowns that left the box to the bound they crossed, and frees unknowns whose
  /// multiplier pulls inwards. Returns false if there are none: x is the solution.
  bool exchange() {
    const Eigen::VectorXd pull = h_ - gram_ * x_;
    const double tolerance =
        kRounding * (h_.lpNorm<Eigen::Infinity>() + scale_ * x_.lpNorm<Eigen::Infinity>());
    bool exchanged = false;
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      const double room = kRounding * (upper_[j] - lower_[j]);
      Side side = sides_[j];
      if (side == Side::free) {
        if (x_[j] < lower_[j] - room) side = Side::lower;
        if (x_[j] > upper_[j] + room) side = Side::upper;
      } else if (lower_[j] < upper_[j]) {
        const double inwards = side == Side::lower ? pull[j] : -pull[j];
        if (inwards > tolerance) side = Side::free;
      }
      exchanged = exchanged || side != sides_[j];
      sides_[j] = side;
    }
    return exchanged;
  }

  const Eigen::MatrixXd& gram_;
  const Eigen::VectorXd& h_;
  const Eigen::VectorXd& lower_;
  const Eigen::VectorXd& upper_;
  double scale_;
  Eigen::VectorXd x_;
  std::vector<Side> sides_;
  std::vector<Eigen::Index> free_;
};

}  // namespace

Eigen::VectorXd block_pivoting(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                               const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                               const Eigen::VectorXd& start) {
  check(gram, h, lower, upper, start);
  fix_product_blocking();
  BlockExchange exchange(gram, h, lower, upper, start);
  if (exchange.solve()) return exchange.x();
  const Eigen::VectorXd from = exchange.x().allFinite() ? exchange.x() : start;
  return box_least_squares(gram, h, lower, upper, from);
}

}  // namespace mimetra
