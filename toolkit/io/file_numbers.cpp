#include "toolkit/io/file_numbers.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

using Series = std::pair<fs::path, std::string>;  ///< the folder, and what the names have in common

/// Where the last digits in `stem` end; 0 where there are none.
std::size_t end_of_digits(const std::string& stem) {
  const auto last = std::ranges::find_if(stem.rbegin(), stem.rend(), is_digit).base();
  return static_cast<std::size_t>(last - stem.begin());
}

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

/// None where it is too large to count.
std::optional<long long> integer(const std::string& text) {
  constexpr long long kMost = 4'000'000'000'000'000'000;  // differences are counted, too
  long long value = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || value < -kMost || value > kMost) return {};
  return value;
}

/// The part of the stem from `first` to `last` is the number.
NumberedName name_of(const fs::path& file, std::size_t first, std::size_t last,
                     std::optional<long long> number) {
  if (!number) return {};
  const std::string stem = file.stem().string();
  return {stem.substr(0, first) + '*' + stem.substr(last) + lower_extension(file), *number,
          stem.substr(first, last - first)};
}

/// "t_0.25.obj" as 0 and 25 of the series "t_*.obj", "t_1.obj" as 1 without decimals.
struct DecimalName {
  fs::path file;
  std::size_t first, last;  ///< of the number in the stem
  std::string integer_part, decimals;

  bool is_plain() const { return decimals.empty(); }
  std::size_t count() const { return decimals.size(); }
};

std::optional<DecimalName> decimal_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t last = end_of_digits(stem), behind = begin_of_digits(stem, last);
  if (behind == last) return {};
  const bool has_point = behind > 1 && stem[behind - 1] == '.' && is_digit(stem[behind - 2]);
  const std::size_t point = has_point ? behind - 1 : last;
  const std::size_t first = begin_with_sign(stem, begin_of_digits(stem, point));
  return DecimalName{file, first, last, stem.substr(first, point - first),
                     has_point ? stem.substr(behind, last - behind) : std::string()};
}

using DecimalNames = std::vector<DecimalName>;

