#include "toolkit/io/rules_file.h"

#include <algorithm>
#include <cmath>
#include <system_error>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Reader of parsed rules that knows each value's place, for messages.
class RulesReader {
 public:
  explicit RulesReader(const std::filesystem::path& path)
      : path_(path.string()), root_(read_json(path, "rules as JSON")) {}

  WeightRules read() {
    check_keys(root_, {"pairs", "exclusive", "expressions"}, "");
    rules_.name = path_;
    if (root_.contains("pairs")) read_pairs(root_["pairs"]);
    if (root_.contains("exclusive")) read_groups(root_["exclusive"]);
    if (root_.contains("expressions")) read_expressions(root_["expressions"]);
    check_groups();
    return std::move(rules_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& message) const {
    throw IoError(path_, (place.empty() ? "/" : place) + ": " + message);
  }

  void check_keys(const Json& object, const std::vector<std::string>& known,
                  const std::string& place) const {
    if (!object.is_object()) {
      fail(place, "expected an object of " + joined(known, ", ", " and ") + ", found " +
                      short_text(object));
    }
    for (const auto& [key, value] : object.items()) {
      if (std::ranges::find(known, key) != known.end()) continue;
      fail(place + "/" + key,
           "is none of " + joined(known, ", ", " and ") + suggestion_for(key, known));
    }
  }

  std::vector<std::string> names(const Json& list, const std::string& place) const {
    if (!list.is_array()) fail(place, "expected a list of names, found " + short_text(list));
    std::vector<std::string> names;
    for (const Json& name : list) {
      const std::string here = place + "/" + std::to_string(names.size());
      if (!name.is_string()) fail(here, "expected a name, found " + short_text(name));
      names.push_back(name.get<std::string>());
      if (std::ranges::count(names, names.back()) > 1) {
        fail(here, "'" + names.back() + "' occurs twice");
      }
    }
    return names;
  }

  const Json& list(const Json& value, const std::string& place) const {
    if (!value.is_array()) fail(place, "expected a list of lists, found " + short_text(value));
    return value;
  }

  void read_pairs(const Json& pairs) {
    for (const Json& pair : list(pairs, "/pairs")) {
      const std::string place = "/pairs/" + std::to_string(rules_.pairs.size());
      const std::vector<std::string> both = names(pair, place);
      if (both.size() != 2) {
        fail(place, "expected two names, found " + std::to_string(both.size()));
      }
      rules_.pairs.push_back({both[0], both[1]});
    }
  }

  void read_groups(const Json& groups) {
    for (const Json& group : list(groups, "/exclusive")) {
      const std::string place = "/exclusive/" + std::to_string(rules_.exclusive.size());
      rules_.exclusive.push_back(names(group, place));
      const std::size_t count = rules_.exclusive.back().size();
      if (count < 2) {
        fail(place, "expected two names or more, found " + std::to_string(count));
      }
    }
  }

  void read_expressions(const Json& expressions) {
    if (!expressions.is_object()) {
      fail("/expressions", "expected an object of names, found " + short_text(expressions));
    }
    for (const auto& [name, value] : expressions.items()) {
      const std::string place = "/expressions/" + name;
      check_keys(value, {"minimum", "maximum", "gain", "offset"}, place);
      const ExpressionRule usual;
      const ExpressionRule rule{number(value, "minimum", place, usual.minimum),
                                number(value, "maximum", place, usual.maximum),
                                number(value, "gain", place, usual.gain),
                                number(value, "offset", place, usual.offset)};
      if (rule.minimum > rule.maximum) {
        fail(place, "its minimum, " + readable(rule.minimum) + ", is above its maximum, " +
                        readable(rule.maximum));
      }
      if (!(rule.gain > 0)) {
        fail(place + "/gain", "expected more than 0, found " + readable(rule.gain));
      }
      rules_.expressions.emplace(name, rule);
    }
  }

  double number(const Json& rule, const std::string& key, const std::string& place,
                double usual) const {
    if (!rule.contains(key)) return usual;
    const Json& value = rule[key];
    const bool is_number = value.is_number() && std::isfinite(value.get<double>());
    if (!is_number || std::abs(value.get<double>()) > kLargest) {
      fail(place + "/" + key, "expected a number from -" + readable(kLargest) + " to " +
                                  readable(kLargest) + ", found " + short_text(value));
    }
    return value.get<double>();
  }

  void check_groups() const {
    for (std::size_t g = 0; g < rules_.exclusive.size(); ++g) {
      for (const std::string& name : rules_.exclusive[g]) {
        const auto rule = rules_.expressions.find(name);
        if (rule == rules_.expressions.end()) continue;
        if (rule->second.minimum <= 0 && rule->second.maximum >= 0) continue;
        fail("/expressions/" + name,
             "is in /exclusive/" + std::to_string(g) +
                 ", where it is 0 beside the others: expected limits around 0, found " +
                 readable(rule->second.minimum) + " to " + readable(rule->second.maximum));
      }
    }
  }

  /// Weights are about 1, so larger numbers are mistakes and would dominate the solution.
  static constexpr double kLargest = 1000;

  std::string path_;
  Json root_;
  WeightRules rules_;
};

}  // namespace

WeightRules read_rules(const std::filesystem::path& path) {
  return RulesReader(path).read();
}

std::optional<std::filesystem::path> rules_beside(const std::filesystem::path& model) {
  std::error_code unreadable;
  if (!std::filesystem::is_directory(model, unreadable)) return {};
  const std::filesystem::path file = model / "rules.json";
  if (!is_there(file)) return {};
  return file;
}

}  // namespace mimetra
