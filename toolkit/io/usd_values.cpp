#include "toolkit/io/usd_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

std::vector<double> numbers_at(const UsdProperty& property, std::optional<double> code) {
  const auto& samples = property.samples;
  if (samples.empty() || (!code && property.has_value)) return property.value.numbers;
  if (!code) return samples.front().second.numbers;
  const auto after =
      std::ranges::upper_bound(samples, *code, {}, &std::pair<double, UsdValue>::first);
  if (after == samples.begin()) return after->second.numbers;
  const auto& [from, start] = *std::prev(after);
  if (after == samples.end() || from == *code ||
      after->second.numbers.size() != start.numbers.size()) {
    return start.numbers;
  }
  const double share = (*code - from) / (after->first - from);
  std::vector<double> between = start.numbers;
  for (std::size_t i = 0; i < between.size(); ++i) {
    between[i] += share * (after->second.numbers[i] - between[i]);
  }
  return between;
}

}  // namespace

void usd_fail(const std::string& path, int line, const std::string& message) {
  throw IoError(path, "line " + std::to_string(line) + ": " + message);
}

const UsdProperty* usd_property(const UsdPrim& prim, const std::string& name) {
  const auto found = prim.properties.find(name);
  return found == prim.properties.end() ? nullptr : &found->second;
}

void check_numbers(const std::string& path, const UsdProperty& property,
                   const std::vector<double>& numbers) {
  if (property.blocked_line > 0) {
    usd_fail(path, property.blocked_line, "a time sample of nothing is not read");
  }
  const bool sound = std::ranges::all_of(numbers, [](double n) { return std::isfinite(n); });
  if (!sound) usd_fail(path, property.line, "holds a number that is not finite");
}

std::vector<double> usd_numbers(const std::string& path, const UsdProperty& property,
                                std::optional<double> code) {
  const std::vector<double> numbers = numbers_at(property, code);
  check_numbers(path, property, numbers);
  return numbers;
}

std::vector<int> usd_integers(const std::string& path, const UsdProperty& property,
                              const std::string& name) {
  std::vector<int> values;
  for (const double number : usd_numbers(path, property)) {
    if (number != std::floor(number) || number < 0 || number > std::numeric_limits<int>::max()) {
      usd_fail(path, property.line, name + ": " + readable(number, 12) + " is no count");
    }
    values.push_back(static_cast<int>(number));
  }
  return values;
}

const UsdProperty& usd_needed(const std::string& path, const UsdPrim& prim,
                              const std::string& name) {
  const UsdProperty* property = usd_property(prim, name);
  if (!property) usd_fail(path, prim.line, prim.type + " '" + prim.name + "' has no " + name);
  return *property;
}

bool usd_is_word(const UsdPrim& prim, const std::string& name, const std::string& word) {
  const UsdProperty* property = usd_property(prim, name);
  return property && !property->value.words.empty() && property->value.words.front() == word;
}

}  // namespace mimetra
