#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "toolkit/mesh/option.h"

namespace mimetra {

/// The request is wrong whatever the data: an unknown name, a value out of range.
class UsageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A parameter's value; monostate if it has neither a value nor a default.
using ParameterValue = std::variant<std::monostate, bool, std::int64_t, double, std::string,
                                    std::vector<std::int64_t>>;

enum class ParameterKind {
  flag,          ///< bool
  integer,       ///< std::int64_t
  integer_list,  ///< std::vector<std::int64_t>, "10,30,40"
  number,        ///< double
  length,        ///< std::string: "0.1" of the rest pose's diameter, or "12abs"
  choice,        ///< std::string, one of `choices`
  text,          ///< std::string
  file  ///< std::string, a path or one of `choices`; the choice "group:NAME" allows any "group:..."
};

/// One parameter of an operation, from which hosts make option parser, help and dialogs.
struct Parameter {
  std::string name;  ///< "radius" is --radius, "k" is -k
  ParameterKind kind;
  ParameterValue fallback;  ///< the default
  std::string help;         ///< one line
  std::string unit = "";
  std::optional<double> minimum = {};
  std::optional<double> maximum = {};
  std::vector<std::string> choices = {};
  bool several = false;  ///< for a file: several paths, or `choices`, separated by commas
  /// Heading in the help; empty for the parameters of the operation's own subject.
  std::string group = "";
  /// Text of the short help, instead of `help`. If it is empty, parameters under a heading show
  /// only their names.
  std::string brief = "";

  /// `--radius` or `-k`.
  std::string option() const;
  /// Ends of the range as text, whole numbers for integers; empty if there is no limit.
  std::string minimum_text() const;
  std::string maximum_text() const;
};

/// True if `text` is a word that may replace a path; "group:NAME" matches any "group:...".
bool is_word(const Parameter& parameter, const std::string& text);

/// Declares a choice among the values of an enum.
template <NamedChoice Enum>
Parameter choice_parameter(std::string name, Enum fallback, std::string help) {
  return {std::move(name),
          ParameterKind::choice,
          std::string(choice_name(fallback)),
          std::move(help),
          "",
          {},
          {},
          choice_names<Enum>()};
}

/// Declares a parameter that takes a path or one of the values of an enum.
template <NamedChoice Enum>
Parameter file_parameter(std::string name, std::optional<Enum> fallback, std::string help) {
  ParameterValue value;
  if (fallback) value = std::string(choice_name(*fallback));
  return {std::move(name),     ParameterKind::file, std::move(value), std::move(help), "", {}, {},
          choice_names<Enum>()};
}

/// Parses a value. Throws UsageError that gives the option, the range and the text found.
ParameterValue parse_value(const Parameter& parameter, const std::string& text);

/// Checks a value's type and range. Throws UsageError.
void check_value(const Parameter& parameter, const ParameterValue& value);

/// Converts a value to the text that parse_value() reads; empty for no value.
std::string to_text(const ParameterValue& value);
std::string to_text(const Length& length);

/// Values by name, with defaults for values that were not set.
class Parameters {
 public:
  explicit Parameters(std::vector<Parameter> declared = {});

  /// Throws UsageError for an unknown name, a wrong type or a value out of range.
  void set(const std::string& name, ParameterValue value);

  const std::vector<Parameter>& declared() const { return declared_; }
  const Parameter* find(const std::string& name) const;
  /// True if a value was set, rather than taken from the default.
  bool is_set(const std::string& name) const { return values_.contains(name); }
  /// The paths that were set, without words that replace a path.
  std::vector<std::string> files() const;
  /// The paths of one parameter; empty if none is set.
  std::vector<std::string> paths(const std::string& name) const;
  /// The items between commas, or of the default: paths, and words that replace a path.
  std::vector<std::string> listed(const std::string& name) const;
  const ParameterValue& value(const std::string& name) const;

  bool flag(const std::string& name) const { return std::get<bool>(value(name)); }
  int integer(const std::string& name) const;
  double number(const std::string& name) const { return std::get<double>(value(name)); }
  const std::string& text(const std::string& name) const;
  const std::vector<std::int64_t>& integers(const std::string& name) const;
  std::optional<std::string> optional_text(const std::string& name) const;
  /// Value of choice_parameter(). Throws std::invalid_argument if the enum does not have it.
  template <NamedChoice Enum>
  Enum choice(const std::string& name) const {
    if (const auto value = choice_of<Enum>(text(name))) return *value;
    throw std::invalid_argument("parameter '" + name + "': no such choice as '" + text(name) + "'");
  }
  Length length(const std::string& name) const;
  /// Converts "4G" or "500M" to bytes; empty if no value is given. The units k, M, G and T are
  /// powers of 1000, and KiB to TiB are powers of 1024, in large or small letters. Throws
  /// UsageError for any other text, and for a number below a million without a unit.
  std::optional<double> bytes(const std::string& name) const;

 private:
  std::vector<Parameter> declared_;
  std::map<std::string, ParameterValue> values_;
};

/// Options, inputs and outputs of an operation that exclude each other:
///
///     {{"falloff", "regions-out"}, {"full"}, "there are no regions with --full"}
///
/// A term is the name of an input, an output or an option. It holds if the call has the input or
/// requests the output. It also holds for a flag that is true, a list of files with a path, and any
/// other option that is set. NAME=VALUE holds if the option has this value, also by default. A "!"
/// negates a term.
struct Exclusion {
  /// None of these terms may hold
  std::vector<std::string> refused;
  /// together with one of these. "curve !per-region" holds if both parts do.
  std::vector<std::string> beside;
  std::string reason;
};

/// Whether a call has an input, or requests an output, of this name.
using HasValue = std::function<bool(const std::string& name)>;

/// Message for the first term that is refused, "--falloff: there are no regions with --full"; empty
/// if nothing is refused.
std::optional<std::string> refusal(const std::vector<Exclusion>& exclusions,
                                   const Parameters& parameters, const HasValue& has_value);

/// Concatenates lists.
template <typename Element>
std::vector<Element> concatenated(std::initializer_list<std::vector<Element>> lists) {
  std::vector<Element> all;
  for (const std::vector<Element>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace mimetra
