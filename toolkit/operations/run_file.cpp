#include "toolkit/operations/run_file.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "toolkit/io/missing_path.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/file_hash.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFileManifest = ".run.json";
/// What looks for regions; of several runs in a folder the first kind counts.
constexpr std::array<std::string_view, 3> kOperations = {"transfer", "evaluate", "regions"};

RunRecord parse(const fs::path& manifest) {
  RunRecord run;
  run.manifest = manifest;
  try {
    const Json json = read_json(manifest, "the manifest of a run of mimetra");
    run.operation = json.at("command").get<std::string>();
    if (!json.contains("named_inputs")) {
      throw IoError(manifest.string(),
                    "does not name the run's inputs; it is of an earlier version, run it again");
    }
    json.at("named_inputs").get_to(run.inputs);
    json.at("options").get_to(run.options);
    json.at("arguments").get_to(run.arguments);
    for (const Json& file : json.at("inputs")) {
      run.files.push_back(file.at("path").get<fs::path>());
      const std::string hash = file_hash(run.files.back());
      if (!hash.empty() && hash != file.at("xxh3")) run.changed.push_back(run.files.back());
    }
  } catch (const Json::exception&) {
    throw IoError(manifest.string(), "expected the manifest of a run of mimetra");
  }
  return run;
}

/// The manifest of a file; empty where there is none.
fs::path manifest_beside(const fs::path& file) {
  fs::path stem = file;
  for (const fs::path& name :
       {fs::path(file) += kFileManifest, stem.replace_extension() += kFileManifest}) {
    if (fs::exists(name) && is_manifest_of(name, file)) return name;
  }
  return {};
}

std::vector<fs::path> manifests_in(const fs::path& folder) {
  std::vector<fs::path> manifests;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::error_code unreadable;
    if (entry.path().filename().string().ends_with(kFileManifest)) {
      manifests.push_back(entry.path());
    } else if (fs::exists(entry.path() / kFolderManifest, unreadable)) {
      manifests.push_back(entry.path() / kFolderManifest);
    }
  }
  std::ranges::sort(manifests);
  return manifests;
}

void check_looked_for_regions(const RunRecord& run) {
  if (std::ranges::find(kOperations, run.operation) == kOperations.end()) {
    throw MismatchError(run.manifest.string() + ": a run of " + run.operation +
                        "; expected one of transfer, evaluate or regions");
  }
  const auto full = run.options.find("full");
  if (full != run.options.end() && full->second == to_text(true)) {
    throw MismatchError(run.manifest.string() +
                        ": was made with --full, without regions; name a run by regions");
  }
}

/// None for what is not a manifest of a run that looked for regions.
std::optional<RunRecord> parse_if_suitable(const fs::path& manifest) {
  try {
    RunRecord run = parse(manifest);
    check_looked_for_regions(run);
    return run;
  } catch (const IoError&) {
    return {};
  } catch (const MismatchError&) {
    return {};
  }
}

/// The run in a folder of several outputs that stands for all of it.
RunRecord main_run(const fs::path& folder) {
  std::vector<RunRecord> runs;
  for (const fs::path& manifest : manifests_in(folder)) {
    std::optional<RunRecord> run = parse_if_suitable(manifest);
    if (!run) continue;
    // Every output of a run has the same manifest.
    const auto same = std::ranges::find(runs, run->arguments, &RunRecord::arguments);
    if (same == runs.end()) runs.push_back(std::move(*run));
  }
  for (const std::string_view operation : kOperations) {
    const auto is_of = [operation](const RunRecord& run) { return run.operation == operation; };
    const auto count = std::ranges::count_if(runs, is_of);
    if (count == 1) return *std::ranges::find_if(runs, is_of);
    if (count == 0) continue;
    std::string list;
    for (const RunRecord& run : runs) {
      if (is_of(run)) list += (list.empty() ? "" : ", ") + run.manifest.string();
    }
    throw MismatchError(folder.string() + ": holds " + std::to_string(count) + " runs of " +
                        std::string(operation) + "; name one: " + list);
  }
  throw IoError(
      folder.string(),
      "no run that looked for regions; expected what transfer, regions or evaluate wrote");
}

/// False for one that only lists files: those of a library's, not of a run.
bool is_of_a_run(const fs::path& manifest) {
  const std::optional<Json> json = read_json_if_any(manifest);
  return !json || !json->is_object() || json->contains("command") || !json->contains("files");
}

RunRecord run_of(const fs::path& path) {
  if (fs::is_directory(path)) {
    const fs::path manifest = path / kFolderManifest;
    return fs::exists(manifest) && is_of_a_run(manifest) ? parse(manifest) : main_run(path);
  }
  if (!fs::exists(path)) fail_missing(path.string());
  if (accompanies_an_output(path)) return parse(path);
  const fs::path manifest = manifest_beside(path);
  if (manifest.empty()) {
    throw IoError(path.string(), "no manifest of a run of mimetra beside it");
  }
  return parse(manifest);
}

}  // namespace

RunRecord read_run(const fs::path& path) {
  RunRecord run = run_of(path);
  check_looked_for_regions(run);
  for (const fs::path& file : run.files) {
    if (fs::exists(file)) continue;
    throw IoError(file.string(), "no such file; " + run.manifest.string() +
                                     " was made from it, named from the folder where that ran");
  }
  return run;
}

bool is_manifest_of(const fs::path& manifest, const fs::path& output) {
  const std::optional<Json> json = read_json_if_any(manifest);
  if (!json || !json->is_object()) return false;
  const auto outputs = json->find("outputs");
  if (outputs == json->end() || !outputs->is_array()) return false;
  return std::ranges::any_of(*outputs, [&output](const Json& path) {
    return path.is_string() && fs::path(path.get<std::string>()).filename() == output.filename();
  });
}

bool is_manifest_of_operation(const fs::path& manifest, const std::string& operation) {
  if (!fs::is_regular_file(manifest)) return false;
  const std::optional<Json> json = read_json_if_any(manifest);
  return json && json->is_object() && json->value("program", Json()) == "mimetra" &&
         json->value("command", Json()) == operation;
}

bool accompanies_an_output(const fs::path& manifest) {
  const std::string name = manifest.filename().string();
  return name.ends_with(kFileManifest) || name == kFolderManifest;
}

}  // namespace mimetra
