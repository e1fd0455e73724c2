#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

/// Enums whose values people choose by name.
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

}  // namespace mimetra
