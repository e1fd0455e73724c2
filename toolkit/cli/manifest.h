#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <mimetra/cli/command_line.h>

namespace mimetra::cli {

/// What happened before the outputs are written.
struct RunRecord {
  std::vector<std::filesystem::path> inputs;
  double read_seconds = 0;
  double run_seconds = 0;
  double peak_memory = 0;  ///< bytes
  std::string report;      ///< the operation's JSON
};

/// The manifest of a run: versions, arguments, the value of every option, inputs with their hashes,
/// timings, and the result, as JSON.
std::string manifest(const Request& request, const RunRecord& record);

/// Name of the manifest of an output: NAME.run.json for a file NAME.EXT, mimetra-run.json in a
/// folder.
std::string manifest_name(const std::filesystem::path& output, bool is_folder);

}  // namespace mimetra::cli
