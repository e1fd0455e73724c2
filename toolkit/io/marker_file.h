#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/correspondence/markers.h"

namespace mimetra {

/// Markers of a file, and the line that each stands in (of two lists that of the source's).
struct MarkerFile {
  std::vector<Marker> markers;
  std::vector<int> lines;
};

/// Reads pairs of vertices, source and target, as people write them: a line each, with a comma, a
/// colon or blanks between (`.corr`, YAML's `- 12:34`), after a line with their number or not
/// (`.cons`); or two lines with all of the source and all of the target, as `source: [12, 56]` and
/// `target: [34, 78]` or without names. `#` begins a comment. Vertices are counted from
/// `index_base` in the file, 0 or 1, and from 0 in the result.
///
/// Throws IoError that names the line of what is no such pair, a vertex below the base, another
/// number of pairs than announced, or no pair at all. Whether a mesh has the vertices is for
/// check_markers().
MarkerFile read_marker_file(const std::filesystem::path& path, int index_base = 0);
/// Its markers alone.
std::vector<Marker> read_markers(const std::filesystem::path& path, int index_base = 0);

/// The same as text that read_markers() reads: a pair a line, counted from 0, each with its
/// `comments` (as many as markers, or none), after lines of `header`.
std::string marker_text(const std::vector<Marker>& markers,
                        const std::vector<std::string>& comments = {},
                        const std::vector<std::string>& header = {});

}  // namespace mimetra
