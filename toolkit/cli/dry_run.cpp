#include "toolkit/cli/dry_run.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/operations/json.h"

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

/// Bytes of the frames of all streamed inputs.
double streamed_bytes(const Invocation& invocation) {
  double bytes = 0;
  for (const auto& [name, values] : invocation.inputs) {
    for (const NamedData& value : values) {
      const auto* read = std::get_if<SequenceRead>(&value.data);
      if (!read || !read->stream) continue;
      bytes += 3.0 * sizeof(double) * read->stream->frames() * read->stream->vertices();
    }
  }
  return bytes;
}

}  // namespace

std::string megabytes(double bytes) {
  return std::to_string(std::lround(bytes / 1e6)) + " MB";
}

MemoryUse MemoryUse::of_this_process() {
  MemoryUse use;
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    std::istringstream words(line);
    std::string name;
    double kilobytes = 0;
    words >> name >> kilobytes;
    if (name == "VmRSS:") use.now = 1024 * kilobytes;
    if (name == "VmHWM:") use.peak = 1024 * kilobytes;
  }
  return use;
}

Outcome planned(const OperationTable& table, const Operation& operation,
                const Invocation& invocation) {
  const std::string step = operation.all_frames_for ? operation.all_frames_for(invocation) : "";
  double computing = operation.memory ? operation.memory(invocation) : 0;
  Json inputs = Json::array(), outputs = Json::array();
  std::ostringstream text;
  text << operation.name << '\n';
  for (const Input& input : operation.inputs) {
    const auto given = invocation.inputs.find(input.name);
    if (given == invocation.inputs.end()) continue;
    for (const NamedData& value : given->second) {
      const bool brought = input.streamed && !step.empty();
      const bool in_memory = brought || is_in_memory(value.data);
      inputs.push_back({{"input", input.name},
                        {"name", value.name},
                        {"size", size_of(value.data)},
                        {"in_memory", in_memory}});
      text << "  reads   " << value.name << ": " << size_of(value.data)
           << (in_memory ? ", all in memory" : "") << (brought ? " for " + step : "") << '\n';
    }
  }
  const double streamed = streamed_bytes(invocation);
  for (const Output& output : operation.outputs) {
    const auto wanted = invocation.wanted.find(output.name);
    if (wanted == invocation.wanted.end()) continue;
    for (const auto& path : wanted->second) {
      const bool holds = streamed > 0 && table.writer(output.kind, path).holds_frames;
      if (holds) computing = std::max(computing, streamed);
      outputs.push_back(
          {{"output", output.name}, {"path", path.string()}, {"all_frames_in_memory", holds}});
      text << "  writes  " << path.string() << (holds ? ", with all frames in memory" : "") << '\n';
    }
  }
  const MemoryUse use = MemoryUse::of_this_process();
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
