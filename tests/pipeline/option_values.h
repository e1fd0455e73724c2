#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include <gmock/gmock.h>

#include "tests/option_ranges.h"
#include "toolkit/mesh/option.h"

/// Tests generated from the declared options of a struct. Its algorithm must refuse values out of
/// range, and other values must change the result.
namespace mimetra::test {

/// The numbers of a result.
class Digest {
 public:
  template <typename... Parts>
  explicit Digest(const Parts&... parts) {
    (add(parts), ...);
  }
  bool operator==(const Digest&) const = default;

 private:
  template <typename Part>
  void add(const Part& part) {
    if constexpr (std::is_arithmetic_v<Part>) {
      // NaN would differ from itself.
      EXPECT_FALSE(std::isnan(static_cast<double>(part)));
      numbers_.push_back(static_cast<double>(part));
    } else if constexpr (requires { part.reshaped(); }) {
      for (const double number : part.reshaped()) add(number);
    } else {
      for (const auto& each : part) add(each);
    }
  }

  std::vector<double> numbers_;
};

/// Range of a length that is a share.
inline Range range_of_shares(const Range& range) {
  return {range.minimum.value_or(0), range.maximum.value_or(Length::kLargestShare)};
}

/// Value of an option; the default of its type if the option is unset.
template <typename Value>
Value held(const std::optional<Value>& option) {
  return option.value_or(Value{});
}
/// The first value of a list.
template <typename Value>
Value held(const std::vector<Value>& list) {
  return list.front();
}

/// Values of the type of `like` that an option must refuse.
template <typename Value>
std::vector<Value> bad_values(const Range& range, const Value& like) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Value> bad;
  if constexpr (NamedChoice<Value>) {
    bad = {static_cast<Value>(-1), static_cast<Value>(choices<Value>().size())};
  } else if constexpr (std::is_same_v<Value, Length>) {
    const std::vector<double> shares = bad_values(range_of_shares(range), like.value);
    for (const double share : shares) bad.push_back(Length::share(share));
    bad.push_back(Length::of(-1));
  } else if constexpr (std::is_arithmetic_v<Value>) {
    const auto beyond = test::beyond<Value>;
    if (range.minimum) bad.push_back(static_cast<Value>(beyond(*range.minimum, -kInfinity)));
    if (range.maximum) bad.push_back(static_cast<Value>(beyond(*range.maximum, kInfinity)));
    if constexpr (std::is_floating_point_v<Value>) {
      bad.insert(bad.end(), {std::numeric_limits<Value>::quiet_NaN(), kInfinity, -kInfinity});
    }
  } else {
    for (const auto& each : bad_values(range, held(like))) bad.push_back(Value{each});
  }
  return bad;
}

/// Other values in the range: all other choices, or another number.
template <typename Value>
std::vector<Value> other_values(const Range& range, const Value& value) {
  std::vector<Value> others;
  if constexpr (NamedChoice<Value>) {
    others = choices<Value>();
    std::erase(others, value);
  } else if constexpr (std::is_same_v<Value, bool>) {
    others = {!value};
  } else if constexpr (std::is_same_v<Value, Length>) {
    const std::vector<double> shares = other_values(range_of_shares(range), value.value);
    for (const double share : shares) others.push_back(Length::share(share));
  } else if constexpr (std::is_arithmetic_v<Value>) {
    for (const double number : {2.0 * value, 0.5 * value, 1.0, 0.5}) {
      const auto other = static_cast<Value>(number);
      if (others.empty() && other != value && range.holds(number)) others = {other};
    }
  } else {
    for (const auto& each : other_values(range, held(value))) others.push_back(Value{each});
  }
  return others;
}

/// Options, and a computation that takes them. Some options matter beside certain others only.
template <typename Options>
struct Base {
  Options options;
  std::function<Digest(const Options&)> compute;
};

/// Effect of a value on the result.
enum class Effect { none, change, refusal };

/// Expects that every base refuses bad values, and that each option changes the result of some
/// base. Some base must tell each choice from its own, or refuse it.
template <typename Options>
void expect_all_count(const std::vector<Base<Options>>& bases) {
  std::set<std::string> accepted;
  std::map<std::string, bool> counts;
  const auto try_option = [&](std::size_t b, const Digest& usual, const auto& option) {
    const std::string name(option.name);
    bool& option_counts = counts[name];
    const auto& usual_value = bases[b].options.*option.member;
    const auto effect_of = [&](const auto& value) {
      Options options = bases[b].options;
      options.*option.member = value;
      try {
        return bases[b].compute(options) == usual ? Effect::none : Effect::change;
      } catch (const std::invalid_argument&) {
        return Effect::refusal;
      }
    };
    for (const auto& bad : bad_values(option.range, usual_value)) {
      if (effect_of(bad) == Effect::refusal) continue;
      accepted.insert(name + " on base " + std::to_string(b));
    }
    for (const auto& other : other_values(option.range, usual_value)) {
      const Effect effect = effect_of(other);
      option_counts |= effect == Effect::change;
      if constexpr (NamedChoice<std::remove_cvref_t<decltype(other)>>) {
        counts[name + ' ' + std::string(choice_name(other))] |= effect != Effect::none;
      }
    }
  };
  for (std::size_t b = 0; b < bases.size(); ++b) {
    const Digest usual = bases[b].compute(bases[b].options);
    std::apply([&](const auto&... each) { (try_option(b, usual, each), ...); },
               Options::declared());
  }
  EXPECT_THAT(accepted, testing::IsEmpty()) << "bad values are not refused";
  std::erase_if(counts, [](const auto& name_and_counts) { return name_and_counts.second; });
  EXPECT_THAT(counts, testing::IsEmpty()) << "other values change nothing";
}

/// The same computation on several bases.
template <typename Options, typename Compute>
void expect_all_count(const std::vector<Options>& bases, const Compute& compute) {
  std::vector<Base<Options>> computed;
  for (const Options& options : bases) computed.push_back({options, compute});
  expect_all_count(computed);
}

}  // namespace mimetra::test
