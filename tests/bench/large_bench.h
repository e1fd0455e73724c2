#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mimetra::bench {

/// Where the time of a decomposition of the built-in head goes, its triangles split in four some
/// times.
struct LargeRow {
  int vertices = 0, frames = 0, count = 0;
  /// Seconds of distances: the factors, and what is asked of them.
  double setup = 0, queries = 0;
  int sources = 0;  ///< vertices that distances were asked from
  /// Seconds of the motion and the start, and of all iterations, without distances.
  double start = 0, iterations = 0;
  /// Of the command, from the .npy to the .h5, with the error: seconds, and the most memory it
  /// held.
  double command = 0, peak_bytes = 0;
  double predicted_bytes = 0;  ///< by the command's --dry-run
};

/// 200 frames with 40 components; `quick`: the head as it is, with few. What is read and written is
/// in `scratch`: at most 5.5 GB.
std::vector<LargeRow> large_rows(const std::filesystem::path& mimetra,
                                 const std::filesystem::path& scratch, bool quick);

/// In Markdown.
std::string table_of(const std::vector<LargeRow>& rows);

}  // namespace mimetra::bench
