#include "toolkit/cli/dry_run.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/operations/json.h"
#include "toolkit/operations/memory_use.h"

namespace mimetra::cli {

namespace {

/// "300 frames of 6706 vertices", or what else a value is made of.
std::string size_of(const Data& data) {
  const auto frames = [](const FrameSource& sequence) {
    return std::to_string(sequence.frames()) + " frames of " + std::to_string(sequence.vertices()) +
           " vertices";
  };
  if (const auto* read = std::get_if<SequenceRead>(&data)) return frames(read->frames());
  if (const auto* fields = std::get_if<FieldSequence>(&data)) return frames(fields->sequence);
  if (const auto* model = std::get_if<BlendshapeModel>(&data)) {
    return std::to_string(model->vertices()) + " vertices, " +
           std::to_string(model->expressions().size()) + " expressions";
  }
  if (const auto* components = std::get_if<Components>(&data)) {
    return std::to_string(components->count()) + " components";
  }
  if (const auto* regions = std::get_if<RegionData>(&data)) {
    return std::to_string(regions->regions.regions.size()) + " regions";
  }
  if (const auto* run = std::get_if<RunRead>(&data)) return "a run of " + run->record.operation;
  if (const auto* read = std::get_if<LandmarksRead>(&data)) {
    return std::to_string(read->track.frames()) + " frames of " +
           std::to_string(read->track.landmarks()) + " landmarks";
  }
  if (const auto* read = std::get_if<ModelRead>(&data)) {
    return std::to_string(read->model.vertices()) + " vertices, " +
           std::to_string(read->model.identities().size()) + " identities, " +
           std::to_string(read->model.expressions().size()) + " expressions";
  }
  return "";
}

/// True for a sequence whose frames are all in memory.
bool is_in_memory(const Data& data) {
  const auto* read = std::get_if<SequenceRead>(&data);
  return (read && !read->stream) || std::holds_alternative<FieldSequence>(data);
}

}  // namespace

std::string megabytes(double bytes) {
  return std::to_string(std::lround(bytes / 1e6)) + " MB";
}

Outcome planned(const Operation& operation, const Invocation& invocation) {
  Json inputs = Json::array(), outputs = Json::array();
  std::ostringstream text;
  text << operation.name << '\n';
  for (const Input& input : operation.inputs) {
    const auto given = invocation.inputs.find(input.name);
    if (given == invocation.inputs.end()) continue;
    for (const NamedData& value : given->second) {
      inputs.push_back({{"input", input.name},
                        {"name", value.name},
                        {"size", size_of(value.data)},
                        {"in_memory", is_in_memory(value.data)}});
      text << "  reads   " << value.name << ": " << size_of(value.data)
           << (is_in_memory(value.data) ? ", all in memory" : "") << '\n';
    }
  }
  for (const auto& [name, paths] : invocation.wanted) {
    for (const auto& path : paths) {
      outputs.push_back({{"output", name}, {"path", path.string()}});
      text << "  writes  " << path.string() << '\n';
    }
  }
  const MemoryUse use = MemoryUse::of_this_process();
  const double computing = operation.memory ? operation.memory(invocation) : 0;
  const double peak = std::max(use.peak, use.now + computing);
  text << "  memory  " << megabytes(peak) << ", of which " << megabytes(use.now)
       << " hold program and inputs\n";
  return {{},
          Json{{"operation", operation.name},
               {"inputs", inputs},
               {"outputs", outputs},
               {"memory_bytes", peak}}
              .dump(),
          text.str()};
}

}  // namespace mimetra::cli
