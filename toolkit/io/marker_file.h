#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/correspondence/markers.h"

namespace mimetra {

/// Markers read from a file, and the line number of each. With two lists, that line is the source
/// list's.
struct MarkerFile {
  std::vector<Marker> markers;
  std::vector<int> lines;
};

/// Reads pairs of a source and a target vertex. `#` begins a comment. The file has one of two
/// forms:
///  - One pair a line, separated by a comma, a colon or blanks, as in `.corr` files and YAML lists
///    (`- 12:34`). A first line with the number of pairs may come before them (`.cons`).
///  - Two lines with all source and all target vertices, `source: [12, 56]` and `target: [34, 78]`.
///    The names may be missing.
///
/// Vertices count from `index_base` (0 or 1) in the file, and from 0 in the result.
///
/// Throws IoError with the line if a line is not a pair or a vertex is below the base. Also throws
/// it if the number of pairs is 0 or differs from the announced one. check_markers() checks that
/// the meshes have these vertices.
MarkerFile read_marker_file(const std::filesystem::path& path, int index_base = 0);
/// Markers of read_marker_file(), without their lines.
std::vector<Marker> read_markers(const std::filesystem::path& path, int index_base = 0);

/// Text that read_markers() reads: one pair a line, counted from 0, after the lines of `header`.
/// `comments` has one entry for each marker, or none.
std::string marker_text(const std::vector<Marker>& markers,
                        const std::vector<std::string>& comments = {},
                        const std::vector<std::string>& header = {});

}  // namespace mimetra
