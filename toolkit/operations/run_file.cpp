#include <mimetra/operations/run_file.h>

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include <mimetra/io/pending_output.h>
#include <mimetra/mesh/errors.h>
#include <mimetra/operations/report.h>

namespace mimetra {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFolderManifest = "mimetra-run.json";
constexpr const char* kFileManifest = ".run.json";

RunRecord parse(const fs::path& manifest) {
  RunRecord run;
  run.manifest = manifest;
  try {
    const Json json = Json::parse(read_file(manifest));
    run.operation = json.at("command").get<std::string>();
    if (!json.contains("named_inputs")) {
      throw IoError(manifest.string(),
                    "does not name the run's inputs; it is of an earlier version, run it again");
    }
    json.at("named_inputs").get_to(run.inputs);
    json.at("options").get_to(run.options);
    json.at("arguments").get_to(run.arguments);
    for (const Json& file : json.at("inputs")) run.files.push_back(file.at("path").get<fs::path>());
    run.result = json.at("result").dump();
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
    if (fs::exists(name) && tells_of(name, file)) return name;
  }
  return {};
}

std::vector<fs::path> manifests_in(const fs::path& folder) {
  std::vector<fs::path> manifests;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().ends_with(kFileManifest)) {
      manifests.push_back(entry.path());
    } else if (fs::exists(entry.path() / kFolderManifest)) {
      manifests.push_back(entry.path() / kFolderManifest);
    }
  }
  std::ranges::sort(manifests);
  return manifests;
}

bool looked_for_regions(const RunRecord& run) {
  const auto full = run.options.find("full");
  return run.options.contains("radius") && (full == run.options.end() || full->second != "true");
}

/// The run in a folder of several outputs that stands for all of it.
RunRecord main_run(const fs::path& folder) {
  std::vector<RunRecord> runs;
  for (const fs::path& manifest : manifests_in(folder)) {
    RunRecord run = parse(manifest);
    // Every output of a run has the same manifest.
    const bool is_new = std::ranges::find(runs, run.arguments, &RunRecord::arguments) == runs.end();
    if (is_new && looked_for_regions(run)) runs.push_back(std::move(run));
  }
  for (const char* operation : {"transfer", "evaluate", "regions"}) {
    const auto is_of = [operation](const RunRecord& run) { return run.operation == operation; };
    const auto count = std::ranges::count_if(runs, is_of);
    if (count == 1) return *std::ranges::find_if(runs, is_of);
    if (count == 0) continue;
    std::string list;
    for (const RunRecord& run : runs) {
      if (is_of(run)) list += (list.empty() ? "" : ", ") + run.manifest.string();
    }
    throw MismatchError(folder.string() + ": holds " + std::to_string(count) + " runs of " +
                        operation + "; name one: " + list);
  }
  throw IoError(
      folder.string(),
      "no run that looked for regions; expected what transfer, regions or evaluate wrote");
}

RunRecord run_of(const fs::path& path) {
  if (fs::is_directory(path)) {
    const fs::path manifest = path / kFolderManifest;
    return fs::exists(manifest) ? parse(manifest) : main_run(path);
  }
  if (!fs::exists(path)) throw IoError(path.string(), "no such file or folder");
  const std::string name = path.filename().string();
  if (name.ends_with(kFileManifest) || name == kFolderManifest) return parse(path);
  const fs::path manifest = manifest_beside(path);
  if (manifest.empty()) {
    throw IoError(path.string(), "no manifest of a run of mimetra beside it");
  }
  return parse(manifest);
}

}  // namespace

RunRecord read_run(const fs::path& path) {
  RunRecord run = run_of(path);
  for (const fs::path& file : run.files) {
    if (fs::exists(file)) continue;
    throw IoError(file.string(), "no such file; " + run.manifest.string() +
                                     " was made from it, named from the folder where that ran");
  }
  return run;
}

bool tells_of(const fs::path& manifest, const fs::path& output) {
  std::ifstream stream(manifest);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object() || !json.contains("outputs") || !json["outputs"].is_array()) return false;
  return std::ranges::any_of(json["outputs"], [&output](const Json& path) {
    return path.is_string() && fs::path(path.get<std::string>()).filename() == output.filename();
  });
}

}  // namespace mimetra
