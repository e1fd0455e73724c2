#include "toolkit/mesh/parameter.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <sstream>

namespace mimetra {

namespace {

/// Splits a text at commas: "a," gives "a" and ""; "" gives an empty list.
std::vector<std::string> between_commas(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; !text.empty() && begin <= text.size();) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    parts.push_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  return parts;
}

std::string shortest(double number) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, number);
  return error == std::errc() ? std::string(buffer, end) : std::to_string(number);
}

/// Text of a bound. `inwards` rounds it for whole numbers: std::ceil for a minimum, std::floor for
/// a maximum.
std::string bound_text(ParameterKind kind, const std::optional<double>& bound,
                       double (*inwards)(double)) {
  if (!bound) return "";
  const bool whole = kind == ParameterKind::integer || kind == ParameterKind::integer_list;
  if (!whole) return shortest(*bound);
  // Whole numbers have 32 bits, whatever their range.
  return std::to_string(std::lround(std::clamp<double>(inwards(*bound), -INT32_MAX, INT32_MAX)));
}

std::string range_text(const Parameter& parameter) {
  const std::string minimum = parameter.minimum_text(), maximum = parameter.maximum_text();
  if (parameter.minimum && parameter.maximum) return "from " + minimum + " to " + maximum;
  if (parameter.minimum) return "of at least " + minimum;
  if (parameter.maximum) return "of at most " + maximum;
  return "";
}

template <typename Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return number;
}

/// Parses a number, or a fraction such as 24000/1001.
std::optional<double> parse_ratio(std::string_view text) {
  const auto slash = text.find('/');
  const auto number = parse_number<double>(text.substr(0, slash));
  if (!number || slash == std::string_view::npos) return number;
  const auto divisor = parse_number<double>(text.substr(slash + 1));
  if (!divisor || *divisor == 0) return {};
  return *number / *divisor;
}

/// Hint "; 80 % is 0.8" if the user probably meant a share in percent, otherwise "".
std::string percent_hint(const Parameter& parameter, std::string_view found) {
  const bool is_share = parameter.kind == ParameterKind::number && parameter.maximum == 1;
  if (!is_share && parameter.kind != ParameterKind::length) return "";
  const bool is_percent = found.ends_with('%');
  if (is_percent) found.remove_suffix(1);
  // A length of 12 may lack its unit.
  if (!is_share && !is_percent) return "";
  constexpr double kPercent = 100;
  const auto number = parse_number<double>(found);
  if (!number || !(*number > (is_percent ? 0 : 1) && *number <= kPercent)) return "";
  return "; " + shortest(*number) + " % is " + shortest(*number / kPercent);
}

[[noreturn]] void refuse(const Parameter& parameter, const std::string& expected,
                         const std::string& found) {
  throw UsageError(parameter.option() + ": expected " + expected + ", found '" + found + "'" +
                   percent_hint(parameter, found));
}

std::string expected_text(const Parameter& parameter) {
  const std::string range = range_text(parameter);
  const std::string suffix = range.empty() ? "" : " " + range;
  switch (parameter.kind) {
    case ParameterKind::flag:
      return "true or false";
    case ParameterKind::integer:
      return "a whole number" + suffix;
    case ParameterKind::integer_list:
      return "whole numbers" + suffix + ", as in 10,30,40";
    case ParameterKind::number:
      return "a number" + suffix;
    case ParameterKind::length:
      return "a share of the diameter, up to 1, as in 0.1, or a length as in 12abs" +
             (range.empty() ? range : ", " + range);
    case ParameterKind::choice: {
      std::string list;
      for (const std::string& choice : parameter.choices) {
        list += (list.empty() ? "" : ", ") + choice;
      }
      return "one of " + list;
    }
    case ParameterKind::text:
      return "text";
    case ParameterKind::file:
      return parameter.several ? "names between commas" : "text";
  }
  return "";
}

std::vector<std::int64_t> parse_list(const Parameter& parameter, const std::string& text) {
  std::vector<std::int64_t> list;
  std::istringstream stream(text);
  for (std::string entry; std::getline(stream, entry, ',');) {
    const auto number = parse_number<std::int64_t>(entry);
    if (!number) refuse(parameter, expected_text(parameter), text);
    list.push_back(*number);
  }
  if (list.empty()) refuse(parameter, expected_text(parameter), text);
  return list;
}

