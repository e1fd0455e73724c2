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

/// The request is wrong whatever the data: an unknown name, a value out of its range.
class UsageError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A parameter's value; monostate where none was given and there is no default.
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
  file  ///< std::string, a path, or one of `choices`; "group:NAME" stands for all "group:..."
};

/// One parameter of an operation: what option parser, help, and the dialogs of hosts are made of.
struct Parameter {
  std::string name;  ///< "radius" is --radius, "k" is -k
  ParameterKind kind;
  ParameterValue fallback;  ///< the default
  std::string help;         ///< one line
  std::string unit = "";
  std::optional<double> minimum = {};
  std::optional<double> maximum = {};
  std::vector<std::string> choices = {};
  bool several = false;  ///< of a file: several paths, or `choices`, between commas
  /// Heading under which help lists it; none for what its operation is about.
  std::string group = "";
  /// What the short help says instead of `help`; of those under a heading it tells the names only
  /// where this is empty.
  std::string brief = "";

  /// `--radius` or `-k`.
  std::string option() const;
  /// The ends of the range as people type them, whole for whole numbers; empty where it is open.
  std::string minimum_text() const;
  std::string maximum_text() const;
};

/// True for one of the words that stand beside paths; "group:NAME" is where "group:..." is.
bool is_word(const Parameter& parameter, const std::string& text);

/// A choice among the values of an enum.
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

/// A path, or one of the values of an enum.
template <NamedChoice Enum>
Parameter file_parameter(std::string name, std::optional<Enum> fallback, std::string help) {
  ParameterValue value;
  if (fallback) value = std::string(choice_name(*fallback));
  return {std::move(name),     ParameterKind::file, std::move(value), std::move(help), "", {}, {},
          choice_names<Enum>()};
}

/// Reads a value as people type it. Throws UsageError that names option, range and what was found.
ParameterValue parse_value(const Parameter& parameter, const std::string& text);

/// Checks a value's type and range. Throws UsageError.
void check_value(const Parameter& parameter, const ParameterValue& value);

/// A value as people type it; empty for none.
std::string to_text(const ParameterValue& value);
std::string to_text(const Length& length);

/// Values by name, with the defaults of those that were not set.
class Parameters {
 public:
  explicit Parameters(std::vector<Parameter> declared = {});

  /// Throws UsageError for an unknown name, a wrong type or a value out of range.
  void set(const std::string& name, ParameterValue value);

  const std::vector<Parameter>& declared() const { return declared_; }
  const Parameter* find(const std::string& name) const;
  /// True where a value was set, as against the default.
  bool is_set(const std::string& name) const { return values_.contains(name); }
  /// The paths that were set, without the words that stand beside paths.
  std::vector<std::string> files() const;
  /// Those of one parameter of files; none where none is set.
  std::vector<std::string> paths(const std::string& name) const;
  /// What stands between commas, or by default there: paths, and words that stand beside them.
  std::vector<std::string> listed(const std::string& name) const;
  const ParameterValue& value(const std::string& name) const;

  bool flag(const std::string& name) const { return std::get<bool>(value(name)); }
  int integer(const std::string& name) const;
  double number(const std::string& name) const { return std::get<double>(value(name)); }
  const std::string& text(const std::string& name) const;
  const std::vector<std::int64_t>& integers(const std::string& name) const;
  std::optional<std::string> optional_text(const std::string& name) const;
  /// A value of choice_parameter(). Throws std::invalid_argument where it is not one of the enum's.
  template <NamedChoice Enum>
  Enum choice(const std::string& name) const {
    if (const auto value = choice_of<Enum>(text(name))) return *value;
    throw std::invalid_argument("parameter '" + name + "': no such choice as '" + text(name) + "'");
  }
  Length length(const std::string& name) const;
  /// "4G" or "500M" in bytes (k, M, G and T are powers of 1000, KiB to TiB of 1024, large and small
  /// letters alike); nothing where none is given. Throws UsageError for any other text, and for a
  /// number below a million without a unit.
  std::optional<double> bytes(const std::string& name) const;

 private:
  std::vector<Parameter> declared_;
  std::map<std::string, ParameterValue> values_;
};

/// Options, inputs and outputs of an operation that do not go together:
///
///     {{"falloff", "regions-out"}, {"full"}, "there are no regions with --full"}
///
/// A term is the name of an input, an output or an option. It holds if the call has it: an output
/// that is asked for, a flag that is true, a list of files that names one, any other option that is
/// set. NAME=VALUE holds if the option has this value, also by default. A "!" negates a term.
struct Exclusion {
  /// None of these may hold
  std::vector<std::string> refused;
  /// beside one of these. "curve !per-region" holds if both parts do.
  std::vector<std::string> beside;
  std::string reason;
};

/// Whether a call has an input, or asks for an output, of this name.
using HasValue = std::function<bool(const std::string& name)>;

/// The message for the first term that is refused, "--falloff: there are no regions with --full";
/// none if all that the call has goes together.
std::optional<std::string> refusal(const std::vector<Exclusion>& exclusions,
                                   const Parameters& parameters, const HasValue& has_value);

/// All elements of some lists, in order.
template <typename Element>
std::vector<Element> concatenated(std::initializer_list<std::vector<Element>> lists) {
  std::vector<Element> all;
  for (const std::vector<Element>& list : lists) all.insert(all.end(), list.begin(), list.end());
  return all;
}

}  // namespace mimetra
