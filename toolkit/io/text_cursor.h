#pragma once

#include <string>
#include <string_view>

namespace mimetra {

/// What parts words on a line.
inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

inline bool ends_word(char c) {
  return is_blank(c) || c == '\n';
}

/// `text` without the mark that some programs put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

/// `bytes` without the zero bytes at their end, with which file systems and downloads pad files.
std::string_view without_padding(std::string_view bytes);

/// Throws IoError for text in UTF-16, which begins with its own mark.
void check_encoding(const std::string& path, std::string_view text);

/// Characters that the shortest digits of a number take at most: a double has 24, an integer 20.
inline constexpr std::size_t kMostDigits = 32;

/// Puts the shortest digits that read back equal, as float or as double, to where `text` has room
/// for kMostDigits; returns where they end.
char* put_number(char* text, double value, bool double_precision = true);
/// Append the same.
void append_number(std::string& text, double value, bool double_precision = true);
void append_integer(std::string& text, long long value);

/// Walks through the text of a file word by word, within a line or across lines, and knows the line
/// for messages. Lines end in LF or CRLF. For readers.
class TextCursor {
 public:
  /// What interrupts a line besides its end.
  struct Syntax {
    bool comments = false;       ///< a word that starts with '#' hides the rest of the line
    bool continuations = false;  ///< '\' at the end of a line joins the next one
  };

  /// Keeps references: both must outlive the cursor. `first_line` is what the text starts with.
  /// Throws IoError for text in UTF-16.
  TextCursor(const std::string& path, std::string_view text, Syntax syntax, int first_line = 1);

  int line() const { return line_; }
  /// Bytes not yet read.
  std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
  bool at_end() const { return at_ == end_; }

  /// The next word of this line; empty where there is none.
  std::string_view word();
  /// The next word of this or a later line; empty at the end of the text.
  std::string_view word_anywhere();
  /// What is left of this line, without the blanks around it; moves to the next line.
  std::string_view rest_of_line();
  void next_line();

  /// `word` as a number. Throws IoError that says where `what` was expected.
  double number(std::string_view word, std::string_view what) const;
  long long integer(std::string_view word, std::string_view what) const;

  /// Throws IoError where a word is left.
  void expect_end();

  /// Throws IoError with path and line.
  [[noreturn]] void fail(const std::string& message) const;
  /// "expected X, found 'word'", or "found nothing" for an empty word.
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
