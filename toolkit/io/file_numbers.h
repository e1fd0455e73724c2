#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// Which numbers files have by their names. Internal to frame_series.h and frame_files.h.
namespace mimetra {

/// "smile_0012.v.OBJ" is number 12 of the series "smile_*.v.obj".
struct NumberedName {
  std::string series;     ///< empty for a name without a number
  long long number = 0;   ///< of decimal numbers in units of the last decimal, at most the ninth
  std::string text = {};  ///< as the name has it, "0012", "-12" or "0.25"
};

/// Whether a '-' behind `before` in a name is the sign of a number: where it begins the name or
/// follows '_', '.' or '-'. "smile_-12.obj" has the number -12, "smile-12.obj" has 12.
bool minus_is_sign(std::string_view before);

/// The last number of a name.
NumberedName numbered(const std::filesystem::path& file);

/// The numbers of files beside each other. Two numbers with a point between them are a decimal
/// number where the files say so: decimals begin with 0 and others are shorter (0.033, 0.1), or all
/// are evenly spaced, and their integer parts or counts of decimals differ (0.25, 0.5, 0.75, 1.0).
/// Numbers without a point are of such a series, too (9, 9.5, 10), also 0 before 0.5. Where digits
/// behind the point end with 0 and others are shorter (1.8, 1.9, 1.10), or half of the whole
/// numbers between the first and the last are there (1.8, 1.9, 1.11), they are whole numbers.
class FileNumbers {
 public:
  explicit FileNumbers(const std::vector<std::filesystem::path>& files);

  /// \pre one of the files
  const NumberedName& of(const std::filesystem::path& file) const { return names_.at(file); }
  bool is_decimal(const std::string& series) const { return decimal_series_.contains(series); }

 private:
  std::map<std::filesystem::path, NumberedName> names_;
  std::set<std::string> decimal_series_;
};

/// Sorts files in the natural order of their names, and those of one series in a folder by their
/// numbers.
void sort_by_numbers(std::vector<std::filesystem::path>& files);

/// Neighbours that would change places if they had decimal numbers.
struct UnclearOrder {
  std::filesystem::path first, second;
};

/// The first of them where nothing tells whether they have: 0.5 and 0.25 of 0.1, 0.5, 0.25, 0.75.
/// \pre `sorted` as by sort_by_numbers
std::optional<UnclearOrder> unclear_order(const std::vector<std::filesystem::path>& sorted);

}  // namespace mimetra
