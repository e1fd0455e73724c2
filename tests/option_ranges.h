#pragma once

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "toolkit/mesh/option.h"

namespace mimetra::test {

template <typename Value>
void set_option(Value& value, double number) {
  if constexpr (std::is_same_v<Value, Length>) {
    value.value = number;
  } else if constexpr (std::is_same_v<Value, bool> || NamedChoice<Value>) {
    FAIL() << "has no range";
  } else {
    value = static_cast<Value>(number);
  }
}

template <typename Value>
void set_option(std::optional<Value>& value, double number) {
  set_option(value.emplace(), number);
}

template <typename Value>
void set_option(std::vector<Value>& values, double number) {
  values.resize(1);
  set_option(values.front(), number);
}

/// The next value out of the range at an end of it.
template <typename Value>
double beyond(double end, double direction) {
  const bool whole = std::is_same_v<Value, int> || std::is_same_v<Value, std::optional<int>> ||
                     std::is_same_v<Value, std::vector<int>>;
  return whole ? end + std::copysign(1, direction) : std::nextafter(end, direction);
}

template <typename Options, typename Value>
void expect_refusal(const Option<Options, Value>& option, double number) {
  Options options;
  set_option(options.*option.member, number);
  EXPECT_THAT([&] { check_options(options); },
              testing::ThrowsMessage<std::invalid_argument>(
                  testing::HasSubstr(std::string(option.name) + " is ")));
}

template <typename Options, typename Value>
void expect_acceptance(const Option<Options, Value>& option, double number) {
  Options options;
  set_option(options.*option.member, number);
  EXPECT_NO_THROW(check_options(options)) << option.name << ' ' << number;
}

/// The defaults are in range, and each option that has one takes its ends, and nothing beyond.
template <typename Options>
void expect_ranges() {
  EXPECT_NO_THROW(check_options(Options()));
  const auto check = [](const auto& option) {
    using Value = std::remove_cvref_t<decltype(Options().*option.member)>;
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const auto& [minimum, maximum] = option.range;
    if (minimum) {
      expect_acceptance(option, *minimum);
      expect_refusal(option, beyond<Value>(*minimum, -kInfinity));
    }
    if (maximum) {
      expect_acceptance(option, *maximum);
      expect_refusal(option, beyond<Value>(*maximum, kInfinity));
    }
  };
  std::apply([&](const auto&... each) { (check(each), ...); }, Options::declared());
}

}  // namespace mimetra::test
