#include "toolkit/operations/exclusion.h"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace mimetra {

namespace {

/// "!NAME=VALUE", taken apart.
struct Term {
  bool is_negated;
  std::string name;
  std::string value;  ///< or empty

  explicit Term(const std::string& text) : is_negated(text.front() == '!') {
    const std::size_t begin = is_negated ? 1 : 0, equals = std::min(text.find('='), text.size());
    name = text.substr(begin, equals - begin);
    if (equals < text.size()) value = text.substr(equals + 1);
  }

  /// As people type it: "--select transfer", "-k".
  std::string option(const Parameters& parameters) const {
    const Parameter* parameter = parameters.find(name);
    const std::string option = parameter ? parameter->option() : "--" + name;
    return value.empty() || is_negated ? option : option + ' ' + value;
  }
};

bool is_there(const Term& term, const Parameters& parameters, const HasValue& has_value) {
  const Parameter* parameter = parameters.find(term.name);
  if (!parameter) return has_value(term.name);
  if (!term.value.empty()) return to_text(parameters.value(term.name)) == term.value;
  if (parameter->kind == ParameterKind::flag) return parameters.flag(term.name);
  if (parameter->several) return !parameters.paths(term.name).empty();
  return parameters.is_set(term.name);
}

}  // namespace

std::optional<std::string> refusal(const std::vector<Exclusion>& exclusions,
                                   const Parameters& parameters, const HasValue& has_value) {
  const auto holds = [&](const std::string& text) {
    const Term term(text);
    return is_there(term, parameters, has_value) != term.is_negated;
  };
  const auto all_hold = [&holds](const std::string& texts) {
    std::istringstream words(texts);
    return std::all_of(std::istream_iterator<std::string>(words), {}, holds);
  };
  for (const auto& [refused, beside, reason] : exclusions) {
    const auto found = std::ranges::find_if(refused, holds);
    if (found == refused.end() || std::ranges::none_of(beside, all_hold)) continue;
    return Term(*found).option(parameters) + ": " + reason;
  }
  return {};
}

}  // namespace mimetra
