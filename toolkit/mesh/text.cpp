#include "toolkit/mesh/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace mimetra {
namespace {

/// Digits from `at` on without leading zeros; moves `at` behind them.
std::string_view number_run(const std::string& text, std::size_t& at) {
  while (at < text.size() && text[at] == '0') ++at;
  const std::size_t first = at;
  while (at < text.size() && is_digit(text[at])) ++at;
  return std::string_view(text).substr(first, at - first);
}

/// Formats as printf does, but with '.' in every locale.
std::string number_text(double value, std::chars_format format, int precision) {
  std::array<char, 400> text;  // a double in fixed notation has up to 309 digits before the point
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, format, std::min(precision, 64))
          .ptr;
  return {text.data(), end};
}

std::string in_small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return text;
}

/// Levenshtein distance.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
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
  // "1" and "01" are equal numbers, so any fixed order is correct.
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
  words.reserve(numbers.size());
  for (const int number : numbers) words.push_back(std::to_string(number));
  return words;
}

std::string readable(double value, int digits) {
  // Fixed notation, because 1.9e+02 would be a bad text for 185 degrees.
  constexpr double kLong = 1e6;
  const double size = std::abs(value);
  if (size < kLong && size >= std::pow(10, digits) - 0.5) return fixed(value, 0);
  return number_text(value, std::chars_format::general, digits);
}

std::string fixed(double value, int decimals) {
  return number_text(value, std::chars_format::fixed, decimals);
}

std::string percent(double share) {
  return fixed(100 * share, 1) + " %";
}

std::size_t printable_bytes(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f;
  const std::size_t size = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < size) return 0;
  std::uint32_t code = first & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80) return 0;
    code = code << 6U | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_character =
      code >= kLeast[size] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff);
  // The C1 controls, and characters that change the direction of writing.
  const bool is_control =
      code < 0xa0 || (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return is_character && !is_control ? size : 0;
}

bool is_printable(std::string_view text) {
  while (!text.empty()) {
    const std::size_t size = printable_bytes(text);
    if (size == 0) return false;
    text.remove_prefix(size);
  }
  return true;
}

std::string nearest_word(const std::string& word, const std::vector<std::string>& known) {
  std::string nearest;
  const std::string small = in_small_letters(word);
  // A third of the letters may be wrong, as in "decompse" or "--radios"; beyond that it is another
  // word.
  std::size_t best = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(small, in_small_letters(candidate));
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string suggestion_for(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

std::string escaped_for_xml(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

}  // namespace mimetra
