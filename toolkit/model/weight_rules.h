#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/model/expression_names.h"

namespace mimetra {

/// Rule that turns the solved weight beta of an expression into the written weight, gain * beta +
/// offset. The limits apply to the written weight, and so bound beta.
struct ExpressionRule {
  double minimum = 0;
  double maximum = 1;
  double gain = 1;  ///< above 0
  double offset = 0;
};

/// Rules for a model's expressions, by name.
struct WeightRules {
  /// Name that messages use: the file.
  std::string name = {};
  /// Left and right halves of one expression. Pairs known from the names apply only to expressions
  /// that are not listed here.
  std::vector<std::array<std::string, 2>> pairs = {};
  /// Groups in which at most one expression per frame has a written weight other than 0.
  std::vector<std::vector<std::string>> exclusive = {};
  std::map<std::string, ExpressionRule> expressions = {};

  bool empty() const { return pairs.empty() && exclusive.empty() && expressions.empty(); }
};

/// Rules for D unknowns, by index.
struct UnknownRules {
  /// lower <= upper (D).
  Eigen::VectorXd lower, upper;
  /// Value within its bounds of an unknown of `exclusive` that may not move (D).
  Eigen::VectorXd off;
  /// Weight of (x_a - x_b)^2 for each pair.
  double pair_weight = 0;
  std::vector<std::array<int, 2>> pairs = {};
  std::vector<std::vector<int>> exclusive = {};

  /// 0 <= x <= 1, without other rules.
  static UnknownRules box(Eigen::Index unknowns);
  /// Fixes an unknown at `off` if it is in a group, otherwise at the value within its bounds
  /// nearest to 0. Removes it from all groups and pairs.
  void hold(int unknown);
};

/// Rules for a model's expressions, and the conversion between solved and written weights.
class ExpressionRules {
 public:
  /// `names` of the model's expressions (D). Pairs and groups known from the names follow the pairs
  /// and groups of `rules`. Throws MismatchError for an unknown name (and suggests the nearest),
  /// and if the limits of an expression in a group do not include 0. Throws std::invalid_argument
  /// for limits that cross, a gain that is not positive, and numbers that are not finite.
  ExpressionRules(const std::vector<std::string>& names, const WeightRules& rules = {},
                  Exclusive known = Exclusive::none);

  /// Rules for beta; pair_weight is 0.
  const UnknownRules& unknowns() const { return unknowns_; }

  /// Written weights (F x D): gain * beta + offset within the limits. Exactly beta without a rule,
  /// and exactly 0 for an expression that is off in its group.
  Eigen::MatrixXd written(const Eigen::MatrixXd& beta) const;
  /// Solved weights beta from the written weights (F x D).
  Eigen::MatrixXd solved(const Eigen::MatrixXd& written) const;

 private:
  std::vector<ExpressionRule> rules_;  // D
  UnknownRules unknowns_;
};

}  // namespace mimetra
