#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Numbers in the names of files. Internal to frame_series.h and frame_files.h.
namespace mimetra {

/// Series and number of a file name: "smile_0012.v.OBJ" is number 12 of the series "smile_*.v.obj".
struct NumberedName {
  std::string series;  ///< empty if the name has no number
  long long number = 0;
  std::string text = {};  ///< the number as written, "0012" or "-12"
};

/// True if a '-' that follows `before` in a name is the sign of a number: at the start of the name
/// or after '_', '.' or '-'. "smile_-12.obj" has the number -12, "smile-12.obj" has 12.
bool minus_is_sign(std::string_view before);

/// Splits a name at its last number. The series is empty if there is no number or it is too large.
NumberedName numbered(const std::filesystem::path& file);

/// Sorts files in the natural order of their paths, and files of one series in a folder by their
/// numbers.
void sort_by_numbers(std::vector<std::filesystem::path>& files);

/// Two neighbours that change places if the numbers are decimals: 0.5 and 0.25 in 0.1, 0.5, 0.25.
struct UnclearOrder {
  std::filesystem::path first, second;
};

/// First such neighbours; none if the order is the same either way. \pre `sorted` is sorted by
/// sort_by_numbers
std::optional<UnclearOrder> unclear_order(const std::vector<std::filesystem::path>& sorted);

}  // namespace mimetra
