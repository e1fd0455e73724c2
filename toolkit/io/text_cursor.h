#pragma once

#include <string>
#include <string_view>

namespace mimetra {

/// True for characters that separate words on a line.
inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline bool ends_word(char c) {
  return is_blank(c) || c == '\n';
}

/// `text` without a leading UTF-8 byte-order mark.
std::string_view without_byte_order_mark(std::string_view text);

/// `bytes` without zero bytes at the end, with which file systems and downloads pad files.
std::string_view without_padding(std::string_view bytes);

/// Throws IoError for text that begins with the byte-order mark of UTF-16.
void check_encoding(const std::string& path, std::string_view text);

/// Room for the shortest digits of a number: a double takes up to 24, an integer up to 20.
inline constexpr std::size_t kMostDigits = 32;

/// Writes the shortest digits that read back equal, as float or as double, to `text`. Returns the
/// end of the digits.
/// \pre `text` has room for kMostDigits
char* put_number(char* text, double value, bool double_precision = true);
/// Append the shortest digits that read back equal.
void append_number(std::string& text, double value, bool double_precision = true);
void append_integer(std::string& text, long long value);

/// Reads a text word by word, within a line or across lines, and knows the line for messages. Lines
/// end in LF or CRLF. For readers.
class TextCursor {
 public:
  /// Syntax besides line ends.
  struct Syntax {
    bool comments = false;  ///< a word that starts with '#' begins a comment up to the line's end
    bool continuations = false;  ///< '\' at the end of a line joins the next one
  };

  /// Keeps references to `path` and `text`, which must outlive the cursor. `first_line` is the
  /// number of the text's first line. Throws IoError for text in UTF-16.
  TextCursor(const std::string& path, std::string_view text, Syntax syntax, int first_line = 1);

  int line() const { return line_; }
  /// Bytes not yet read.
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  bool at_end() const { return at_ == end_; }

  /// Next word of this line; empty if there is none.
  std::string_view word();
  /// Next word of this or a later line; empty at the end of the text.
  std::string_view word_anywhere();
  /// Rest of this line, without blanks around it. Moves to the next line.
  std::string_view rest_of_line();
  void next_line();

  /// `word` as a number. Throws IoError, which says that `what` was expected.
  double number(std::string_view word, std::string_view what) const;
  long long integer(std::string_view word, std::string_view what) const;

  /// Throws IoError if a word is left.
  void expect_end();

  /// Throws IoError with path and line.
  [[noreturn]] void fail(const std::string& message) const;
  /// Throws IoError: "expected X, found 'word'", or "found nothing" for an empty word.
  [[noreturn]] void fail_expected(std::string_view expected, std::string_view found) const;

 private:
  void skip_blanks();

  const std::string& path_;
  const char* at_;
  const char* end_;
  Syntax syntax_;
  int line_;
};

}  // namespace mimetra
