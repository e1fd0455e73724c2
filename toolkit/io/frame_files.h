#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/frame_series.h"

/// Which files and which frames a sequence's name means.
namespace mimetra {

/// What follows a sequence's name in the names of the files beside it that belong to it.
inline constexpr const char* kRestSuffix = ".rest.ply";
inline constexpr const char* kTimesSuffix = ".times.csv";
inline constexpr const char* kTopologySuffix = ".topology.ply";

/// True for a mesh beside a sequence that belongs to it: its rest pose or its faces.
bool is_companion(const std::filesystem::path& file);

/// True for text with `*`, `?` or `%04d` that names files only by way of a pattern.
bool is_frame_pattern(const std::string& text);

/// The files of a folder, hidden ones left out, or those that a glob or printf pattern matches, in
/// natural order; maybe none. Throws IoError for a folder that cannot be read.
std::vector<std::filesystem::path> files_named(const std::string& text);

/// What to say of a printf pattern that matches some files and leaves out others with more or fewer
/// digits, and the pattern that takes all; "" where there are none.
std::string note_on_digits(const std::string& pattern);

/// The mesh files that a glob or printf pattern matches, in natural order. Throws IoError where
/// there is none, with the pattern of those whose numbers have other digits, they are of several
/// formats, two have one number, nothing tells their order, or one is a link that leads nowhere.
/// Rest poses and topologies of other sequences are no frames, unless the pattern asks for them by
/// their suffix.
FrameSeries frames_of_pattern(const std::string& pattern);

/// The mesh files of a folder, hidden ones and those that belong to other sequences left out, in
/// natural order; `neutral.*` and strangers to the numbered ones are no frames. Throws as
/// frames_of_pattern, and where they are of several numbered series and mainly of none.
FrameSeries frames_of_folder(const std::filesystem::path& folder);

/// Those that it would have if it held files of this extension only, whatever is odd about them;
/// maybe none.
std::vector<std::filesystem::path> frames_of_format(const std::filesystem::path& folder,
                                                    const std::string& extension);

/// Indices of the frames that `range` ("A:B:STEP") takes of `frames`; all without one. Throws
/// std::invalid_argument for what is not a range, MismatchError for one beyond the last frame.
std::vector<int> selected_frames(const std::optional<std::string>& range, int frames);

/// B of `range`, before which the chosen frames end; none where it is left open. Throws
/// std::invalid_argument for what is not a range.
std::optional<int> end_of_frames(const std::optional<std::string>& range);

/// "frame_0007.ply" for frame 7 of up to 10000, more digits where four do not suffice.
std::string frame_name(int frame, int frames, const std::string& extension);

/// `folder/NAME` + suffix for `folder/NAME`, `folder/NAME/` and `folder/NAME.npy`; for `.` and `..`
/// what these stand for.
std::filesystem::path beside(const std::filesystem::path& sequence, const std::string& suffix);

/// The name of `sequence` beside which a file with the suffix stands: where nothing stands beside a
/// link, what it leads to; the given name where neither has one.
std::filesystem::path name_with(const std::filesystem::path& sequence, const std::string& suffix);

}  // namespace mimetra
