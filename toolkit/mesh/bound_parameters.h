#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "toolkit/mesh/option.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {

struct FieldSequence;

/// Maps the type of an option struct's member to a parameter of kind kKind. `value` converts a
/// member to a parameter's value, and `read` returns the value of a call. Types without a kind
/// cannot be parameters.
template <typename Value>
struct ParameterType {};

template <NamedChoice Enum>
struct ParameterType<Enum> {
  static constexpr ParameterKind kKind = ParameterKind::choice;
  static ParameterValue value(Enum choice) { return std::string(choice_name(choice)); }
  static Enum read(const Parameters& parameters, const std::string& name) {
    return parameters.choice<Enum>(name);
  }
};

template <>
struct ParameterType<bool> {
  static constexpr ParameterKind kKind = ParameterKind::flag;
  static ParameterValue value(bool flag) { return flag; }
  static bool read(const Parameters& parameters, const std::string& name) {
    return parameters.flag(name);
  }
};

template <>
struct ParameterType<int> {
  static constexpr ParameterKind kKind = ParameterKind::integer;
  static ParameterValue value(int number) { return std::int64_t{number}; }
  static int read(const Parameters& parameters, const std::string& name) {
    return parameters.integer(name);
  }
};

template <>
struct ParameterType<double> {
  static constexpr ParameterKind kKind = ParameterKind::number;
  static ParameterValue value(double number) { return number; }
  static double read(const Parameters& parameters, const std::string& name) {
    return parameters.number(name);
  }
};

template <>
struct ParameterType<Length> {
  static constexpr ParameterKind kKind = ParameterKind::length;
  static ParameterValue value(const Length& length) { return to_text(length); }
  static Length read(const Parameters& parameters, const std::string& name) {
    return parameters.length(name);
  }
};

/// An empty list is stored as no value.
template <>
struct ParameterType<std::vector<int>> {
  static constexpr ParameterKind kKind = ParameterKind::integer_list;
  static ParameterValue value(const std::vector<int>& list) {
    if (list.empty()) return {};
    return std::vector<std::int64_t>(list.begin(), list.end());
  }
  static std::vector<int> read(const Parameters& parameters, const std::string& name) {
    const auto* list = std::get_if<std::vector<std::int64_t>>(&parameters.value(name));
    return list ? std::vector<int>(list->begin(), list->end()) : std::vector<int>();
  }
};

/// An empty text is stored as no value.
template <>
struct ParameterType<std::string> {
  static constexpr ParameterKind kKind = ParameterKind::text;
  static ParameterValue value(const std::string& text) {
    return text.empty() ? ParameterValue() : ParameterValue(text);
  }
  static std::string read(const Parameters& parameters, const std::string& name) {
    return parameters.optional_text(name).value_or("");
  }
};

template <>
struct ParameterType<std::filesystem::path> {
  static constexpr ParameterKind kKind = ParameterKind::file;
  static ParameterValue value(const std::filesystem::path& path) { return path.string(); }
  static std::filesystem::path read(const Parameters& parameters, const std::string& name) {
    return parameters.text(name);
  }
};

/// Type of a member that can be a parameter. Enums need names for their values.
template <typename Value>
concept ParameterMember = requires {
  ParameterType<Value>::kKind;
};

/// All of these types except enums, which always have a value.
template <typename Value>
concept OptionalMember = ParameterMember<Value> && !NamedChoice<Value>;

/// Reads an empty optional if no value is given.
template <OptionalMember Value>
struct ParameterType<std::optional<Value>> {
  static constexpr ParameterKind kKind = ParameterType<Value>::kKind;
  static ParameterValue value(const std::optional<Value>& held) {
    return held ? ParameterType<Value>::value(*held) : ParameterValue();
  }
  static std::optional<Value> read(const Parameters& parameters, const std::string& name) {
    if (std::holds_alternative<std::monostate>(parameters.value(name))) return {};
    return ParameterType<Value>::read(parameters, name);
  }
};

/// Parameters of an operation, each bound to a member of an options struct. The member gives the
/// default, range and unit. One list declares and reads the parameters.
template <typename Options>
class BoundParameters {
 public:
  /// Copies a parameter's value into the struct. Files that the parameter names must fit the
  /// sequence. Without a sequence, files are not read and their contents stay empty.
  using Apply = std::function<void(const Parameters&, Options&, const FieldSequence*)>;
  struct Entry {
    Parameter parameter;
    Apply apply;
  };

  /// `defaults` become the defaults of the parameters.
  explicit BoundParameters(Options defaults = {}) : defaults_(std::move(defaults)) {}

