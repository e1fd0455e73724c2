#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

/// Which files are frames, and what is odd about them.
namespace mimetra {

/// The frames of a sequence of mesh files, in natural order.
struct FrameSeries {
  std::vector<std::filesystem::path> frames;
  /// A file `neutral.*` among the frames of a folder; none where it is the only file.
  std::optional<std::filesystem::path> rest = {};
  /// Files that are left out, numbers that are missing.
  std::vector<std::string> notes = {};
};

/// Whether a file is called neutral.*, in any case.
bool is_neutral(const std::filesystem::path& file);

/// The frames and the rest pose of series_in_folder, without notes and errors.
FrameSeries frames_among(std::vector<std::filesystem::path> files);

/// Takes `neutral.*` out of the files of a folder as the rest pose, and files that are not of the
/// numbered series that most of the files are of. Throws IoError where two frames have one number,
/// their order is unclear (file_numbers.h), or one is a link that leads nowhere.
FrameSeries series_in_folder(std::vector<std::filesystem::path> files,
                             const std::filesystem::path& folder);

/// Throws IoError where `files` are of several numbered series and none has more than half of them.
void check_one_series(const std::vector<std::filesystem::path>& files,
                      const std::filesystem::path& folder);

/// Throws MismatchError if half of `files` or more have no number that others count on from, such
/// as the named shapes of a model.
void check_are_numbered(const std::vector<std::filesystem::path>& files,
                        const std::filesystem::path& folder);

/// All `files` are frames, in the order of numbers that are known to be whole by a printf pattern.
/// Throws as series_in_folder.
FrameSeries series_of_pattern(std::vector<std::filesystem::path> files, const std::string& pattern,
                              bool are_whole_numbers);

/// Numbers between those of files of one series that none of them has, as "7" or "9 to 12"; none
/// for other files, and where a number occurs twice. They may count by any step.
std::vector<std::string> missing_numbers(const std::vector<std::filesystem::path>& files);
std::vector<std::string> missing_numbers(std::vector<long long> numbers);

/// Whether a column or key of this name holds numbers of frames: "frame", "frame_index",
/// "frame_number" and the like, in any case.
bool holds_frame_numbers(const std::string& name);

/// What numbers of frames say of rows that have no times.
struct RowNumbers {
  long long step = 1;     ///< frames from one row to the next
  std::string note = {};  ///< on frames that no row has; "" for none
};

/// Rows count by the least step between them where it divides all others. Without numbers, and
/// where some do not rise, they count by 1.
RowNumbers row_numbers(const std::vector<long long>& numbers);

/// Seconds since the first of `rows` at `fps` frames per second, by their numbers where each has
/// one and they rise.
Eigen::VectorXd times_at_rate(double fps, Eigen::Index rows, const std::vector<long long>& numbers);

/// What numbered files have in common, "smile_*.obj" for smile_0012.OBJ; "" for one without a
/// number.
std::string series_name(const std::filesystem::path& file);

/// Throws IoError for a link that leads nowhere.
void check_links(const std::vector<std::filesystem::path>& files);

}  // namespace mimetra
