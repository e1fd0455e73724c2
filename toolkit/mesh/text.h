#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Names and numbers as people read and order them.
namespace mimetra {

/// True for 0 to 9, whatever the locale.
inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// A to Z become a to z.
std::string lower_case(std::string text);

/// a to z become A to Z.
std::string upper_case(std::string text);

/// ".ply" for NAME.PLY.
std::string lower_extension(const std::filesystem::path& path);

/// Orders names as people count: runs of digits by their value, so that 2 comes before 10.
bool natural_less(const std::string& a, const std::string& b);

/// The words with `between` between them, and `last` before the last one: "2, 5 and 7".
std::string joined(const std::vector<std::string>& words, std::string_view between,
                   std::string_view last);
std::string joined(const std::vector<std::string>& words, std::string_view between = ", ");

/// The first of many: "a, b, c and 12 more".
std::string listed(const std::vector<std::string>& words, std::size_t most = 8);

/// 0, 5, 17 as words.
std::vector<std::string> words_of(const std::vector<int>& numbers);

/// `value` with `digits` significant digits, below a million with all before the point; with a
/// decimal point in every locale.
std::string readable(double value, int digits = 4);

/// `value` with `decimals` digits after the point, in every locale.
std::string fixed(double value, int decimals);

/// A share as a percentage: 0.1234 is "12.3 %".
std::string percent(double share);

/// Bytes of the character in UTF-8 that `text` begins with; 0 where it begins with a control
/// character, with one that turns the direction of writing, or with none. \pre not empty
std::size_t printable_bytes(std::string_view text);

/// True where all of it is such characters.
bool is_printable(std::string_view text);

/// The known word nearest to `word` by edit distance, capital or not, where it is near enough to be
/// meant; empty otherwise. Ties go to the earlier word.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// "; did you mean 'WORD'?" with that one, to end a message; empty where there is none.
std::string suggestion_for(const std::string& word, const std::vector<std::string>& known);

/// `text` as XML and HTML hold it, between tags and in attributes.
std::string escaped_for_xml(const std::string& text);

}  // namespace mimetra
