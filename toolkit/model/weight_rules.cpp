#include "toolkit/model/weight_rules.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Index of a name of the rules among a model's names.
class NameIndex {
 public:
  NameIndex(const std::vector<std::string>& names, const WeightRules& rules)
      : names_(names), start_(rules.name.empty() ? "" : rules.name + ": ") {}

  int operator()(const std::string& name) const {
    const auto found = std::ranges::find(names_, name);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
    throw MismatchError(start_ + "the model has no expression '" + name + "'" +
                        suggestion_for(name, names_));
  }

  const std::string& start() const { return start_; }

 private:
  const std::vector<std::string>& names_;
  std::string start_;
};

void check(const ExpressionRule& rule, const std::string& name) {
  const bool is_finite = std::isfinite(rule.minimum) && std::isfinite(rule.maximum) &&
                         std::isfinite(rule.gain) && std::isfinite(rule.offset);
  if (!is_finite || !(rule.gain > 0) || rule.minimum > rule.maximum) {
    throw std::invalid_argument(
        "rule of '" + name +
        "': expected finite numbers, a gain above 0, and a minimum up to the maximum");
  }
}

bool is_in(const std::vector<std::array<int, 2>>& pairs, int unknown) {
  return std::ranges::any_of(pairs, [unknown](const std::array<int, 2>& pair) {
    return pair[0] == unknown || pair[1] == unknown;
  });
}

std::vector<std::array<int, 2>> pairs_of(const std::vector<std::string>& names,
                                         const WeightRules& rules, const NameIndex& index_of) {
  std::vector<std::array<int, 2>> given, pairs;
  for (const auto& [left, right] : rules.pairs) given.push_back({index_of(left), index_of(right)});
  pairs = given;
  for (const std::array<int, 2>& pair : known_pairs(names)) {
    if (!is_in(given, pair[0]) && !is_in(given, pair[1])) pairs.push_back(pair);
  }
  return pairs;
}

std::vector<std::vector<int>> groups_of(const std::vector<std::string>& names,
                                        const WeightRules& rules, Exclusive known,
                                        const NameIndex& index_of) {
  std::vector<std::vector<int>> groups;
  for (const std::vector<std::string>& given : rules.exclusive) {
    std::vector<int>& group = groups.emplace_back();
    for (const std::string& name : given) group.push_back(index_of(name));
    std::ranges::sort(group);
  }
  for (std::vector<int>& group : known_exclusives(names, known)) {
    if (std::ranges::find(groups, group) == groups.end()) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace

UnknownRules UnknownRules::box(Eigen::Index unknowns) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(unknowns);
  return {zero, Eigen::VectorXd::Ones(unknowns), zero};
}

void UnknownRules::hold(int unknown) {
  const bool is_in_group = std::ranges::any_of(exclusive, [unknown](const auto& group) {
    return std::ranges::find(group, unknown) != group.end();
  });
  const double value = is_in_group ? off[unknown] : std::clamp(0.0, lower[unknown], upper[unknown]);
  lower[unknown] = upper[unknown] = off[unknown] = value;
  for (std::vector<int>& group : exclusive) std::erase(group, unknown);
  std::erase_if(exclusive, [](const std::vector<int>& group) { return group.size() < 2; });
  std::erase_if(pairs, [unknown](const std::array<int, 2>& pair) {
    return pair[0] == unknown || pair[1] == unknown;
  });
}

ExpressionRules::ExpressionRules(const std::vector<std::string>& names, const WeightRules& rules,
                                 Exclusive known)
    : rules_(names.size()), unknowns_(UnknownRules::box(static_cast<Eigen::Index>(names.size()))) {
  const NameIndex index_of(names, rules);
  for (const auto& [name, rule] : rules.expressions) {
    check(rule, name);
    const int j = index_of(name);
    rules_[j] = rule;
    unknowns_.lower[j] = (rule.minimum - rule.offset) / rule.gain;
    unknowns_.upper[j] = (rule.maximum - rule.offset) / rule.gain;
    unknowns_.off[j] = (0 - rule.offset) / rule.gain;
  }
  unknowns_.pairs = pairs_of(names, rules, index_of);
  unknowns_.exclusive = groups_of(names, rules, known, index_of);
  for (const std::vector<int>& group : unknowns_.exclusive) {
    for (const int j : group) {
      const ExpressionRule& rule = rules_[j];
      if (rule.minimum <= 0 && rule.maximum >= 0) continue;
      throw MismatchError(index_of.start() + "'" + names[j] + "' excludes others and may be from " +
                          readable(rule.minimum) + " to " + readable(rule.maximum) +
                          " only, expected limits around 0, which it is beside them");
    }
  }
}

Eigen::MatrixXd ExpressionRules::written(const Eigen::MatrixXd& beta) const {
  Eigen::MatrixXd result(beta.rows(), beta.cols());
  for (Eigen::Index j = 0; j < beta.cols(); ++j) {
    const ExpressionRule& rule = rules_[j];
    for (Eigen::Index f = 0; f < beta.rows(); ++f) {
      const double weight = rule.gain * beta(f, j) + rule.offset;
      const bool is_off = beta(f, j) == unknowns_.off[j];
      result(f, j) = std::clamp(is_off ? 0 : weight, rule.minimum, rule.maximum);
    }
  }
  return result;
}

Eigen::MatrixXd ExpressionRules::solved(const Eigen::MatrixXd& written) const {
  Eigen::MatrixXd beta(written.rows(), written.cols());
  for (Eigen::Index j = 0; j < beta.cols(); ++j) {
    beta.col(j) = (written.col(j).array() - rules_[j].offset) / rules_[j].gain;
  }
  return beta;
}

}  // namespace mimetra
