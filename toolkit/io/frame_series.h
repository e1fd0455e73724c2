#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

/// Choice of the files that are frames, and notes on oddities among them.
namespace mimetra {

/// The frames of a sequence of mesh files, in natural order.
struct FrameSeries {
  std::vector<std::filesystem::path> frames;
  /// The file `neutral.*` of a folder; none if there are several or it is the only file.
  std::optional<std::filesystem::path> rest = {};
  /// Notes, for example on files that are left out and numbers that are missing.
  std::vector<std::string> notes = {};
};

/// True if a file is called neutral.*, in any case.
bool is_neutral(const std::filesystem::path& file);

/// Frames and rest pose of series_in_folder(), without notes and errors.
FrameSeries frames_among(std::vector<std::filesystem::path> files);

/// Separates the files of a folder into `neutral.*` (the rest pose), frames, and files outside the
/// numbered series that most files belong to. Throws IoError if two frames have one number, the
/// order is unclear (file_numbers.h), or a frame is a dangling link.
FrameSeries series_in_folder(std::vector<std::filesystem::path> files,
                             const std::filesystem::path& folder);

/// Throws IoError if `files` form several numbered series and none has more than half of the files.
void check_one_series(const std::vector<std::filesystem::path>& files,
                      const std::filesystem::path& folder);

/// Throws MismatchError if at least half of `files` belong to no numbered series of two or more
/// files. Named shapes of a model, for example, have no numbers.
void check_are_numbered(const std::vector<std::filesystem::path>& files,
                        const std::filesystem::path& folder);

/// Takes all `files` as frames, in their order. `are_whole_numbers` says that a printf pattern
/// rules out decimals, so that the order is clear. Throws as series_in_folder().
FrameSeries series_of_pattern(std::vector<std::filesystem::path> files, const std::string& pattern,
                              bool are_whole_numbers);

/// Numbers that are missing in a series, as "7" or "9 to 12". The step between numbers may be any.
/// Returns none if a number occurs twice or the files are not of one series.
std::vector<std::string> missing_numbers(const std::vector<std::filesystem::path>& files);
std::vector<std::string> missing_numbers(std::vector<long long> numbers);

/// True if a column or key of this name contains frame numbers: "frame", "frame_index",
/// "frame_number" and similar names, in any case.
bool holds_frame_numbers(const std::string& name);

/// Timing of rows that have frame numbers but no times.
struct RowNumbers {
  long long step = 1;     ///< frames from one row to the next
  std::string note = {};  ///< frames that no row has; "" for none
};

/// Uses the smallest step between rows if it divides all other steps. The step is 1 without numbers
/// or if the numbers do not rise.
RowNumbers row_numbers(const std::vector<long long>& numbers);

/// Seconds since the first of `rows` (R) at `fps` frames per second. Follows the frame numbers if
/// every row has one and they rise.
Eigen::VectorXd times_at_rate(double fps, Eigen::Index rows, const std::vector<long long>& numbers);

/// Name of a file's series: "smile_*.obj" for smile_0012.OBJ, "" without a number.
std::string series_name(const std::filesystem::path& file);

/// Throws IoError if a file is a dangling link.
void check_links(const std::vector<std::filesystem::path>& files);

}  // namespace mimetra
