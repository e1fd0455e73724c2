#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "toolkit/mesh/option.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {

/// How a member of an option struct is typed in and shown.
template <typename Value>
constexpr ParameterKind parameter_kind() {
  if constexpr (NamedChoice<Value>) {
    return ParameterKind::choice;
  } else if constexpr (std::is_same_v<Value, bool>) {
    return ParameterKind::flag;
  } else if constexpr (std::is_same_v<Value, int>) {
    return ParameterKind::integer;
  } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
    return ParameterKind::integer_list;
  } else if constexpr (std::is_same_v<Value, Length>) {
    return ParameterKind::length;
  } else {
    static_assert(std::is_same_v<Value, double> || std::is_same_v<Value, std::optional<double>>);
    return ParameterKind::number;
  }
}

template <typename Value>
ParameterValue parameter_value(const Value& value) {
  if constexpr (NamedChoice<Value>) {
    return std::string(choice_name(value));
  } else if constexpr (std::is_same_v<Value, int>) {
    return std::int64_t{value};
  } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
    return std::vector<std::int64_t>(value.begin(), value.end());
  } else if constexpr (std::is_same_v<Value, Length>) {
    return to_text(value);
  } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
    return value ? ParameterValue(*value) : ParameterValue();
  } else {
    return value;
  }
}

template <typename Value>
Value option_value(const Parameters& parameters, const std::string& name) {
  if constexpr (NamedChoice<Value>) {
    return parameters.choice<Value>(name);
  } else if constexpr (std::is_same_v<Value, bool>) {
    return parameters.flag(name);
  } else if constexpr (std::is_same_v<Value, int>) {
    return parameters.integer(name);
  } else if constexpr (std::is_same_v<Value, std::vector<int>>) {
    const auto& list = parameters.integers(name);
    return {list.begin(), list.end()};
  } else if constexpr (std::is_same_v<Value, Length>) {
    return parameters.length(name);
  } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
    return parameters.optional_number(name);
  } else {
    return parameters.number(name);
  }
}

/// Parameters of an operation, each bound to a member of a struct of options, whose default, range
/// and unit it has. What is declared and what is read is one list.
template <typename Options>
class BoundParameters {
 public:
  /// How a parameter's value comes into the struct.
  using Apply = std::function<void(const Parameters&, Options&)>;
  struct Entry {
    Parameter parameter;
    Apply apply;
  };

  /// `defaults` are those of the parameters.
  explicit BoundParameters(Options defaults = {}) : defaults_(std::move(defaults)) {}

  template <typename Value>
  BoundParameters& add(const std::string& name, const Option<Options, Value>& option,
                       std::string help) {
    Parameter parameter = declaration<Value>(name, option, std::move(help));
    if constexpr (NamedChoice<Value>) parameter.choices = choice_names<Value>();
    return add(std::move(parameter),
               [name, member = option.member](const Parameters& parameters, Options& options) {
                 options.*member = option_value<Value>(parameters, name);
               });
  }

  /// A flag that says the opposite of its member.
  BoundParameters& add_opposite(const std::string& name, const Option<Options, bool>& option,
                                std::string help) {
    Parameter parameter = declaration<bool>(name, option, std::move(help));
    parameter.fallback = !(defaults_.*option.member);
    return add(std::move(parameter),
               [name, member = option.member](const Parameters& parameters, Options& options) {
                 options.*member = !parameters.flag(name);
               });
  }

  /// One of the values of an enum, or a file, of which `read` makes a value. The member is a
  /// variant of both, or an optional one.
  template <NamedChoice Word, typename Value, typename Member>
  BoundParameters& add_word_or_file(const std::string& name, const Option<Options, Member>& option,
                                    std::string help,
                                    std::function<Value(const std::string&)> read) {
    Parameter parameter =
        file_parameter<Word>(name, word_of<Word>(defaults_.*option.member), std::move(help));
    return add(std::move(parameter), [name, member = option.member, read = std::move(read)](
                                         const Parameters& parameters, Options& options) {
      const auto text = parameters.optional_text(name);
      if (!text) return;
      if (const auto word = choice_of<Word>(*text)) {
        options.*member = *word;
      } else {
        options.*member = read(*text);
      }
    });
  }

  /// The parameters of a part of the struct, in their order.
  template <typename Part>
  BoundParameters& add(Part Options::*member, const BoundParameters<Part>& part) {
    for (const auto& entry : part.entries()) {
      add(entry.parameter,
          [member, apply = entry.apply](const Parameters& parameters, Options& options) {
            apply(parameters, options.*member);
          });
    }
    return *this;
  }

  /// Those of another list, after these.
  BoundParameters& add(const BoundParameters& more) {
    entries_.insert(entries_.end(), more.entries_.begin(), more.entries_.end());
    return *this;
  }

  /// A parameter that is not like its member; `apply` reads it.
  BoundParameters& add(Parameter parameter, Apply apply) {
    entries_.push_back({std::move(parameter), std::move(apply)});
    return *this;
  }

  std::vector<Parameter> declared() const {
    std::vector<Parameter> parameters;
    for (const Entry& entry : entries_) parameters.push_back(entry.parameter);
    return parameters;
  }

  /// The struct with the values of a call.
  Options read(const Parameters& parameters) const {
    Options options = defaults_;
    for (const Entry& entry : entries_) entry.apply(parameters, options);
    return options;
  }

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  template <typename Value>
  Parameter declaration(const std::string& name, const Option<Options, Value>& option,
                        std::string help) const {
    return {name,
            parameter_kind<Value>(),
            parameter_value(defaults_.*option.member),
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
