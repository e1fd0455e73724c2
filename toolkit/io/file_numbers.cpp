#include "toolkit/io/file_numbers.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <map>
#include <utility>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

using Series = std::pair<fs::path, std::string>;  ///< folder and series of numbered names

/// End of the last digits in `stem`; 0 if there are none.
std::size_t end_of_digits(const std::string& stem) {
  const auto last = std::ranges::find_if(stem.rbegin(), stem.rend(), is_digit).base();
  return static_cast<std::size_t>(last - stem.begin());
}

/// Start of the digits in `stem` that end at `last`; `last` if there are none.
std::size_t begin_of_digits(const std::string& stem, std::size_t last) {
  std::size_t first = last;
  while (first > 0 && is_digit(stem[first - 1])) --first;
  return first;
}

/// Start, including a sign, of the number whose digits begin at `first`.
std::size_t begin_with_sign(const std::string& stem, std::size_t first) {
  const bool has_sign = first > 0 && stem[first - 1] == '-' &&
                        minus_is_sign(std::string_view(stem).substr(0, first - 1));
  return has_sign ? first - 1 : first;
}

/// Parses an integer; none if it is too large to count.
std::optional<long long> integer(const std::string& text) {
  constexpr long long kMost = 4'000'000'000'000'000'000;  // differences must not overflow
  long long value = 0;
  const char* const end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || last != end || value < -kMost || value > kMost) return {};
  return value;
}

/// Returns the file name with '*' in place of the characters from `first` to `last`.
std::string series_of(const fs::path& file, std::size_t first, std::size_t last) {
  const std::string stem = file.stem().string();
  return stem.substr(0, first) + '*' + stem.substr(last) + lower_extension(file);
}

/// Name whose number may have decimals: "t_0.25.obj" is 0.25 of the series "t_*.obj".
struct DecimalName {
  fs::path file;
  double value;
  bool has_point;
};

std::map<Series, std::vector<DecimalName>> decimal_names(const std::vector<fs::path>& files) {
  std::map<Series, std::vector<DecimalName>> all;
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    const std::size_t last = end_of_digits(stem), behind = begin_of_digits(stem, last);
    if (behind == last) continue;
    const bool has_point = behind > 1 && stem[behind - 1] == '.' && is_digit(stem[behind - 2]);
    const std::size_t first =
        begin_with_sign(stem, has_point ? begin_of_digits(stem, behind - 1) : behind);
    double value = 0;
    std::from_chars(stem.data() + first, stem.data() + last, value);
    all[{file.parent_path(), series_of(file, first, last)}].push_back({file, value, has_point});
  }
  return all;
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
  const auto number = integer(stem.substr(first, end - first));
  if (!number) return {};
  return {series_of(file, first, end), *number, stem.substr(first, end - first)};
}

void sort_by_numbers(std::vector<fs::path>& files) {
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return natural_less(a.string(), b.string());
  });
  std::map<Series, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::string series = numbered(files[i]).series;
    if (!series.empty()) places[{files[i].parent_path(), series}].push_back(i);
  }
  // Files outside this series keep their places.
  for (const auto& [series, at] : places) {
    std::vector<fs::path> part;
    for (const std::size_t i : at) part.push_back(files[i]);
    std::ranges::stable_sort(part, {}, [](const fs::path& file) { return numbered(file).number; });
    for (std::size_t i = 0; i < at.size(); ++i) files[at[i]] = part[i];
  }
}

std::optional<UnclearOrder> unclear_order(const std::vector<fs::path>& sorted) {
  for (const auto& [series, names] : decimal_names(sorted)) {
    if (std::ranges::none_of(names, &DecimalName::has_point)) continue;
    const auto fall =
        std::ranges::adjacent_find(names, std::ranges::greater(), &DecimalName::value);
    if (fall != names.end()) return UnclearOrder{fall->file, std::next(fall)->file};
  }
  return {};
}

}  // namespace mimetra