/// In units of the last decimal; empty where one is too large to count.
std::vector<long long> decimal_numbers(const DecimalNames& names) {
  constexpr std::size_t kMostDecimals = 9;  // 0.30000000000000004 has errors of floating point
  const std::size_t most = std::ranges::max(names, {}, &DecimalName::count).count();
  std::vector<long long> numbers;
  for (const DecimalName& name : names) {
    std::string decimals = name.decimals;
    decimals.resize(std::min(most, kMostDecimals), '0');
    const auto number = integer(name.integer_part + decimals);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

/// The digits behind the points, ascending; empty where one is too large to count.
std::vector<long long> whole_numbers(const DecimalNames& pointed) {
  std::vector<long long> numbers;
  for (const DecimalName& name : pointed) {
    const auto number = integer(name.decimals);
    if (!number) return {};
    numbers.push_back(*number);
  }
  std::ranges::sort(numbers);
  return numbers;
}

/// At least two equal steps, but for `rounding`.
bool are_even(std::vector<long long> numbers, long long rounding = 0) {
  if (numbers.size() < 3) return false;
  std::ranges::sort(numbers);
  long long least = numbers[1] - numbers[0], most = least;
  for (std::size_t i = 2; i < numbers.size(); ++i) {
    least = std::min(least, numbers[i] - numbers[i - 1]);
    most = std::max(most, numbers[i] - numbers[i - 1]);
  }
  return least > 0 && most - least <= std::min(rounding, least / 2);
}

bool are_distinct(std::vector<long long> numbers) {
  std::ranges::sort(numbers);
  return !numbers.empty() && std::ranges::adjacent_find(numbers) == numbers.end();
}

/// Whether about half of the numbers between the first and the last are there. \pre ascending
bool are_close(const std::vector<long long>& numbers) {
  return !numbers.empty() && numbers.back() - numbers.front() < 2 * std::ssize(numbers);
}

/// The names of one series, some of which have a point.
class DecimalSeries {
 public:
  explicit DecimalSeries(DecimalNames names) : names_(std::move(names)), pointed_(names_) {
    std::erase_if(pointed_, &DecimalName::is_plain);
    longer_ = pointed_;
    const std::size_t least = std::ranges::min(pointed_, {}, &DecimalName::count).count();
    std::erase_if(longer_, [&](const DecimalName& name) { return name.count() == least; });
    numbers_ = decimal_numbers(names_);
  }

  const DecimalNames& names() const { return names_; }
  /// In units of the last decimal; empty where one is too large to count.
  const std::vector<long long>& numbers() const { return numbers_; }

  /// What is neither decimal nor whole is unclear.
  bool is_decimal() const {
    if (begins_with_zero() || begins_at_zero()) return are_distinct(numbers_);
    return has_even_decimals() && !has_even_whole_numbers();
  }
  bool is_whole() const {
    constexpr std::size_t kFewest = 4;  // 5, 15 and 25 may be 0.15, 0.25 and 0.5
    if (has_plain() && !has_one_integer_part()) return false;
    if (has_plain() && is_one_take()) return true;
    if (ends_with_zero()) return !begins_with_zero();
    if (has_close_whole_numbers() && !has_even_decimals()) return !begins_with_zero();
    return names_.size() >= kFewest && has_even_whole_numbers() && !has_even_decimals();
  }

 private:
  bool has_plain() const { return pointed_.size() < names_.size(); }
  bool begins_with_zero() const {
    return std::ranges::any_of(longer_, [](const auto& name) { return name.decimals[0] == '0'; });
  }
  bool ends_with_zero() const {
    return std::ranges::any_of(longer_,
                               [](const auto& name) { return name.decimals.back() == '0'; });
  }
  bool has_one_integer_part() const {
    const std::string& first = names_.front().integer_part;
    return std::ranges::all_of(names_,
                               [&](const auto& name) { return name.integer_part == first; });
  }
  bool has_even_decimals() const {
    constexpr long long kRounding = 2;  // of both ends of a step, in units of the last decimal
    return !ends_with_zero() && !is_one_take() && are_even(numbers_, kRounding);
  }
  bool has_even_whole_numbers() const {
    return !has_plain() && has_one_integer_part() && names_[0].integer_part[0] != '-' &&
           are_even(whole_numbers(pointed_));
  }
  /// "0101" and "0102", as frames are numbered.
  bool are_padded() const {
    return are_close(whole_numbers(pointed_)) &&
           std::ranges::all_of(pointed_, [](const auto& name) {
             return name.count() > 1 && name.decimals[0] == '0';
           });
  }
  /// "0.obj" and "0.5.obj".
  bool begins_at_zero() const {
    return has_plain() && has_one_integer_part() && longer_.empty() &&
           integer(names_[0].integer_part) == 0 && !are_padded();
  }
  bool has_close_whole_numbers() const {
    return has_one_integer_part() && are_close(whole_numbers(pointed_));
  }
  /// "take1.1.obj" and "take1.2.obj", of which "take1.obj" is no frame; but "t_0.obj" is one of
  /// "t_0.1.obj" and "t_0.2.obj".
  bool is_one_take() const {
    if (!has_one_integer_part() || !longer_.empty()) return false;
    return !has_plain() || integer(names_[0].integer_part) != 0;
  }

  DecimalNames names_, pointed_;
  DecimalNames longer_;  ///< with more decimals than the fewest behind a point
  std::vector<long long> numbers_;
};

/// The series of `files` that have a name with a point.
std::map<Series, DecimalSeries> decimal_series(const std::vector<fs::path>& files) {
  std::map<Series, DecimalNames> all;
  for (const fs::path& file : files) {
    const auto name = decimal_name(file);
    if (!name) continue;
    const std::string series = name_of(file, name->first, name->last, 0).series;
    all[{file.parent_path(), series}].push_back(*name);
  }
  std::map<Series, DecimalSeries> found;
  for (auto& [series, names] : all) {
    if (std::ranges::all_of(names, &DecimalName::is_plain)) continue;
    found.emplace(series, DecimalSeries(std::move(names)));
  }
  return found;
}

}  // namespace

bool minus_is_sign(std::string_view before) {
  return before.empty() || before.ends_with('_') || before.ends_with('.') || before.ends_with('-');
}

NumberedName numbered(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::size_t end = end_of_digits(stem);
  const std::size_t digits = begin_of_digits(stem, end);
  if (digits == end) return {};
  const std::size_t first = begin_with_sign(stem, digits);
  return name_of(file, first, end, integer(stem.substr(first, end - first)));
}

FileNumbers::FileNumbers(const std::vector<fs::path>& files) {
  for (const fs::path& file : files) names_.emplace(file, numbered(file));
  for (const auto& [series, decimal] : decimal_series(files)) {
    if (!decimal.is_decimal()) continue;
    decimal_series_.insert(series.second);
    for (std::size_t i = 0; i < decimal.names().size(); ++i) {
      const DecimalName& name = decimal.names()[i];
      names_[name.file] = name_of(name.file, name.first, name.last, decimal.numbers()[i]);
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

std::optional<UnclearOrder> unclear_order(const std::vector<fs::path>& sorted) {
  for (const auto& [series, decimal] : decimal_series(sorted)) {
    const auto fall = std::ranges::adjacent_find(decimal.numbers(), std::ranges::greater());
    if (decimal.is_whole() || fall == decimal.numbers().end()) continue;
    const auto first = decimal.names().begin() + (fall - decimal.numbers().begin());
    return UnclearOrder{first->file, (first + 1)->file};
  }
  return {};
}

}  // namespace mimetra
