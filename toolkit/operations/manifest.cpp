#include "toolkit/operations/manifest.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <new>

#include <nlohmann/json.hpp>

#include "toolkit/formats/model_file.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

// Inlines xxHash from its header, so users of this library need not link xxHash.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// XXH3 (64 bits) of a file's bytes, as hexadecimal digits. Empty if the file cannot be read or is
/// not a regular file.
std::string file_hash(const fs::path& path) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return "";
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return "";
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       XXH3_freeState);
  if (!state) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  std::vector<char> buffer(1 << 20);
  while (stream) {
    stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    XXH3_64bits_update(state.get(), buffer.data(), static_cast<std::size_t>(stream.gcount()));
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(XXH3_64bits_digest(state.get())));
  return text;
}

}  // namespace

std::uint64_t hash_of_ends(const std::filesystem::path& path) {
  constexpr std::uint64_t kEnd = 1 << 16;
  std::error_code unreadable;
  const std::uint64_t size = std::filesystem::file_size(path, unreadable);
  if (unreadable) return 0;
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> ends(static_cast<std::size_t>(std::min(size, 2 * kEnd)));
  const auto half = static_cast<std::streamsize>(std::min(size, kEnd));
  const auto rest = static_cast<std::streamsize>(ends.size()) - half;
  stream.read(ends.data(), half);
  stream.seekg(-rest, std::ios::end);
  stream.read(ends.data() + half, rest);
  return stream ? XXH3_64bits_withSeed(ends.data(), ends.size(), size) : 0;
}

std::vector<std::filesystem::path> input_files(const std::vector<std::filesystem::path>& inputs) {
  std::vector<std::filesystem::path> files;
  for (const auto& input : inputs) {
    const auto start = static_cast<std::ptrdiff_t>(files.size());
    std::error_code unreadable;
    if (!std::filesystem::is_directory(input, unreadable)) {
      files.push_back(input);
    } else if (is_model(input)) {
      std::ranges::copy(model_files(input), std::back_inserter(files));
    } else {
      for (const auto& entry : std::filesystem::recursive_directory_iterator(input)) {
        if (entry.is_regular_file(unreadable)) files.push_back(entry.path());
      }
    }
    std::sort(files.begin() + start, files.end());
  }
  return files;
}

std::string manifest(const FinishedRun& run, const std::string& report) {
  Json options = Json::object();
  for (const Parameter& parameter : run.parameters.declared()) {
    options[parameter.name] = to_text(run.parameters.value(parameter.name));
  }
  Json inputs = Json::array();
  for (const auto& path : input_files(run.inputs)) {
    inputs.push_back({{"path", path.string()}, {"xxh3", file_hash(path)}});
  }
  Json outputs = Json::array();
  for (const auto& path : run.outputs) outputs.push_back(path.string());
  Json json = {{"program", "mimetra"},
               {"version", MIMETRA_VERSION},
               {"command", run.operation},
               {"arguments", run.arguments},
               {"named_inputs", run.named_inputs},
               {"options", options},
               {"inputs", inputs},
               {"outputs", outputs},
               {"seconds", {{"read", run.read_seconds}, {"run", run.run_seconds}}},
               {"peak_memory_bytes", run.peak_memory},
               {"result", Json::parse(report)}};
  if (!run.given_inputs.empty()) json["given_inputs"] = run.given_inputs;
  return json_text(json, 2) + '\n';
}

std::string manifest_name(const std::filesystem::path& output, bool is_folder) {
  if (is_folder) return kFolderManifest;
  const std::string name = output.stem().string() + ".run.json";
  const auto path = output.parent_path() / name;
  const auto is_free = [&output](const std::filesystem::path& manifest) {
    return !std::filesystem::exists(manifest) || is_manifest_of(manifest, output);
  };
  if (is_free(path)) return name;
  const std::string longer = output.filename().string() + ".run.json";
  if (is_free(output.parent_path() / longer)) return longer;
  throw OutputError(
      (output.parent_path() / longer).string(),
      "exists already, and is no manifest of '" + output.filename().string() +
          "', whose manifest would be written there; move it, or choose another name");
}

namespace {

constexpr const char* kFileManifest = ".run.json";
/// Operations that look for regions. In a folder with several runs, the first of these operations
/// wins.
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

/// Manifest of a file; empty if there is none.
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

/// Parses a manifest; empty unless it is a manifest of a run that looked for regions.
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

/// Finds the main run in a folder of several outputs.
RunRecord main_run(const fs::path& folder) {
  std::vector<RunRecord> runs;
  for (const fs::path& manifest : manifests_in(folder)) {
    std::optional<RunRecord> run = parse_if_suitable(manifest);
    if (!run) continue;
    // All outputs of a run have the same manifest.
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

/// False for a manifest that only lists files. The library writes such manifests without a run.
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
