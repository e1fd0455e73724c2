#include "toolkit/model/ruled_least_squares.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/rounding.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/model/smooth_weights.h"

namespace mimetra {

namespace {

/// Energies that differ by less than this share of their lower bound are equal: rounding would
/// choose between them.
constexpr double kEqualEnergies = 1e-12;

/// Branch and bound over exclusive groups: depth first, the lower unknown of a group first.
class ExclusiveSearch {
 public:
  ExclusiveSearch(const Eigen::MatrixXd& system, const UnknownRules& rules,
                  const Eigen::VectorXd& h)
      : system_(system), rules_(rules), h_(h) {}

  Eigen::VectorXd operator()(const Eigen::VectorXd& start) {
    visit(rules_.lower, rules_.upper, start);
    return std::move(best_);
  }

 private:
  void visit(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
             const Eigen::VectorXd& start) {
    Eigen::VectorXd x = box_least_squares(system_, h_, lower, upper, start);
    const std::vector<int>* group = broken_group(x);
    const bool is_root = tolerance_ < 0;
    if (is_root && !group) {
      best_ = std::move(x);
      return;
    }
    const double energy = x.dot(system_ * x) / 2 - h_.dot(x);
    if (is_root) tolerance_ = kEqualEnergies * std::abs(energy);
    if (best_.size() > 0 && energy >= least_ - tolerance_) return;
    if (!group) {
      best_ = std::move(x);
      least_ = energy;
      return;
    }
    for (const int chosen : *group) {
      // Another group's choice already holds this unknown off. Its branch would move nothing in
      // this group, which every other branch allows as well.
      if (lower[chosen] == upper[chosen]) continue;
      Eigen::VectorXd low = lower, high = upper;
      for (const int other : *group) {
        if (other != chosen) low[other] = high[other] = rules_.off[other];
      }
      visit(low, high, x);
    }
  }

  /// First group with more than one unknown that moves, or null.
  const std::vector<int>* broken_group(const Eigen::VectorXd& x) const {
    for (const std::vector<int>& group : rules_.exclusive) {
      const auto moves = [&](int unknown) { return x[unknown] != rules_.off[unknown]; };
      if (std::ranges::count_if(group, moves) > 1) return &group;
    }
    return nullptr;
  }

  const Eigen::MatrixXd& system_;
  const UnknownRules& rules_;
  const Eigen::VectorXd& h_;
  Eigen::VectorXd best_;
  double least_ = 0;
  double tolerance_ = -1;  // until the root is solved
};

/// Unknown of `group` that may move in each frame; -1 if none ever moves.
std::vector<int> choices(const std::vector<int>& group, const Eigen::VectorXd& off,
                         const Eigen::MatrixXd& single) {
  std::vector<int> chosen(single.rows(), -1);
  int current = -1;
  for (Eigen::Index f = 0; f < single.rows(); ++f) {
    for (const int unknown : group) {
      if (single(f, unknown) != off[unknown]) current = unknown;
    }
    chosen[f] = current;
  }
  const auto first = std::ranges::find_if(chosen, [](int unknown) { return unknown >= 0; });
  if (first != chosen.end()) std::fill(chosen.begin(), first, *first);
  return chosen;
}

void check_rules(const Eigen::MatrixXd& gram, const UnknownRules& rules) {
  const Eigen::Index size = gram.rows();
  const auto fail = [](const std::string& what) {
    throw std::invalid_argument("rules of unknowns: " + what);
  };
  if (gram.cols() != size || rules.lower.size() != size || rules.upper.size() != size ||
      rules.off.size() != size) {
    fail("the sizes disagree");
  }
  if (!(rules.lower.array() <= rules.upper.array()).all()) {
    fail("a lower bound is above its upper bound");
  }
  const auto check_number = [&](int unknown) {
    if (unknown < 0 || unknown >= size) {
      fail("unknown " + std::to_string(unknown) + ", expected 0 to " + std::to_string(size - 1));
    }
  };
  for (const std::array<int, 2>& pair : rules.pairs) std::ranges::for_each(pair, check_number);
  for (const std::vector<int>& group : rules.exclusive) {
    for (const int unknown : group) {
      check_number(unknown);
      const double off = rules.off[unknown];
      if (off >= rules.lower[unknown] && off <= rules.upper[unknown]) continue;
      fail("unknown " + std::to_string(unknown) + " cannot be off within its bounds");
    }
  }
}

}  // namespace

RuledLeastSquares::RuledLeastSquares(Eigen::MatrixXd gram, UnknownRules rules)
    : system_(std::move(gram)), rules_(std::move(rules)) {
  check_rules(system_, rules_);
  if (rules_.pair_weight == 0) return;
  for (const auto& [a, b] : rules_.pairs) {
    if (a == b) continue;
    system_(a, a) += rules_.pair_weight;
    system_(b, b) += rules_.pair_weight;
    system_(a, b) -= rules_.pair_weight;
    system_(b, a) -= rules_.pair_weight;
  }
}

Eigen::VectorXd RuledLeastSquares::operator()(const Eigen::VectorXd& h,
                                              const Eigen::VectorXd& start) const {
  fix_product_blocking();
  if (rules_.exclusive.empty()) {
    return box_least_squares(system_, h, rules_.lower, rules_.upper, start);
  }
  return ExclusiveSearch(system_, rules_, h)(start);
}

Eigen::MatrixXd RuledLeastSquares::smooth(const Eigen::MatrixXd& h, const Eigen::VectorXd& times,
                                          double mu, const Eigen::MatrixXd& single) const {
  WeightBounds bounds{rules_.lower.transpose().replicate(h.rows(), 1),
                      rules_.upper.transpose().replicate(h.rows(), 1)};
  for (const std::vector<int>& group : rules_.exclusive) {
    const std::vector<int> chosen = choices(group, rules_.off, single);
    for (Eigen::Index f = 0; f < h.rows(); ++f) {
      for (const int unknown : group) {
        if (unknown == chosen[f]) continue;
        bounds.lower(f, unknown) = bounds.upper(f, unknown) = rules_.off[unknown];
      }
    }
  }
  return smooth_weights({system_}, h, times, mu, single, bounds);
}

}  // namespace mimetra
