#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Which numbers files have by their names. Internal to frame_series.h and frame_files.h.
namespace mimetra {

/// "smile_0012.v.OBJ" is number 12 of the series "smile_*.v.obj".
struct NumberedName {
  std::string series;  ///< empty for a name without a number
  long long number = 0;
  std::string text = {};  ///< as the name has it, "0012" or "-12"
};

/// Whether a '-' behind `before` in a name is the sign of a number: where it begins the name or
/// follows '_', '.' or '-'. "smile_-12.obj" has the number -12, "smile-12.obj" has 12.
bool minus_is_sign(std::string_view before);

/// The last number of a name.
NumberedName numbered(const std::filesystem::path& file);

/// Sorts files in the natural order of their names, and those of one series in a folder by their
/// numbers.
void sort_by_numbers(std::vector<std::filesystem::path>& files);

/// Neighbours that would change places if a point before their number made it decimal, as 0.5 and
/// 0.25 of 0.1, 0.5, 0.25.
struct UnclearOrder {
  std::filesystem::path first, second;
};

/// The first of them; none where files are in the same order either way. \pre `sorted` as by
/// sort_by_numbers
std::optional<UnclearOrder> unclear_order(const std::vector<std::filesystem::path>& sorted);

}  // namespace mimetra
