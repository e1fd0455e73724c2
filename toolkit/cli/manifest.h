#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolkit/cli/command_line.h"

namespace mimetra::cli {

/// What happened before the outputs are written.
struct FinishedRun {
  std::vector<std::filesystem::path> inputs;
  std::vector<std::filesystem::path> outputs;
  double read_seconds = 0;
  double run_seconds = 0;
  double peak_memory = 0;  ///< bytes
  std::string report;      ///< the operation's JSON
};

/// The manifest of a run: versions, arguments, the value of every option, inputs with their hashes,
/// timings, and the result, as JSON.
std::string manifest(const Request& request, const FinishedRun& run);

/// Name of the manifest of an output: mimetra-run.json in a folder; NAME.run.json for a file
/// NAME.EXT, or NAME.EXT.run.json where the former is there and belongs to another output.
std::string manifest_name(const std::filesystem::path& output, bool is_folder);

}  // namespace mimetra::cli
