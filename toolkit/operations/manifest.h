#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "toolkit/operations/operation.h"

namespace mimetra {

/// What happened before the outputs of a run are written.
struct FinishedRun {
  std::string operation;
  Parameters parameters;
  /// As typed on a command line, without the program's name.
  std::vector<std::string> arguments;
  /// What was read, as the user named it, by name of the input.
  std::map<std::string, std::vector<std::string>> named_inputs;
  /// What values that a host had were called, by name of the input.
  std::map<std::string, std::vector<std::string>> given_inputs;
  std::vector<std::filesystem::path> inputs;  ///< files and folders that were read
  std::vector<std::filesystem::path> outputs;
  double read_seconds = 0;
  double run_seconds = 0;
  double peak_memory = 0;  ///< bytes
};

/// The manifest of a run: versions, arguments, the value of every option, inputs with their hashes,
/// timings, and the result, as JSON. `report` is the operation's JSON.
std::string manifest(const FinishedRun& run, const std::string& report);

/// Name of the manifest of an output: mimetra-run.json in a folder; NAME.run.json for a file
/// NAME.EXT, or NAME.EXT.run.json where the former is there and is not of this output. Throws
/// OutputError where both are there and of others.
std::string manifest_name(const std::filesystem::path& output, bool is_folder);

}  // namespace mimetra
