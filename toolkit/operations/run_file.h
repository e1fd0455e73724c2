#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "toolkit/io/written_files.h"

namespace mimetra {

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

}  // namespace mimetra
