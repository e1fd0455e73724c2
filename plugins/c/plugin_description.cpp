#include "plugins/c/plugin_description.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

#include "plugins/c/utf8.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// What every command takes besides what its operation declares.
constexpr std::array<std::string_view, 13> kTaken = {
    "h",    "help",     "q",       "quiet",  "v",     "verbose", "o",
    "json", "progress", "threads", "config", "force", "dry-run"};

/// Choices are typed in shells too: letters, digits, '-', '_' and '.'.
std::string choice_of(const char* choice, const std::string& what) {
  const std::string_view text = choice;
  const auto fits = [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) || c == '-' || c == '_' || c == '.');
  };
  if (text.empty() || text.front() == '-' || !std::ranges::all_of(text, fits)) {
    throw UsageError(what + " has the choice '" + (is_line(text) ? std::string(text) : "") +
                     "', expected letters, digits, '-', '_' and '.', not '-' first");
  }
  return std::string(text);
}

}  // namespace

std::string name_of(const char* name, const std::string& what) {
  const std::string_view text = name ? name : "";
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  };
  if (text.empty() || text.front() < 'a' || text.front() > 'z' ||
      !std::ranges::all_of(text, fits)) {
    throw UsageError(what + " has the name '" + (is_line(text) ? std::string(text) : "") +
                     "', expected small letters, digits and '-'");
  }
  return std::string(text);
}

std::string line_of(const char* text, const std::string& what) {
  const std::string_view line = text ? text : "";
  if (!is_line(line)) throw UsageError(what + ": its text is no line of UTF-8");
  return std::string(line);
}

Parameter parameter_of(const mimetra_parameter& described) {
  Parameter parameter{name_of(described.name, "a parameter"), ParameterKind::flag, {}, ""};
  const std::string what = "parameter '" + parameter.name + "'";
  if (described.kind < MIMETRA_FLAG || described.kind > MIMETRA_FILE) {
    throw UsageError(what + ": the kind " + std::to_string(described.kind) +
                     " is none of mimetra.h");
  }
  parameter.kind = static_cast<ParameterKind>(described.kind - MIMETRA_FLAG);
  parameter.help = line_of(described.help, what);
  parameter.unit = line_of(described.unit, what);
  if (described.minimum < described.maximum) {
    if (std::isfinite(described.minimum)) parameter.minimum = described.minimum;
    if (std::isfinite(described.maximum)) parameter.maximum = described.maximum;
  }
  const bool is_whole =
      parameter.kind == ParameterKind::integer || parameter.kind == ParameterKind::integer_list;
  if (is_whole) {
    constexpr double kMost = std::numeric_limits<std::int32_t>::max();
    if (parameter.minimum) parameter.minimum = std::clamp(*parameter.minimum, -kMost, kMost);
    if (parameter.maximum) parameter.maximum = std::clamp(*parameter.maximum, -kMost, kMost);
  }
  for (const char* const* choice = described.choices; choice && *choice; ++choice) {
    parameter.choices.push_back(choice_of(*choice, what));
    if (std::ranges::count(parameter.choices, parameter.choices.back()) > 1) {
      throw UsageError(what + " has the choice '" + *choice + "' twice");
    }
  }
  if (parameter.kind == ParameterKind::choice && parameter.choices.empty()) {
    throw UsageError(what + " has no choices");
  }
  if (described.fallback) {
    parameter.fallback = parse_value(parameter, line_of(described.fallback, what));
  } else if (parameter.kind == ParameterKind::flag) {
    parameter.fallback = false;
  }
  return parameter;
}

void check_not_taken(const std::string& name) {
  if (std::ranges::find(kTaken, name) == kTaken.end()) return;
  throw UsageError("the name '" + name + "' is an option of every command");
}

}  // namespace mimetra
