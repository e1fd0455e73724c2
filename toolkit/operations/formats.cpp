#include "toolkit/operations/formats.h"

#include "toolkit/io/components_file.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

using Paths = std::vector<std::filesystem::path>;

namespace {

std::vector<Parameter> sequence_writing_parameters() {
  return {choice_parameter("format", SequenceWriteOptions{}.format, "format of frames in a folder"),
          {"double", ParameterKind::flag, false, "double precision in mesh files"},
          {"single", ParameterKind::flag, false, "single precision in .npy and .npz"}};
}

Paths write_sequence_data(const Data& data, const WriteRequest& request) {
  SequenceWriteOptions options;
  options.format = request.parameters.choice<MeshFormat>("format");
  options.double_precision = request.parameters.flag("double");
  options.single_precision = request.parameters.flag("single");
  options.overwrite = request.overwrite;
  options.inputs = request.inputs;
  options.threads = request.threads;
  options.progress = request.progress;
  return write_sequence(*std::get<FieldSequence>(data).frames, request.target, options,
                        request.extra);
}

Paths write_components_data(const Data& data, const WriteRequest& request) {
  return write_with_extra(request, [&]() -> Paths {
    write_components(request.target, std::get<Components>(data), request.overwrite);
    return {request.target};
  });
}

/// As `fit` reads it.
std::string mapping_text(const std::vector<std::pair<int, VertexIndex>>& landmarks) {
  std::string text = "# landmark of iBUG = vertex, 0-based\n[landmark_mappings]\n";
  for (const auto& [landmark, vertex] : landmarks) {
    text += std::to_string(landmark) + " = " + std::to_string(vertex) + '\n';
  }
  return text;
}

Paths write_model_data(const Data& data, const WriteRequest& request) {
  const auto& [model, performance, landmarks] = std::get<ModelData>(data);
  auto extra = request.extra;
  if (!landmarks.empty()) extra.emplace_back("landmarks68.txt", mapping_text(landmarks));
  const bool performs = !performance.names.empty();
  write_model(request.target, model, performs ? std::optional(performance) : std::nullopt,
              request.overwrite, extra);
  return {request.target};
}

}  // namespace

Paths write_with_extra(const WriteRequest& request, const std::function<Paths()>& write) {
  // The parents that the request's target needs are made first and go last where it fails.
  PendingOutputs extra(true, request.inputs);
  Paths beside;
  for (const auto& [name, content] : request.extra) {
    beside.push_back(request.target.parent_path() / name);
    write_bytes(extra.add(beside.back(), PendingOutput::Kind::file), content);
  }
  Paths written = write();
  extra.commit();
  written.insert(written.end(), beside.begin(), beside.end());
  return written;
}

Paths write_text(const WriteRequest& request, const std::string& text) {
  return write_with_extra(request, [&]() -> Paths {
    write_file(request.target, text, request.overwrite);
    return {request.target};
  });
}

std::vector<std::string> sequence_files() {
  return sequence_extensions();
}

std::string sequence_outputs() {
  return joined(sequence_extensions()) + " (one frame in a mesh file), or a folder of meshes";
}

void add_formats(OperationTable& table) {
  std::vector<std::string> extensions = sequence_extensions();
  extensions.emplace_back();  // a folder
  table.add(
      Writer{DataKind::sequence, extensions, sequence_writing_parameters(), write_sequence_data});
  table.add(Writer{DataKind::components, {".h5", ".hdf5"}, {}, write_components_data});
  table.add(Writer{DataKind::model, {""}, {}, write_model_data});
  table.add(
      Writer{DataKind::regions, {".json"}, {}, [](const Data& data, const WriteRequest& request) {
               return write_text(request, regions_json(std::get<RegionData>(data).regions));
             }});
  table.add(
      Writer{DataKind::regions, {".csv"}, {}, [](const Data& data, const WriteRequest& request) {
               return write_text(request, regions_csv(std::get<RegionData>(data).regions));
             }});
  table.add(
      Writer{DataKind::table, {".csv"}, {}, [](const Data& data, const WriteRequest& request) {
               return write_text(request, std::get<Table>(data).csv());
             }});
  table.add(
      Writer{DataKind::table, {".json"}, {}, [](const Data& data, const WriteRequest& request) {
               return write_text(request, std::get<Table>(data).json());
             }});
  table.add(Writer{DataKind::fit, {".json"}, {}, [](const Data& data, const WriteRequest& request) {
                     return write_text(request, fit_json(std::get<FittedCoefficients>(data)));
                   }});
  table.add(RegionReader{{".json", ".csv", ".txt"}, read_regions});
}

}  // namespace mimetra
