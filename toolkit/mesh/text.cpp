#include "toolkit/mesh/text.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace mimetra {
namespace {

/// The digits from `at` on without leading zeros; moves `at` behind them.
std::string_view number_run(const std::string& text, std::size_t& at) {
  while (at < text.size() && text[at] == '0') ++at;
  const std::size_t first = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  return std::string_view(text).substr(first, at - first);
}

/// As printf writes it, but with a decimal point in every locale.
std::string number_text(double value, std::chars_format format, int precision) {
  std::array<char, 400> text;  // a double in fixed notation has up to 309 digits before the point
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, format, std::min(precision, 64))
          .ptr;
  return {text.data(), end};
}

}  // namespace

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  return text;
}

std::string lower_extension(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

bool natural_less(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view left = number_run(a, i), right = number_run(b, j);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
    } else if (a[i] != b[j]) {
      return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    } else {
      ++i;
      ++j;
    }
  }
  const bool a_ends = i == a.size(), b_ends = j == b.size();
  // "1" and "01" are equal numbers: any fixed order will do.
  return a_ends && b_ends ? a < b : a_ends;
}

std::string joined(const std::vector<std::string>& words, std::string_view between,
                   std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? between : last;
    text += words[i];
  }
  return text;
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  return joined(words, between, between);
}

std::string listed(const std::vector<std::string>& words, std::size_t most) {
  if (words.size() <= most) return joined(words);
  const auto end = words.begin() + static_cast<std::ptrdiff_t>(most);
  return joined({words.begin(), end}) + " and " + std::to_string(words.size() - most) + " more";
}

std::vector<std::string> words_of(const std::vector<int>& numbers) {
  std::vector<std::string> words;
  for (const int number : numbers) words.push_back(std::to_string(number));
  return words;
}

std::string readable(double value, int digits) {
  return number_text(value, std::chars_format::general, digits);
}

std::string fixed(double value, int decimals) {
  return number_text(value, std::chars_format::fixed, decimals);
}

std::string percent(double share) {
  return fixed(100 * share, 1) + " %";
}

}  // namespace mimetra
