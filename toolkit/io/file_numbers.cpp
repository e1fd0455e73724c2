#include "toolkit/io/file_numbers.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

using Series = std::pair<fs::path, std::string>;  ///< the folder, and what the names have in common

/// Where the digits in `stem` begin that end at `last`; `last` where there are none.
std::size_t begin_of_digits(const std::string& stem, std::size_t last) {
  std::size_t first = last;
  while (first > 0 && is_digit(stem[first - 1])) --first;
  return first;
}

/// Where a number with its sign begins whose digits begin at `first`.
std::size_t begin_with_sign(const std::string& stem, std::size_t first) {
  const bool has_sign = first > 0 && stem[first - 1] == '-' &&
                        minus_is_sign(std::string_view(stem).substr(0, first - 1));
  return has_sign ? first - 1 : first;
}

std::optional<long long> integer(const std::string& text) {
  long long value = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end) return {};
  return value;
}

/// The part of `stem` from `first` to `last` is the number; none where it is too large to count.
NumberedName name_of(const fs::path& file, std::size_t first, std::size_t last,
                     std::optional<long long> number) {
  constexpr long long kMost = 4'000'000'000'000'000'000;  // differences are counted, too
  if (!number || *number < -kMost || *number > kMost) return {};
  const std::string stem = file.stem().string();
  return {stem.substr(0, first) + '*' + stem.substr(last) + lower_extension(file), *number,
          stem.substr(first, last - first)};
}

/// "t_0.25.obj" as 0 and 25 of the series "t_*.obj".
struct DecimalName {
  fs::path file;
  std::string stem;
  std::size_t first, point, last;

  std::size_t decimals() const { return last - point - 1; }
  std::string integer_part() const { return stem.substr(first, point - first); }
  std::string digits() const { return stem.substr(point + 1, decimals()); }
  /// In units of the last of `most` decimals.
  std::optional<long long> scaled(std::size_t most) const {
    constexpr std::size_t kMostOfAnInteger = 18;
    if (most > kMostOfAnInteger) return {};
    return integer(integer_part() + digits() + std::string(most - decimals(), '0'));
  }
};

std::optional<DecimalName> decimal_name(const fs::path& file) {
  DecimalName name{file, file.stem().string(), 0, 0, 0};
  const std::string& stem = name.stem;
  const auto last = std::ranges::find_if(stem.rbegin(), stem.rend(), is_digit).base();
  name.last = static_cast<std::size_t>(last - stem.begin());
  const std::size_t behind = begin_of_digits(stem, name.last);
  if (behind == name.last || behind == 0 || stem[behind - 1] != '.') return {};
  name.point = behind - 1;
  const std::size_t digits = begin_of_digits(stem, name.point);
  if (digits == name.point) return {};
  name.first = begin_with_sign(stem, digits);
  return name;
}

/// Equal steps, but for the rounding of the last decimal. \pre at least one
bool are_even(const std::vector<long long>& ascending) {
  constexpr long long kRounding = 2;
  long long least = ascending[1] - ascending[0], most = least;
  for (std::size_t i = 2; i < ascending.size(); ++i) {
    least = std::min(least, ascending[i] - ascending[i - 1]);
    most = std::max(most, ascending[i] - ascending[i - 1]);
  }
  return most - least <= std::min(kRounding, least / 2);
}

/// The numbers of names of one series in units of their last decimal; none where they are no
/// decimal numbers.
std::optional<std::vector<long long>> decimal_numbers(const std::vector<DecimalName>& names) {
  constexpr std::size_t kFewest = 3;
  if (names.size() < kFewest) return {};
  const auto [fewest, most] = std::ranges::minmax(names, {}, &DecimalName::decimals);
  const std::size_t least_decimals = fewest.decimals(), most_decimals = most.decimals();
  std::vector<long long> numbers;
  for (const DecimalName& name : names) {
    const auto number = name.scaled(most_decimals);
    if (!number) return {};
    numbers.push_back(*number);
  }
  std::vector<long long> ascending = numbers;
  std::ranges::sort(ascending);
  if (std::ranges::adjacent_find(ascending) != ascending.end()) return {};
  const bool has_leading_zero = std::ranges::any_of(names, [&](const DecimalName& name) {
    return name.decimals() > least_decimals && name.digits().front() == '0';
  });
  const bool differ =
      least_decimals < most_decimals || std::ranges::any_of(names, [&](const DecimalName& name) {
        return name.integer_part() != names.front().integer_part();
      });
  const bool are_decimal = has_leading_zero || (differ && are_even(ascending));
  return are_decimal ? std::optional(std::move(numbers)) : std::nullopt;
}

}  // namespace

bool minus_is_sign(std::string_view before) {
  return before.empty() || before.ends_with('_') || before.ends_with('.') || before.ends_with('-');
}

NumberedName numbered(const fs::path& file) {
  const std::string stem = file.stem().string();
  const auto last =
      std::ranges::find_if(stem.rbegin(), stem.rend(), is_digit).base() - stem.begin();
  const auto end = static_cast<std::size_t>(last);
  const std::size_t digits = begin_of_digits(stem, end);
  if (digits == end) return {};
  const std::size_t first = begin_with_sign(stem, digits);
  return name_of(file, first, end, integer(stem.substr(first, end - first)));
}

FileNumbers::FileNumbers(const std::vector<fs::path>& files) {
  std::map<Series, std::vector<DecimalName>> decimal;
  for (const fs::path& file : files) {
    names_.emplace(file, numbered(file));
    const auto name = decimal_name(file);
    if (!name) continue;
    const std::string series = name_of(file, name->first, name->last, 0).series;
    decimal[{file.parent_path(), series}].push_back(*name);
  }
  for (const auto& [series, names] : decimal) {
    const auto numbers = decimal_numbers(names);
    if (!numbers) continue;
    decimal_series_.insert(series.second);
    for (std::size_t i = 0; i < names.size(); ++i) {
      names_[names[i].file] = name_of(names[i].file, names[i].first, names[i].last, (*numbers)[i]);
    }
  }
}

void sort_by_numbers(std::vector<fs::path>& files) {
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return natural_less(a.string(), b.string());
  });
  const FileNumbers numbers(files);
  std::map<Series, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string& series = numbers.of(files[i]).series;
    if (!series.empty()) places[{files[i].parent_path(), series}].push_back(i);
  }
  // Files of other series keep their places among those of this one.
  for (const auto& [series, at] : places) {
    std::vector<fs::path> part;
    for (const std::size_t i : at) part.push_back(files[i]);
    std::ranges::stable_sort(part, {},
                             [&](const fs::path& file) { return numbers.of(file).number; });
    for (std::size_t i = 0; i < at.size(); ++i) files[at[i]] = part[i];
  }
}

}  // namespace mimetra
