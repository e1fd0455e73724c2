#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "toolkit/io/written_files.h"
#include "toolkit/operations/parameter.h"

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

/// What a manifest says about a run.
struct RunRecord {
  std::filesystem::path manifest;
  std::string operation;
  /// What the user named, by name of the input.
  std::map<std::string, std::vector<std::string>> inputs;
  std::map<std::string, std::string> options;  ///< text by name; "" for one that has no value
  std::vector<std::filesystem::path> files;    ///< that it read
  std::vector<std::filesystem::path> changed;  ///< those of them with another content now
  std::vector<std::string> arguments;          ///< as typed
};

/// The run of transfer, evaluate or regions that looked for regions and wrote `path`: a folder, a
/// file with NAME.run.json beside it, or the manifest itself. A folder without a manifest stands
/// for the one such run of transfer in it, or else of evaluate, or else of regions. Throws IoError
/// for what no run has written, and for a file that the run read and that is no longer there;
/// MismatchError for other runs, and where a folder holds several, which it lists.
RunRecord read_run(const std::filesystem::path& path);

/// True for the manifest of a run that wrote an output of this file name.
bool is_manifest_of(const std::filesystem::path& manifest, const std::filesystem::path& output);

/// True for the manifest of a run of that operation.
bool is_manifest_of_operation(const std::filesystem::path& manifest, const std::string& operation);

/// True for a name that manifests beside an output, or in its folder, have.
bool accompanies_an_output(const std::filesystem::path& manifest);

/// The files of what was named: files, what is read of models, and the files below other folders,
/// those of each in order of their names.
std::vector<std::filesystem::path> input_files(const std::vector<std::filesystem::path>& inputs);

/// XXH3 of a file's size and its first and last 64 kB; 0 where it cannot be read.
std::uint64_t hash_of_ends(const std::filesystem::path& path);

}  // namespace mimetra
