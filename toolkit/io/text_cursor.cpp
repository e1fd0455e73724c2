#include "toolkit/io/text_cursor.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

/// `word` in quotes, shortened, since a binary file read as text has lines of megabytes.
std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 40;
  if (word.empty()) return "nothing";
  std::string text = "'";
  for (const char c : word.substr(0, kLongest)) {
    text += static_cast<unsigned char>(c) < ' ' ? '?' : c;
  }
  return text + (word.size() > kLongest ? "...'" : "'");
}

/// std::from_chars does not accept a leading plus.
std::string_view without_plus(std::string_view word) {
  const bool plus = word.size() > 1 && word[0] == '+' && word[1] != '-';
  return plus ? word.substr(1) : word;
}

/// True for digits of a number that is too large for a double, false for one that is too small.
bool is_large(std::string_view digits) {
  const std::size_t exponent_at = std::min(digits.find_first_of("eE"), digits.size());
  long long magnitude = 0;  // digits before the point, if written without exponent
  bool is_behind_point = false, is_zero = true;
  for (const char c : digits.substr(0, exponent_at)) {
    if (c == '.') is_behind_point = true;
    if (c < '0' || c > '9') continue;
    is_zero = is_zero && c == '0';
    if (!is_behind_point && !is_zero) ++magnitude;
    if (is_behind_point && is_zero) --magnitude;
  }
  if (exponent_at == digits.size()) return magnitude > 0;
  const std::string_view exponent = without_plus(digits.substr(exponent_at + 1));
  int power = 0;
  const char* end = exponent.data() + exponent.size();
  if (std::from_chars(exponent.data(), end, power).ec != std::errc()) return exponent[0] != '-';
  return magnitude + power > 0;
}

/// Writes the shortest digits that read back equal. \pre `text` has room for kMostDigits
template <typename Number>
char* put_shortest(char* text, Number value) {
  return std::to_chars(text, text + kMostDigits, value).ptr;
}

}  // namespace

char* put_number(char* text, double value, bool double_precision) {
  return double_precision ? put_shortest(text, value)
                          : put_shortest(text, static_cast<float>(value));
}

void append_number(std::string& text, double value, bool double_precision) {
  std::array<char, kMostDigits> digits;
  text.append(digits.data(), put_number(digits.data(), value, double_precision));
}

void append_integer(std::string& text, long long value) {
  std::array<char, kMostDigits> digits;
  text.append(digits.data(), put_shortest(digits.data(), value));
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

std::string_view without_padding(std::string_view bytes) {
  return bytes.substr(0, bytes.find_last_not_of('\0') + 1);
}

void check_encoding(const std::string& path, std::string_view text) {
  if (!text.starts_with("\xFF\xFE") && !text.starts_with("\xFE\xFF")) return;
  throw IoError(path, "is text in UTF-16, expected UTF-8; save it in that encoding");
}

TextCursor::TextCursor(const std::string& path, std::string_view text, Syntax syntax,
                       int first_line)
    : path_(path),
      at_(text.data()),
      end_(text.data() + text.size()),
      syntax_(syntax),
      line_(first_line) {
  check_encoding(path, text);
}

void TextCursor::skip_blanks() {
  while (at_ != end_) {
    if (is_blank(*at_)) {
      ++at_;
    } else if (syntax_.continuations && *at_ == '\\') {
      const char* next = at_ + 1;
      if (next != end_ && *next == '\r') ++next;
      if (next == end_ || *next != '\n') return;
      at_ = next + 1;
      ++line_;
    } else {
      return;
    }
  }
}

std::string_view TextCursor::word() {
  skip_blanks();
  if (at_ == end_ || *at_ == '\n' || (syntax_.comments && *at_ == '#')) return {};
  const char* first = at_;
  while (at_ != end_ && !ends_word(*at_)) {
    // "1 2 3\" without a blank before the continuation
    if (syntax_.continuations && *at_ == '\\' && at_ != first && at_ + 1 != end_ &&
        ends_word(at_[1])) {
      break;
    }
    ++at_;
  }
  return {first, static_cast<std::size_t>(at_ - first)};
}

std::string_view TextCursor::word_anywhere() {
  while (true) {
    const std::string_view found = word();
    if (!found.empty() || at_ == end_) return found;
    next_line();
  }
}

std::string_view TextCursor::rest_of_line() {
  skip_blanks();
  const char* first = at_;
  next_line();
  const char* last = at_ != first && at_[-1] == '\n' ? at_ - 1 : at_;
  while (last != first && is_blank(last[-1])) --last;
  return {first, static_cast<std::size_t>(last - first)};
}

void TextCursor::next_line() {
  at_ = std::find(at_, end_, '\n');
  if (at_ != end_) {
    ++at_;
    ++line_;
  }
}

double TextCursor::number(std::string_view word, std::string_view what) const {
  const std::string_view digits = without_plus(word);
  double value = 0;
  const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::invalid_argument || last != digits.data() + digits.size()) {
    fail_expected("a number for " + std::string(what), word);
  }
  // A number that is too small becomes 0. One that is too large becomes infinite, and callers
  // refuse it.
  if (error == std::errc::result_out_of_range) {
    const double magnitude = is_large(digits) ? std::numeric_limits<double>::infinity() : 0;
    return digits[0] == '-' ? -magnitude : magnitude;
  }
  return value;
}

long long TextCursor::integer(std::string_view word, std::string_view what) const {
  const std::string_view digits = without_plus(word);
  long long value = 0;
  const auto [last, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || last != digits.data() + digits.size()) {
    fail_expected("an integer for " + std::string(what), word);
  }
  return value;
}

void TextCursor::expect_end() {
  const std::string_view found = word_anywhere();
  if (!found.empty()) fail_expected("the end of the file", found);
}

void TextCursor::fail_expected(std::string_view expected, std::string_view found) const {
  fail("expected " + std::string(expected) + ", found " + quoted(found));
}

void TextCursor::fail(const std::string& message) const {
  throw IoError(path_, "line " + std::to_string(line_) + ": " + message);
}

}  // namespace mimetra
