#include "toolkit/cli/dry_run.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/operations/counted.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/memory_use.h"

namespace mimetra::cli {

namespace {

/// "300 frames of 6706 vertices", or what else a value is made of.
std::string size_of(const NamedData& value) {
  const Data& data = value.data;
  if (const auto* sequence = std::get_if<FieldSequence>(&data)) {
    return counted(sequence->frames->frames(), "frame") + " of " +
           counted(sequence->frames->vertices(), "vertex", "vertices");
  }
  if (const auto* held = std::get_if<ModelData>(&data)) {
    const MorphableModel& model = held->model;
    std::string size = counted(model.vertices(), "vertex", "vertices") + ", ";
    if (model.identities().size() > 0) {
      size += counted(model.identities().size(), "identity", "identities") + ", ";
    }
    return size + counted(model.expressions().size(), "expression");
  }
  if (const auto* components = std::get_if<Components>(&data)) {
    return counted(components->count(), "component");
  }
  if (const auto* regions = std::get_if<RegionData>(&data)) {
    return counted(std::ssize(regions->regions.regions), "region");
  }
  if (const auto* track = std::get_if<LandmarkTrack>(&data)) {
    return counted(track->frames(), "frame") + " of " + counted(track->landmarks(), "landmark");
  }
  if (value.origin.run) return "a run of " + value.origin.run->record.operation;
  return "";
}

/// True for a sequence whose frames are all in memory.
bool is_in_memory(const Data& data) {
  const auto* sequence = std::get_if<FieldSequence>(&data);
  return sequence && sequence->is_in_memory();
}

}  // namespace

std::string megabytes(double bytes) {
  return std::to_string(std::lround(bytes / 1e6)) + " MB";
}

Outcome planned(const Operation& operation, const Invocation& invocation) {
  const double computing = operation.memory ? operation.memory(invocation) : 0;
  Json inputs = Json::array(), outputs = Json::array();
  std::ostringstream text;
  text << operation.name << '\n';
  for (const Input& input : operation.inputs) {
    const auto given = invocation.inputs.find(input.name);
    if (given == invocation.inputs.end()) continue;
    for (const NamedData& value : given->second) {
      const bool in_memory = is_in_memory(value.data);
      inputs.push_back({{"input", input.name},
                        {"name", value.name},
                        {"size", size_of(value)},
                        {"in_memory", in_memory}});
      text << "  reads   " << value.name << ": " << size_of(value)
           << (in_memory ? ", all in memory" : "") << '\n';
    }
  }
  for (const auto& [name, paths] : invocation.wanted) {
    for (const auto& path : paths) {
      outputs.push_back({{"output", name}, {"path", path.string()}});
      text << "  writes  " << path.string() << '\n';
    }
  }
  const MemoryUse use = MemoryUse::of_this_process();
  const double peak = std::max(use.peak, use.now + computing);
  const int processes = invocation.context.ranks().count();
  text << "  memory  " << megabytes(peak)
       << (processes > 1 ? " in each of " + std::to_string(processes) + " processes" : "")
       << ", of which " << megabytes(use.now) << " hold program and inputs\n";
  const double scratch = operation.scratch ? operation.scratch(invocation) : 0;
  if (scratch > 0) {
    text << "  scratch " << megabytes(scratch) << " in "
         << std::filesystem::temp_directory_path().string()
         << " (set TMPDIR for another folder), while it runs\n";
  }
  return {{},
          json_text(Json{{"operation", operation.name},
                         {"inputs", inputs},
                         {"outputs", outputs},
                         {"processes", processes},
                         {"memory_bytes", peak},
                         {"scratch_bytes", scratch}}),
          text.str()};
}

}  // namespace mimetra::cli
