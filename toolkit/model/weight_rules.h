#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "toolkit/model/expression_names.h"

namespace mimetra {

/// How the weight beta of an expression, which is solved for, becomes the weight that is written:
/// gain * beta + offset. The limits hold on what is written, and so bound beta.
struct ExpressionRule {
  double minimum = 0;
  double maximum = 1;
  double gain = 1;  ///< above 0
  double offset = 0;
};

/// What is known of a model's expressions besides their shapes, by their names.
struct WeightRules {
  /// What messages call them: the file.
  std::string name = {};
  /// Left and right of one expression. One that is named here is in no pair that names tell.
  std::vector<std::array<std::string, 2>> pairs = {};
  /// Groups of which at most one expression is written as another number than 0 in a frame.
  std::vector<std::vector<std::string>> exclusive = {};
  std::map<std::string, ExpressionRule> expressions = {};

  bool empty() const { return pairs.empty() && exclusive.empty() && expressions.empty(); }
};

/// Rules of D unknowns, by their numbers.
struct UnknownRules {
  /// lower <= upper (D).
  Eigen::VectorXd lower, upper;
  /// What an unknown of `exclusive` is where it is not the one that may move, within its bounds
  /// (D).
  Eigen::VectorXd off;
  /// Weight of (x_a - x_b)^2 for each pair.
  double pair_weight = 0;
  std::vector<std::array<int, 2>> pairs = {};
  std::vector<std::vector<int>> exclusive = {};

  /// 0 <= x <= 1, and nothing else.
  static UnknownRules box(Eigen::Index unknowns);
  /// Keeps one unknown at the number nearest to 0 that it may be, off where it is in a group, and
  /// out of all pairs.
  void hold(int unknown);
};

/// Rules of a model's expressions, and how solved weights become written ones.
class ExpressionRules {
 public:
  /// `names` of the model's expressions (D). Pairs and groups that names tell come after those of
  /// `rules`. Throws MismatchError for a name that is not among them (with the nearest one), and
  /// where 0 is not within the limits of one that is in a group; std::invalid_argument for limits
  /// that cross, a gain that is not above 0, and what is not finite.
  ExpressionRules(const std::vector<std::string>& names, const WeightRules& rules = {},
                  Exclusive known = Exclusive::none);

  /// Of beta; pair_weight is 0.
  const UnknownRules& unknowns() const { return unknowns_; }

  /// gain * beta + offset (F x D), within the limits; exactly beta where there is no rule, and
  /// exactly 0 where a group's expression is off.
  Eigen::MatrixXd written(const Eigen::MatrixXd& beta) const;
  /// The beta of what was written.
  Eigen::MatrixXd solved(const Eigen::MatrixXd& written) const;

 private:
  std::vector<ExpressionRule> rules_;  // D
  UnknownRules unknowns_;
};

}  // namespace mimetra
