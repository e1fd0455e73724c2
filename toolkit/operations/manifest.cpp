#include "toolkit/operations/manifest.h"

#include <nlohmann/json.hpp>

#include "toolkit/mesh/errors.h"
#include "toolkit/operations/file_hash.h"
#include "toolkit/operations/input_files.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/run_file.h"

namespace mimetra {

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

}  // namespace mimetra
