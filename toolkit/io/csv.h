#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/text_cursor.h"

/// Comma-separated values, for readers and writers: a line of column names, then rows with as many
/// fields. If ';' separates the names, it also separates the fields, and numbers may have decimal
/// commas.
namespace mimetra {

/// Returns `text` as a field: in quotation marks if it contains ',', ';' or '"' or starts with '#'.
std::string csv_field(const std::string& text);

/// Returns the text of a field of CsvReader, with doubled quotation marks undone.
std::string text_of_csv(std::string_view field);

/// Reads a file row by row. Lines end in LF or CRLF. Blank lines, lines that begin with '#' and a
/// separator at the end of a line are skipped. As in NumPy's files, the names may be in a comment
/// before the first row. That row must then have as many fields, at least two, and contain numbers.
class CsvReader {
 public:
  /// Reads the column names. Throws IoError if there are none.
  explicit CsvReader(const std::filesystem::path& path);
  CsvReader(const CsvReader&) = delete;
  CsvReader& operator=(const CsvReader&) = delete;

  /// Column names, without surrounding blanks and quotation marks; quotation marks inside stay
  /// doubled.
  const std::vector<std::string_view>& names() const { return names_; }

  /// Whether a row may end early; its missing fields are empty then.
  enum class Rows { are_whole, may_end_early };

  /// Moves to the next row. Returns false at the end of the file. Throws IoError if the number of
  /// fields does not match the names.
  bool next_row(Rows rows = Rows::are_whole);

  /// Field of the row, in the form of names().
  std::string_view field(std::size_t column) const { return row_[column]; }
  /// False if the row ends before this column.
  bool is_given(std::size_t column) const { return column < given_; }
  /// Number in a field, with a decimal point or, in files with ';', a decimal comma. Throws IoError
  /// if the field is not a finite number.
  double number(std::size_t column) const;

  /// Line of the row, from 1. Before the first row: the line that ended the search for the names.
  int line() const { return line_; }

  /// Throws IoError with the path and line().
  [[noreturn]] void fail(const std::string& message) const;

 private:
  [[noreturn]] void fail_of_size() const;
  /// Next line that is neither blank nor a comment; empty at the end of the file.
  std::string_view next_line();

  std::string path_;
  std::string bytes_;
  TextCursor text_;
  int line_ = 0;
  std::string_view comment_;     ///< last skipped comment
  std::string_view unread_row_;  ///< first row, if the names are in a comment
  char separator_ = ',';
  std::vector<std::string_view> names_, row_;
  bool names_end_in_separator_ = false;
  std::size_t given_ = 0;  ///< number of fields on the row's line
};

}  // namespace mimetra
