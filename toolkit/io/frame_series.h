#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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
/// or one is a link that leads nowhere.
FrameSeries series_in_folder(std::vector<std::filesystem::path> files,
                             const std::filesystem::path& folder);

/// Throws IoError where `files` are of several numbered series and none has more than half of them.
void check_one_series(const std::vector<std::filesystem::path>& files,
                      const std::filesystem::path& folder);

/// All `files` are frames. Throws as series_in_folder.
FrameSeries series_of_pattern(std::vector<std::filesystem::path> files, const std::string& pattern);

/// Numbers between those of files of one series that none of them has, as "7" or "9 to 12"; none
/// for other files, and where a number occurs twice. They may count by any step.
std::vector<std::string> missing_numbers(const std::vector<std::filesystem::path>& files);
std::vector<std::string> missing_numbers(std::vector<long long> numbers);

/// What numbered files have in common, "smile_*.obj" for smile_0012.OBJ; "" for one without a
/// number.
std::string series_name(const std::filesystem::path& file);

/// Throws IoError for a link that leads nowhere.
void check_links(const std::vector<std::filesystem::path>& files);

}  // namespace mimetra
