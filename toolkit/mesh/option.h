#pragma once

#include <concepts>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

/// Options of algorithms, declared once: a struct of options lists the members that its users set,
/// each with the values it takes. The algorithm checks them by that list, and parameters of
/// commands and dialogs take default, range and unit from it.
namespace mimetra {

/// An enum that counts from 0, with `choice_name` beside it: the name of each value, and an empty
/// one for any other number. It is a switch without a default, so that the compiler names a value
/// without a name.
template <typename Enum>
concept NamedChoice = std::is_enum_v<Enum> && requires(Enum value) {
  { choice_name(value) } -> std::same_as<std::string_view>;
};

/// Every value, in the order of the enum.
template <NamedChoice Enum>
std::vector<Enum> choices() {
  std::vector<Enum> values;
  for (int i = 0; !choice_name(static_cast<Enum>(i)).empty(); ++i) {
    values.push_back(static_cast<Enum>(i));
  }
  return values;
}

/// Their names.
template <NamedChoice Enum>
std::vector<std::string> choice_names() {
  std::vector<std::string> names;
  for (const Enum value : choices<Enum>()) names.emplace_back(choice_name(value));
  return names;
}

/// The value of a name; none where no value has it.
template <NamedChoice Enum>
std::optional<Enum> choice_of(std::string_view name) {
  for (const Enum value : choices<Enum>()) {
    if (choice_name(value) == name) return value;
  }
  return {};
}

/// A length that may depend on the mesh: a share of its diameter, up to kLargestShare, or in the
/// unit of its file.
struct Length {
  double value = 0;  ///< >= 0
  bool absolute = false;

  /// A share that is larger is a length whose unit was forgotten.
  static constexpr double kLargestShare = 1;

  static constexpr Length share(double of_diameter) { return {of_diameter, false}; }
  static constexpr Length of(double length) { return {length, true}; }

  /// In the unit of a mesh of this diameter().
  constexpr double in(double diameter) const { return absolute ? value : value * diameter; }
};

/// The numbers that an option takes, both ends included; open where there is no end.
struct Range {
  std::optional<double> minimum = {};
  std::optional<double> maximum = {};

  /// False for what is not finite.
  bool holds(double number) const;
};

/// A member of a struct of options: its name, its range (for a Length that of its number, share or
/// absolute) and its unit. The default is what the struct holds when it is made.
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

/// Throws std::invalid_argument that names the option and its range unless that holds the number.
void check_number(std::string_view name, const Range& range, double number);

/// The same for a length, which is not negative, and as a share no larger than
/// Length::kLargestShare.
void check_length(std::string_view name, const Range& range, const Length& length);

/// Throws std::invalid_argument for a number out of its range, and for an enum that has no such
/// value.
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

/// Checks the members that `Options::declared()`, a tuple of Option, lists.
template <typename Options>
void check_options(const Options& options) {
  std::apply(
      [&options](const auto&... each) {
        (check_value(each.name, each.range, options.*each.member), ...);
      },
      Options::declared());
}

}  // namespace mimetra
