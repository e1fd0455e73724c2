#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/text_cursor.h"

/// Comma-separated values: a line of column names, then rows of as many fields. For readers and
/// writers. Where the names are separated by ';', as where commas are decimal, so are the rows.
namespace mimetra {

/// `text` as a field: in quotation marks where it would be read as something else.
std::string csv_field(const std::string& text);

/// The text of a field as CsvReader has it.
std::string text_of_csv(std::string_view field);

/// Reads a file row by row. Lines end in LF or CRLF; those that are blank or begin with '#' are
/// passed over, and so is a separator that ends them. The names may stand behind a '#', as NumPy
/// writes them, before a line of two numbers and more.
class CsvReader {
 public:
  /// Reads the column names. Throws IoError where there are none.
  explicit CsvReader(const std::filesystem::path& path);
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  /// Without the blanks and quotation marks around them; those inside stay doubled.
  const std::vector<std::string_view>& names() const { return names_; }

  /// Whether the last fields of a row may be missing, and are empty then.
  enum class Rows { are_whole, may_end_early };

  /// Moves to the next row; false where there is none. Throws IoError for one that has not a field
  /// for each name.
  bool next_row(Rows rows = Rows::are_whole);

  /// A field of the row, as names() are.
  std::string_view field(std::size_t column) const { return row_[column]; }
  /// False for one that the row ends before.
  bool is_given(std::size_t column) const { return column < given_; }
  /// Throws IoError where the field is not a finite number. Behind ';' it may have a decimal comma.
  double number(std::size_t column) const;

  /// Of the row, or of the names before the first one; from 1.
  int line() const { return line_; }

  /// Throws IoError with the path and the line of the row, or of the names before the first one.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void fail_of_size() const;
  /// The next line that is neither blank nor a comment; empty at the end of the file.
  std::string_view next_line();

  std::string path_;
  std::string bytes_;
  TextCursor text_;
  int line_ = 0;
  std::string_view comment_;     ///< the last one that was passed over
  std::string_view unread_row_;  ///< the first line, where the names stand in a comment
  char separator_ = ',';
  std::vector<std::string_view> names_, row_;
  bool names_end_in_separator_ = false;
  std::size_t given_ = 0;  ///< fields of the row that its line has
};

}  // namespace mimetra
