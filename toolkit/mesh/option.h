#pragma once

#include <concepts>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

/// Declaration of algorithm options. A struct of options lists the members that users can set, with
/// the range of each. Algorithms check values against this list; parameters of commands and dialogs
/// take default, range and unit from it.
namespace mimetra {

/// An enum that counts from 0 and has a function `choice_name`. It returns the name of each value
/// and an empty name for other numbers. It must be a switch without a default, so that the compiler
/// reports values without a name.
template <typename Enum>
concept NamedChoice = std::is_enum_v<Enum> && requires(Enum value) {
  { choice_name(value) } -> std::same_as<std::string_view>;
};

/// All values, in the order of the enum.
template <NamedChoice Enum>
std::vector<Enum> choices() {
  std::vector<Enum> values;
  for (int i = 0; !choice_name(static_cast<Enum>(i)).empty(); ++i) {
    values.push_back(static_cast<Enum>(i));
  }
  return values;
}

template <NamedChoice Enum>
std::vector<std::string> choice_names() {
  std::vector<std::string> names;
  for (const Enum value : choices<Enum>()) names.emplace_back(choice_name(value));
  return names;
}

/// Value with this name, if any.
template <NamedChoice Enum>
std::optional<Enum> choice_of(std::string_view name) {
  for (const Enum value : choices<Enum>()) {
    if (choice_name(value) == name) return value;
  }
  return {};
}

/// A length, either in the unit of the mesh's file or as a share of the mesh's diameter, at most
/// kLargestShare.
struct Length {
  double value = 0;  ///< >= 0
  bool absolute = false;

  /// A larger share is probably a length without its unit.
  static constexpr double kLargestShare = 1;

  static constexpr Length share(double of_diameter) { return {of_diameter, false}; }
  static constexpr Length of(double length) { return {length, true}; }

  /// Length in the unit of a mesh with this diameter().
  constexpr double in(double diameter) const { return absolute ? value : value * diameter; }
};

/// Closed range of numbers; a missing end is unbounded.
struct Range {
  std::optional<double> minimum = {};
  std::optional<double> maximum = {};

  /// Whether the range contains `number`; false if it is not finite.
  bool holds(double number) const;
};

/// A member of a struct of options: its name, range and unit. The range of a Length applies to its
/// number, whether it is a share or absolute. The default is the value in a new struct.
template <typename Options, typename Value>
struct Option {
  constexpr Option(std::string_view own_name, Value Options::*own_member, Range own_range = {},
                   std::string_view own_unit = "")
      : name(own_name), member(own_member), range(own_range), unit(own_unit) {}

  std::string_view name;
  Value Options::*member;
  Range range;
  std::string_view unit;
};

/// Throws std::invalid_argument, with the option's name and range, unless the range contains
/// `number`.
void check_number(std::string_view name, const Range& range, double number);

/// Checks a length as check_number() does. A missing minimum counts as 0. For a share, a missing
/// maximum counts as Length::kLargestShare.
void check_length(std::string_view name, const Range& range, const Length& length);

/// Throws std::invalid_argument for a number out of range, or for an undefined value of an enum.
template <typename Value>
void check_value(std::string_view name, const Range& range, const Value& value) {
  if constexpr (NamedChoice<Value>) {
    if (!choice_name(value).empty()) return;
    throw std::invalid_argument(std::string(name) + ": no such choice");
  } else if constexpr (std::is_same_v<Value, Length>) {
    check_length(name, range, value);
  } else {
    static_assert(std::is_arithmetic_v<Value>);
    check_number(name, range, static_cast<double>(value));
  }
}

template <typename Value>
void check_value(std::string_view name, const Range& range, const std::optional<Value>& value) {
  if (value) check_value(name, range, *value);
}

template <typename Value>
void check_value(std::string_view name, const Range& range, const std::vector<Value>& values) {
  for (const Value& value : values) check_value(name, range, value);
}

template <typename Options, typename Value>
void check_option(const Options& options, const Option<Options, Value>& option) {
  check_value(option.name, option.range, options.*option.member);
}

/// Checks all members that `Options::declared()`, a tuple of Option, lists.
template <typename Options>
void check_options(const Options& options) {
  std::apply(
      [&options](const auto&... each) {
        (check_value(each.name, each.range, options.*each.member), ...);
      },
      Options::declared());
}

}  // namespace mimetra
