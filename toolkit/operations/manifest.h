#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/written_files.h"
#include "toolkit/mesh/parameter.h"

namespace mimetra {

/// Facts about a run, before its outputs are written.
struct FinishedRun {
  std::string operation;
  Parameters parameters;
  /// As typed on a command line, without the program's name.
  std::vector<std::string> arguments;
  /// The user's texts for the inputs, by name of the input.
  std::map<std::string, std::vector<std::string>> named_inputs;
  /// Names of values that the host gave, by name of the input.
  std::map<std::string, std::vector<std::string>> given_inputs;
  std::vector<std::filesystem::path> inputs;  ///< files and folders that were read
  std::vector<std::filesystem::path> outputs;
  double read_seconds = 0;
  double run_seconds = 0;
  double peak_memory = 0;  ///< bytes
};

/// Returns the manifest of a run as JSON: versions, arguments, the value of every option, inputs
/// with their hashes, timings, and the result. `report` is the operation's JSON.
std::string manifest(const FinishedRun& run, const std::string& report);

/// Name of the manifest of an output. It is mimetra-run.json in a folder, and NAME.run.json for a
/// file NAME.EXT. If NAME.run.json belongs to another output, it is NAME.EXT.run.json. Throws
/// OutputError if both belong to other outputs.
std::string manifest_name(const std::filesystem::path& output, bool is_folder);

/// The facts that a manifest records about a run.
struct RunRecord {
  std::filesystem::path manifest;
  std::string operation;
  /// The user's texts for the inputs, by name of the input.
  std::map<std::string, std::vector<std::string>> inputs;
  std::map<std::string, std::string> options;  ///< text by name; "" for an option without a value
  std::vector<std::filesystem::path> files;    ///< files that the run read
  std::vector<std::filesystem::path> changed;  ///< files with other contents than at the run
  std::vector<std::string> arguments;          ///< as typed
};

/// Finds the run of transfer, evaluate or regions that looked for regions and wrote `path`. `path`
/// is a folder, a file with NAME.run.json beside it, or the manifest itself. In a folder without a
/// manifest, the only such run of transfer counts, or else of evaluate, or else of regions.
///
/// Throws IoError if no run has written `path`, and for a file that the run read and that no longer
/// exists. Throws MismatchError for other runs, and lists the runs if a folder contains several.
RunRecord read_run(const std::filesystem::path& path);

/// True for the manifest of a run that wrote an output of this file name.
bool is_manifest_of(const std::filesystem::path& manifest, const std::filesystem::path& output);

/// True for the manifest of a run of this operation.
bool is_manifest_of_operation(const std::filesystem::path& manifest, const std::string& operation);

/// True for the file names of manifests beside an output or in its folder.
bool accompanies_an_output(const std::filesystem::path& manifest);

/// Files of the inputs: files themselves, the files read of models, and the files below other
/// folders. The files of each input are sorted by name.
std::vector<std::filesystem::path> input_files(const std::vector<std::filesystem::path>& inputs);

/// XXH3 of a file's size and its first and last 64 kB; 0 if it cannot be read.
std::uint64_t hash_of_ends(const std::filesystem::path& path);

}  // namespace mimetra
