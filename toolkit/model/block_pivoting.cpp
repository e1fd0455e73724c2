#include "toolkit/model/block_pivoting.h"

#include <limits>
#include <vector>

#include <Eigen/Cholesky>

#include "toolkit/mesh/product_blocking.h"
#include "toolkit/model/box_least_squares.h"

namespace mimetra {

namespace {

/// Well conditioned problems take three to six passes; exchanging whole blocks can go round in
/// circles, which is given up after so many.
constexpr int kMostPasses = 40;

/// Rounding of an unknown in units of the box, and of a multiplier in units of its terms.
constexpr double kRounding = 64 * std::numeric_limits<double>::epsilon();

enum class Place { lower, free, upper };

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
        places_(h.size(), Place::lower) {
    for (Eigen::Index j = 0; j < h.size(); ++j) {
      if (x_[j] > lower[j]) places_[j] = x_[j] < upper[j] ? Place::free : Place::upper;
    }
  }

  /// False where the passes do not end, or the system is not definite.
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
  /// The minimum over the free unknowns, wherever it is, the others at their bounds.
  bool solve_for_free() {
    free_.clear();
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      if (places_[j] == Place::free) free_.push_back(j);
      if (places_[j] == Place::free) x_[j] = 0;
      if (places_[j] == Place::lower) x_[j] = lower_[j];
      if (places_[j] == Place::upper) x_[j] = upper_[j];
    }
    if (free_.empty()) return true;
    const Eigen::VectorXd right = (h_ - gram_ * x_)(free_);
    const Eigen::LLT<Eigen::MatrixXd> factor(gram_(free_, free_));
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd minimum = factor.solve(right);
    x_(free_) = minimum;
    return x_.allFinite();
  }

  /// Sends unknowns that left the box to the bound they crossed, and frees those whose multiplier
  /// pulls inwards. False where there are none: x is the solution.
  bool exchange() {
    const Eigen::VectorXd pull = h_ - gram_ * x_;
    const double tolerance =
        kRounding * (h_.lpNorm<Eigen::Infinity>() + scale_ * x_.lpNorm<Eigen::Infinity>());
    bool exchanged = false;
    for (Eigen::Index j = 0; j < x_.size(); ++j) {
      const double room = kRounding * (upper_[j] - lower_[j]);
      Place place = places_[j];
      if (place == Place::free) {
        if (x_[j] < lower_[j] - room) place = Place::lower;
        if (x_[j] > upper_[j] + room) place = Place::upper;
      } else if (lower_[j] < upper_[j]) {
        const double inwards = place == Place::lower ? pull[j] : -pull[j];
        if (inwards > tolerance) place = Place::free;
      }
      exchanged = exchanged || place != places_[j];
      places_[j] = place;
    }
    return exchanged;
  }

  const Eigen::MatrixXd& gram_;
  const Eigen::VectorXd& h_;
  const Eigen::VectorXd& lower_;
  const Eigen::VectorXd& upper_;
  double scale_;
  Eigen::VectorXd x_;
  std::vector<Place> places_;
  std::vector<Eigen::Index> free_;
};

bool is_sound(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h, const Eigen::VectorXd& lower,
              const Eigen::VectorXd& upper, const Eigen::VectorXd& start) {
  const Eigen::Index size = h.size();
  return gram.rows() == size && gram.cols() == size && lower.size() == size &&
         upper.size() == size && (start.size() == 0 || start.size() == size) &&
         (lower.array() <= upper.array()).all() && gram.allFinite() && h.allFinite();
}

}  // namespace

Eigen::VectorXd block_pivoting(const Eigen::MatrixXd& gram, const Eigen::VectorXd& h,
                               const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
                               const Eigen::VectorXd& start) {
  // What is wrong is said by the other one.
  if (!is_sound(gram, h, lower, upper, start)) {
    return box_least_squares(gram, h, lower, upper, start);
  }
  fix_product_blocking();
  BlockExchange exchange(gram, h, lower, upper, start);
  if (exchange.solve()) return exchange.x();
  const Eigen::VectorXd from = exchange.x().allFinite() ? exchange.x() : start;
  return box_least_squares(gram, h, lower, upper, from);
}

}  // namespace mimetra
