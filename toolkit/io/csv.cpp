#include "toolkit/io/csv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// Position of the separator that ends the first field; npos for the last field.
std::size_t end_of_field(std::string_view line, char separator) {
  const auto first = line.find_first_not_of(" \t");
  bool quoted = first != std::string_view::npos && line[first] == '"';
  if (!quoted) return line.find(separator);
  for (std::size_t i = first + 1; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == separator && !quoted) return i;
  }
  return std::string_view::npos;
}

/// Returns the separator that ends the first name of a line.
char separator_of(std::string_view names) {
  return end_of_field(names, ';') < end_of_field(names, ',') ? ';' : ',';
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto end = end_of_field(line, separator);
    std::string_view field = without_blanks(line.substr(0, end));
    if (field.starts_with('"')) field.remove_prefix(1);
    if (field.ends_with('"')) field.remove_suffix(1);
    fields.push_back(without_blanks(field));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

/// Parses a finite number with a decimal point. If commas do not separate the fields, a decimal
/// comma is accepted as well.
std::optional<double> number_in(std::string_view field, char separator) {
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  std::string with_point(field);
  if (separator != ',' && field.find('.') == std::string_view::npos) {
    std::ranges::replace(with_point, ',', '.');
  }
  double value = 0;
  const char* last = with_point.data() + with_point.size();
  const auto [end, error] = std::from_chars(with_point.data(), last, value);
  if (error != std::errc() || end != last || !std::isfinite(value)) return {};
  return value;
}

/// Removes the empty field that a separator at the end of a line makes. Returns false if there is
/// none.
bool drop_last_if_empty(std::vector<std::string_view>& fields) {
  const bool ends_in_separator = fields.size() > 1 && fields.back().empty();
  if (ends_in_separator) fields.pop_back();
  return ends_in_separator;
}

/// True if a line is a row of as many fields as `names`, each a number, NaN or empty. Without any
/// number it needs at least two NaN, as in a track that begins with a lost face. A header never has
/// two columns named NaN.
bool is_row_of(const std::vector<std::string_view>& names, std::string_view line, char separator) {
  auto fields = fields_of(line, separator);
  if (fields.size() > names.size()) drop_last_if_empty(fields);
  if (fields.size() != names.size() || fields.size() < 2) return false;
  const auto is_number = [separator](std::string_view field) {
    return number_in(field, separator).has_value();
  };
  const auto is_nan = [](std::string_view field) {
    return lower_case(std::string(field)) == "nan";
  };
  return (std::ranges::any_of(fields, is_number) || std::ranges::count_if(fields, is_nan) > 1) &&
         std::ranges::all_of(fields, [&](std::string_view field) {
           return field.empty() || is_nan(field) || is_number(field);
         });
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",;\"") == std::string::npos && !text.starts_with('#')) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

std::string text_of_csv(std::string_view field) {
  std::string text;
  for (std::size_t i = 0; i < field.size(); ++i) {
    text += field[i];
    if (field.substr(i, 2) == "\"\"") ++i;
  }
  return text;
}

CsvReader::CsvReader(const std::filesystem::path& path)
    : path_(path.string()),
      bytes_(read_file(path)),
      text_(path_, without_byte_order_mark(bytes_), {}) {
  const std::string_view line = next_line();
  if (line.empty()) throw IoError(path_, "is empty; expected a line of column names");
  separator_ = separator_of(comment_);
  names_ = fields_of(comment_, separator_);
  names_end_in_separator_ = drop_last_if_empty(names_);
  if (is_row_of(names_, line, separator_)) {
    unread_row_ = line;
    return;
  }
  separator_ = separator_of(line);
  names_ = fields_of(line, separator_);
  names_end_in_separator_ = drop_last_if_empty(names_);
}

bool CsvReader::next_row(Rows rows) {
  const std::string_view unread = std::exchange(unread_row_, {});
  const std::string_view line = unread.empty() ? next_line() : unread;
  if (line.empty()) return false;
  row_ = fields_of(line, separator_);
  if (row_.size() == names_.size() + 1) {
    if (row_.back().empty())
      row_.pop_back();
    else if (names_end_in_separator_)
      fail("column " + std::to_string(row_.size()) + " has no name");
  }
  given_ = row_.size();
  const bool may_be_short = rows == Rows::may_end_early && given_ < names_.size();
  if (given_ != names_.size() && !may_be_short) fail_of_size();
  row_.resize(names_.size());
  return true;
}

void CsvReader::fail_of_size() const {
  fail(std::to_string(given_) + (given_ == 1 ? " field" : " fields") + ", expected " +
       std::to_string(names_.size()) + " as in the first line" +
       (given_ > names_.size() ? " (decimal commas need ';' between fields)" : ""));
}

double CsvReader::number(std::size_t column) const {
  if (column >= given_) fail_of_size();
  const auto value = number_in(row_[column], separator_);
  if (!value) {
    fail("column '" + std::string(names_[column]) + "': expected a finite number, found '" +
         std::string(row_[column]) + "'");
  }
  return *value;
}

void CsvReader::fail(const std::string& message) const {
  throw IoError(path_, "line " + std::to_string(line_) + ": " + message);
}

std::string_view CsvReader::next_line() {
  while (!text_.at_end()) {
    line_ = text_.line();
    const std::string_view line = text_.rest_of_line();
    if (line.empty()) continue;
    if (line.front() != '#') return line;
    comment_ = without_blanks(line.substr(1));
  }
  return {};
}

}  // namespace mimetra