constexpr std::string_view kAbsolute = "abs";

std::optional<Length> parse_length(std::string_view text) {
  const bool absolute = text.ends_with(kAbsolute);
  if (absolute) text.remove_suffix(kAbsolute.size());
  const auto number = parse_number<double>(text);
  if (!number || !std::isfinite(*number) || *number < 0) return {};
  if (!absolute && *number > Length::kLargestShare) return {};
  return Length{*number, absolute};
}

bool in_range(const Parameter& parameter, double number) {
  return std::isfinite(number) && (!parameter.minimum || number >= *parameter.minimum) &&
         (!parameter.maximum || number <= *parameter.maximum);
}

bool is_sound(const Parameter& parameter, const ParameterValue& value) {
  switch (parameter.kind) {
    case ParameterKind::flag:
      return std::holds_alternative<bool>(value);
    case ParameterKind::integer: {
      const auto* number = std::get_if<std::int64_t>(&value);
      return number && std::abs(*number) <= INT32_MAX &&
             in_range(parameter, static_cast<double>(*number));
    }
    case ParameterKind::integer_list: {
      const auto* list = std::get_if<std::vector<std::int64_t>>(&value);
      return list && !list->empty() && std::ranges::all_of(*list, [&](std::int64_t number) {
               return std::abs(number) <= INT32_MAX &&
                      in_range(parameter, static_cast<double>(number));
             });
    }
    case ParameterKind::number: {
      const auto* number = std::get_if<double>(&value);
      return number && in_range(parameter, *number);
    }
    case ParameterKind::length: {
      const auto* text = std::get_if<std::string>(&value);
      const auto length = text ? parse_length(*text) : std::nullopt;
      return length && in_range(parameter, length->value);
    }
    case ParameterKind::choice: {
      const auto* text = std::get_if<std::string>(&value);
      return text && std::ranges::find(parameter.choices, *text) != parameter.choices.end();
    }
    case ParameterKind::text:
      return std::holds_alternative<std::string>(value);
    case ParameterKind::file: {
      const auto* text = std::get_if<std::string>(&value);
      const bool is_list = text && parameter.several;
      return text && (!is_list || std::ranges::none_of(between_commas(*text), &std::string::empty));
    }
  }
  return false;
}

}  // namespace

bool is_word(const Parameter& parameter, const std::string& text) {
  return std::ranges::any_of(parameter.choices, [&text](const std::string& word) {
    const std::size_t colon = word.find(':');
    return colon == std::string::npos ? word == text : text.starts_with(word.substr(0, colon + 1));
  });
}

std::string Parameter::option() const {
  return (name.size() == 1 ? "-" : "--") + name;
}

std::string Parameter::minimum_text() const {
  return bound_text(kind, minimum, std::ceil);
}

std::string Parameter::maximum_text() const {
  return bound_text(kind, maximum, std::floor);
}

ParameterValue parse_value(const Parameter& parameter, const std::string& text) {
  ParameterValue value = text;
  switch (parameter.kind) {
    case ParameterKind::flag:
      if (text != "true" && text != "false") refuse(parameter, expected_text(parameter), text);
      value = text == "true";
      break;
    case ParameterKind::integer: {
      const auto number = parse_number<std::int64_t>(text);
      if (!number) refuse(parameter, expected_text(parameter), text);
      value = *number;
      break;
    }
    case ParameterKind::integer_list:
      value = parse_list(parameter, text);
      break;
    case ParameterKind::number: {
      const auto number = parse_ratio(text);
      if (!number) refuse(parameter, expected_text(parameter), text);
      value = *number;
      break;
    }
    default:
      break;
  }
  check_value(parameter, value);
  return value;
}

void check_value(const Parameter& parameter, const ParameterValue& value) {
  if (!is_sound(parameter, value)) refuse(parameter, expected_text(parameter), to_text(value));
}

std::string to_text(const ParameterValue& value) {
  struct Visitor {
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(double number) const { return shortest(number); }
    std::string operator()(const std::string& text) const { return text; }
    std::string operator()(const std::vector<std::int64_t>& list) const {
      std::string text;
      for (const std::int64_t number : list) {
        text += (text.empty() ? "" : ",") + std::to_string(number);
      }
      return text;
    }
  };
  return std::visit(Visitor{}, value);
}

