#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/io/format.h"
#include "toolkit/io/frame_series.h"

/// Files and frames that the name of a sequence refers to.
namespace mimetra {

/// Suffixes of the files that belong to a sequence: they follow the sequence's own name.
inline constexpr const char* kRestSuffix = ".rest.ply";
inline constexpr const char* kTimesSuffix = ".times.csv";
inline constexpr const char* kTopologySuffix = ".topology.ply";

/// Extensions of files that store positions and may have such files beside them.
inline constexpr std::array<std::string_view, 6> kExtensionsWithCompanions = {
    ".npy", ".npz", ".pc2", ".mdd", ".h5", ".hdf5"};
/// True if the path has one of these extensions, in any case.
bool has_companions(const std::filesystem::path& path);

/// True if the name ends like a sequence's rest pose or topology.
bool is_companion(const std::filesystem::path& file);

/// True if the text contains `*` or `?`, or its file name a number such as `%04d`.
bool is_frame_pattern(const std::string& text);

/// Files of a folder, without hidden ones, or files that match a glob or printf pattern; maybe
/// none. They are in natural order. Throws IoError if the folder cannot be read.
std::vector<std::filesystem::path> files_named(const std::string& text);

/// Extensions of files_named() in lower case.
std::set<std::string> extensions_named(const std::string& text);

/// Note on a printf pattern that matches some files and leaves out others with more or fewer
/// digits. The note suggests a pattern that takes all. Returns "" for other patterns.
std::string note_on_digits(const std::string& pattern);

/// Returns the files with these extensions that match a glob or printf pattern, in natural order.
/// Skips rest poses and topologies of other sequences, unless the pattern ends in their suffix.
/// Throws IoError if no file matches; the message suggests a pattern for files with other digits.
/// Also throws it for several formats, two files of one number, an unclear order, or a dangling
/// link.
FrameSeries frames_of_pattern(const std::string& pattern,
                              const std::vector<std::string>& extensions = mesh_extensions());

/// Returns the files of a folder with these extensions in natural order. Skips hidden files,
/// companions of other sequences, `neutral.*`, and files outside the numbered series that most
/// files belong to. Throws as frames_of_pattern(). Also throws IoError if there are several
/// numbered series and none has most of the files. Throws MismatchError if at least half of the
/// files have no frame numbers.
FrameSeries frames_of_folder(const std::filesystem::path& folder,
                             const std::vector<std::string>& extensions = mesh_extensions());

/// Frames that the folder would have if it contained only files of this extension; maybe none.
/// Reports nothing odd about them.
std::vector<std::filesystem::path> frames_of_format(const std::filesystem::path& folder,
                                                    const std::string& extension);

/// Indices of the frames that `range` ("A:B:STEP") selects; all frames without a range. Throws
/// std::invalid_argument for a malformed range, MismatchError if it exceeds the last frame.
std::vector<int> selected_frames(const std::optional<std::string>& range, int frames);

/// Index B of `range`, before which the selected frames end; none if it is open. Throws
/// std::invalid_argument for a malformed range.
std::optional<int> end_of_frames(const std::optional<std::string>& range);

/// Name such as "frame_0007.ply", for frame 7 of at most 10000. More frames have more digits.
std::string frame_name(int frame, int frames, const std::string& extension);

/// Returns `folder/NAME` + suffix for `folder/NAME`, `folder/NAME/` and `folder/NAME.npy`. Replaces
/// `.` and `..` by the folders they mean.
std::filesystem::path beside(const std::filesystem::path& sequence, const std::string& suffix);

/// Returns the name of `sequence` that has a file with the suffix beside it. If `sequence` itself
/// has none but the target of its link has one, returns that target. Otherwise returns `sequence`.
std::filesystem::path name_with(const std::filesystem::path& sequence, const std::string& suffix);

}  // namespace mimetra