  template <ParameterMember Value>
  BoundParameters& add(const std::string& name, const Option<Options, Value>& option,
                       std::string help) {
    Parameter parameter = declaration<Value>(name, option, std::move(help));
    if constexpr (NamedChoice<Value>) parameter.choices = choice_names<Value>();
    return add(std::move(parameter),
               [name, member = option.member](const Parameters& parameters, Options& options) {
                 options.*member = ParameterType<Value>::read(parameters, name);
               });
  }

  /// Adds a flag with the opposite meaning of its member.
  BoundParameters& add_opposite(const std::string& name, const Option<Options, bool>& option,
                                std::string help) {
    Parameter parameter = declaration<bool>(name, option, std::move(help));
    parameter.fallback = !(defaults_.*option.member);
    return add(std::move(parameter),
               [name, member = option.member](const Parameters& parameters, Options& options) {
                 options.*member = !parameters.flag(name);
               });
  }

  /// Adds a parameter that takes an enum's value or a file, from which `read` makes a value. The
  /// member is a variant of both, or an optional variant.
  template <NamedChoice Word, typename Value, typename Member>
  BoundParameters& add_word_or_file(
      const std::string& name, const Option<Options, Member>& option, std::string help,
      std::function<Value(const std::string&, const FieldSequence*)> read) {
    Parameter parameter =
        file_parameter<Word>(name, word_of<Word>(defaults_.*option.member), std::move(help));
    return add(std::move(parameter),
               [name, member = option.member, read = std::move(read)](
                   const Parameters& parameters, Options& options, const FieldSequence* sequence) {
                 const auto text = parameters.optional_text(name);
                 if (!text) return;
                 if (const auto word = choice_of<Word>(*text)) {
                   options.*member = *word;
                 } else {
                   options.*member = read(*text, sequence);
                 }
               });
  }

  /// Adds the parameters of a part of the struct, in their order.
  template <typename Part>
  BoundParameters& add(Part Options::*member, const BoundParameters<Part>& part) {
    for (const auto& entry : part.entries()) {
      add(entry.parameter,
          [member, apply = entry.apply](const Parameters& parameters, Options& options,
                                        const FieldSequence* sequence) {
            apply(parameters, options.*member, sequence);
          });
    }
    return *this;
  }

  /// Appends the parameters of another list.
  BoundParameters& add(const BoundParameters& more) {
    entries_.insert(entries_.end(), more.entries_.begin(), more.entries_.end());
    return *this;
  }

  /// Adds a parameter that differs from its member. `apply` reads it, and may omit the sequence.
  template <typename Function>
  BoundParameters& add(Parameter parameter, Function apply) {
    if constexpr (std::is_convertible_v<Function, Apply>) {
      entries_.push_back({std::move(parameter), std::move(apply)});
    } else {
      entries_.push_back(
          {std::move(parameter),
           [apply = std::move(apply)](const Parameters& parameters, Options& options,
                                      const FieldSequence*) { apply(parameters, options); }});
    }
    return *this;
  }

  /// Puts all parameters without a heading under this heading of the help.
  BoundParameters& under(const std::string& group) {
    for (Entry& entry : entries_) {
      if (entry.parameter.group.empty()) entry.parameter.group = group;
    }
    return *this;
  }

  /// Sets the short help of the last parameter.
  BoundParameters& brief(const std::string& text) {
    entries_.back().parameter.brief = text;
    return *this;
  }

  std::vector<Parameter> declared() const {
    std::vector<Parameter> parameters;
    for (const Entry& entry : entries_) parameters.push_back(entry.parameter);
    return parameters;
  }

  /// Returns the struct with the values of a call; `sequence` as for Apply.
  Options read(const Parameters& parameters, const FieldSequence* sequence = nullptr) const {
    Options options = defaults_;
    for (const Entry& entry : entries_) entry.apply(parameters, options, sequence);
    return options;
  }

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  template <typename Value>
  Parameter declaration(const std::string& name, const Option<Options, Value>& option,
                        std::string help) const {
    return {name,
            ParameterType<Value>::kKind,
            ParameterType<Value>::value(defaults_.*option.member),
            std::move(help),
            std::string(option.unit),
            option.range.minimum,
            option.range.maximum};
  }

  template <typename Word, typename Value>
  static std::optional<Word> word_of(const std::variant<Word, Value>& value) {
    const Word* word = std::get_if<Word>(&value);
    return word ? std::optional(*word) : std::nullopt;
  }
  template <typename Word, typename Value>
  static std::optional<Word> word_of(const std::optional<std::variant<Word, Value>>& value) {
    return value ? word_of<Word>(*value) : std::nullopt;
  }

  Options defaults_;
  std::vector<Entry> entries_;
};

}  // namespace mimetra