std::string to_text(const Length& length) {
  return shortest(length.value) + std::string(length.absolute ? kAbsolute : "");
}

Parameters::Parameters(std::vector<Parameter> declared) : declared_(std::move(declared)) {}

const Parameter* Parameters::find(const std::string& name) const {
  const auto found = std::ranges::find(declared_, name, &Parameter::name);
  return found == declared_.end() ? nullptr : &*found;
}

void Parameters::set(const std::string& name, ParameterValue value) {
  const Parameter* parameter = find(name);
  if (!parameter) throw UsageError("there is no parameter '" + name + "'");
  const auto* number = std::get_if<std::int64_t>(&value);
  if (number && parameter->kind == ParameterKind::number) value = static_cast<double>(*number);
  check_value(*parameter, value);
  values_[name] = std::move(value);
}

const ParameterValue& Parameters::value(const std::string& name) const {
  const auto found = values_.find(name);
  if (found != values_.end()) return found->second;
  const Parameter* parameter = find(name);
  if (!parameter) throw UsageError("there is no parameter '" + name + "'");
  return parameter->fallback;
}

std::vector<std::string> Parameters::files() const {
  std::vector<std::string> paths;
  for (const auto& [name, value] : values_) {
    const Parameter& parameter = *find(name);
    if (parameter.kind != ParameterKind::file) continue;
    const std::vector<std::string> several = this->paths(name);
    paths.insert(paths.end(), several.begin(), several.end());
  }
  return paths;
}

std::vector<std::string> Parameters::paths(const std::string& name) const {
  std::vector<std::string> paths = listed(name);
  std::erase_if(paths, [&](const std::string& text) { return is_word(*find(name), text); });
  return paths;
}

std::vector<std::string> Parameters::listed(const std::string& name) const {
  const auto text = optional_text(name);
  if (!text) return {};
  return find(name)->several ? between_commas(*text) : std::vector<std::string>{*text};
}

int Parameters::integer(const std::string& name) const {
  return static_cast<int>(std::get<std::int64_t>(value(name)));
}

const std::string& Parameters::text(const std::string& name) const {
  return std::get<std::string>(value(name));
}

const std::vector<std::int64_t>& Parameters::integers(const std::string& name) const {
  return std::get<std::vector<std::int64_t>>(value(name));
}

std::optional<std::string> Parameters::optional_text(const std::string& name) const {
  const auto* text = std::get_if<std::string>(&value(name));
  return text ? std::optional(*text) : std::nullopt;
}

std::optional<double> Parameters::bytes(const std::string& name) const {
  const auto given = optional_text(name);
  if (!given) return {};
  constexpr std::string_view kUnits = "kmgt";
  std::string_view text = *given;
  const auto stripped = [&text](std::string_view letters) {
    const auto place = text.empty() ? letters.npos
                                    : letters.find(static_cast<char>(
                                          std::tolower(static_cast<unsigned char>(text.back()))));
    if (place != letters.npos) text.remove_suffix(1);
    return place;
  };
  const bool is_named = stripped("b") == 0, is_binary = is_named && stripped("i") == 0;
  const auto unit = stripped(kUnits);
  const double power = unit == kUnits.npos ? 0 : static_cast<double>(unit + 1);
  const auto number = parse_number<double>(text);
  // Fewer bytes are probably a missing unit.
  constexpr double kLeastWithoutUnit = 1e6;
  const double bytes = number ? *number * std::pow(is_binary ? 1024 : 1000, power) : 0;
  const bool has_unit = power > 0 || (!is_binary && bytes >= kLeastWithoutUnit);
  if (has_unit && bytes > 0 && std::isfinite(bytes)) return bytes;
  throw UsageError("--" + name +
                   ": expected a number with the unit k, M, G or T, such as 4G, found '" + *given +
                   "'");
}

Length Parameters::length(const std::string& name) const {
  return *parse_length(text(name));
}

namespace {

/// Parts of a term "!NAME=VALUE".
struct Term {
  bool is_negated;
  std::string name;
  std::string value;  ///< may be empty

  explicit Term(const std::string& text) : is_negated(text.front() == '!') {
    const std::size_t begin = is_negated ? 1 : 0, equals = std::min(text.find('='), text.size());
    name = text.substr(begin, equals - begin);
    if (equals < text.size()) value = text.substr(equals + 1);
  }

  /// Spelling on the command line: "--select transfer", "-k".
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
