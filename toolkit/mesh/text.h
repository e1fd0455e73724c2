#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Formatting and ordering of names and numbers for users.
namespace mimetra {

/// Whether `c` is 0 to 9, in every locale.
inline bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Replaces A to Z by a to z.
std::string lower_case(std::string text);

/// Replaces a to z by A to Z.
std::string upper_case(std::string text);

/// Extension in small letters: ".ply" for NAME.PLY.
std::string lower_extension(const std::filesystem::path& path);

/// Compares names with runs of digits ordered by value, so that 2 comes before 10.
bool natural_less(const std::string& a, const std::string& b);

/// Joins words with `between`, but with `last` before the last one: "2, 5 and 7".
std::string joined(const std::vector<std::string>& words, std::string_view between,
                   std::string_view last);
std::string joined(const std::vector<std::string>& words, std::string_view between = ", ");

/// Joins at most `most` words and counts the rest: "a, b, c and 12 more".
std::string listed(const std::vector<std::string>& words, std::size_t most = 8);

/// Numbers as words: "0", "5", "17".
std::vector<std::string> words_of(const std::vector<int>& numbers);

/// `value` with `digits` significant digits, or more if it needs them before the point and is below
/// a million. The decimal point is '.' in every locale.
std::string readable(double value, int digits = 4);

/// `value` with `decimals` digits after the point, which is '.' in every locale.
std::string fixed(double value, int decimals);

/// Share as a percentage: 0.1234 is "12.3 %".
std::string percent(double share);

/// Number of bytes of the UTF-8 character at the start of `text`. Returns 0 for an invalid
/// character, a control character, or one that changes the direction of writing. \pre not empty
std::size_t printable_bytes(std::string_view text);

/// Whether `text` consists only of such characters.
bool is_printable(std::string_view text);

/// Known word nearest to `word` by edit distance, ignoring case. Empty if none is near enough. Ties
/// go to the earlier word.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// "; did you mean 'WORD'?" with the nearest_word(), to end a message; empty if there is none.
std::string suggestion_for(const std::string& word, const std::vector<std::string>& known);

/// `text` escaped for XML and HTML, both between tags and in attributes.
std::string escaped_for_xml(const std::string& text);

}  // namespace mimetra
