#include <algorithm>
#include <iterator>

#include "toolkit/io/components_file.h"
#include "toolkit/io/gltf_write.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/io/scene.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/vtkhdf_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/expression_notes.h"
#include "toolkit/operations/sequence_parameters.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

using Paths = std::vector<std::filesystem::path>;

/// Throws MismatchError for regions without a mesh.
void check_shown(const FieldSequence& regions, const std::filesystem::path& target) {
  if (regions.frames->frames() > 0) return;
  throw MismatchError(target.string() +
                      ": the regions come without a mesh to show them on; write .json or .csv");
}

ReadValue read_sequence_data(const std::string& text, const ReadRequest& request,
                             const Context& context) {
  const SequenceSource source = sequence_parameters().read(request.parameters);
  const auto value_of = [&](FieldSequence sequence, auto& read) -> ReadValue {
    const SequenceFormat* format = sequence_format(text);
    if (request.fields && format && format->fields && std::filesystem::is_regular_file(text)) {
      FieldsRead own = format->fields(text, sequence.frames->connectivity(), context.part(1, 1));
      sequence.fields = std::move(own.fields);
      if (!own.left_out.empty()) {
        read.notes.push_back(text + ": its properties " + listed(own.left_out) +
                             " hold no numbers of vertices or faces, and are left out");
      }
    }
    return {{text, std::move(sequence), {.model_driven = read.model_driven}},
            std::move(read.files),
            std::move(read.notes)};
  };
  if (request.may_stream) {
    OpenSequence open = open_sequence(text, source, context);
    return value_of(FieldSequence(std::move(open.frames)), open);
  }
  SequenceRead read = read_sequence(text, source, context);
  return value_of(FieldSequence(std::move(read.sequence)), read);
}

/// Adds the files of a request to `options`.
SequenceWriteOptions asked_for(const WriteRequest& request, SequenceWriteOptions options) {
  options.overwrite = request.overwrite;
  options.inputs = request.inputs;
  options.together = request.together;
  return options;
}

Paths write_sequence_data(const Data& data, const WriteRequest& request,
                          SequenceWriteOptions options, const Context& context) {
  const auto& sequence = std::get<FieldSequence>(data);
  options.fields = sequence.fields;
  return write_sequence(*sequence.frames, request.target, asked_for(request, std::move(options)),
                        request.extra, context);
}

/// Writes the rest pose with the fields, as one mesh.
Paths write_om_regions(const Data& data, const WriteRequest& request, const Context& context) {
  const FieldSequence& shown = std::get<RegionData>(data).fields;
  check_shown(shown, request.target);
  const FrameSource& frames = *shown.frames;
  const Frames rest = frames.rest().reshaped<Eigen::RowMajor>().transpose();
  return write_sequence_data(
      FieldSequence(MeshSequence(frames.shared_connectivity(), rest), shown.fields), request,
      mesh_writing_parameters().read(request.parameters), context);
}

Paths write_vtkhdf_data(const FieldSequence& sequence, const WriteRequest& request,
                        const Context& context) {
  return write_vtkhdf(sequence, request.target,
                      asked_for(request, mesh_writing_parameters().read(request.parameters)),
                      request.extra, context);
}

Paths write_vtkhdf_sequence(const Data& data, const WriteRequest& request, const Context& context) {
  FieldSequence sequence = std::get<FieldSequence>(data);
  show_displacement(sequence);
  return write_vtkhdf_data(sequence, request, context);
}

Paths write_vtkhdf_regions(const Data& data, const WriteRequest& request, const Context& context) {
  const FieldSequence& shown = std::get<RegionData>(data).fields;
  check_shown(shown, request.target);
  return write_vtkhdf_data(shown, request, context);
}

ReadValue read_components_data(const std::string& text, const ReadRequest&, const Context&) {
  return {{text, read_components(text)}, {text}};
}

Paths write_components_data(const Data& data, const WriteRequest& request, const Context&) {
  return write_with_extra(request, [&]() -> Paths {
    write_components(request.target, std::get<Components>(data), request.overwrite,
                     request.together);
    return {request.target};
  });
}

/// Reads one mesh as a model without expressions.
MorphableModel model_of_mesh(const std::filesystem::path& path, const Context& context) {
  TriMesh mesh = read_mesh(path, context);
  return {std::make_shared<Connectivity>(std::move(mesh.connectivity)),
          std::move(mesh.positions),
          {},
          {}};
}

MorphableModel model_of(const ModelSpec& spec, const ReadRequest& request, const Context& context) {
  const bool is_person = spec.fit || !spec.identity_text.empty();
  if (request.identities && !is_person && !is_mesh_extension(spec.path.extension().string())) {
    return read_model(spec.path, context);
  }
  if (!std::filesystem::exists(spec.path)) fail_missing(spec.path.string());
  if (std::filesystem::is_directory(spec.path) || is_model(spec.path)) {
    return MorphableModel(read_person(spec, context));
  }
  if (!is_person) return model_of_mesh(spec.path, context);
  throw MismatchError(spec.name() + ": '" + spec.path.string() +
                      "' is one mesh and has no identities");
}

ReadValue read_model_files(const std::string& text, const ReadRequest& request,
                           const Context& context) {
  const ModelSpec spec = ModelSpec::parse(text);
  if (is_scene_file(spec.path) && !spec.fit && spec.identity_text.empty()) {
    Scene scene = read_gltf(spec.path, context);
    std::ranges::move(scene.model_notes, std::back_inserter(scene.notes));
    return {{spec.name(), ModelData{MorphableModel(*scene.model)}, {.path = spec.path}},
            std::move(scene.files),
            std::move(scene.notes)};
  }
  ReadValue read{{spec.name(), ModelData{model_of(spec, request, context)}, {.path = spec.path}},
                 {spec.path},
                 spec.notes()};
  if (spec.fit) read.files.push_back(*spec.fit);
  for (const std::string& note : notes_on_unread(spec.path)) read.notes.push_back(note);
  return read;
}

ReadValue read_model_data(const std::string& text, const ReadRequest& request,
                          const Context& context) {
  ReadValue read = read_model_files(text, request, context);
  const MorphableModel& model = std::get<ModelData>(read.value.data).model;
  for (const std::string& note : notes_on_expressions(
           read.value.name, model.mean(), model.connectivity().triangles, model.expressions())) {
    read.notes.push_back(note);
  }
  return read;
}

/// Mapping of landmarks in the format that `fit` reads.
std::string mapping_text(const std::vector<std::pair<int, VertexIndex>>& landmarks) {
  std::string text = "# landmark of iBUG = vertex, 0-based\n[landmark_mappings]\n";
  for (const auto& [landmark, vertex] : landmarks) {
    text += std::to_string(landmark) + " = " + std::to_string(vertex) + '\n';
  }
  return text;
}

Paths write_model_data(const Data& data, const WriteRequest& request, const Context& context) {
  const auto& [model, performance, landmarks] = std::get<ModelData>(data);
  auto extra = request.extra;
  if (!landmarks.empty()) extra.emplace_back("landmarks68.txt", mapping_text(landmarks));
  const bool performs = !performance.names.empty();
  write_model(request.target, model, performs ? std::optional(performance) : std::nullopt,
              request.overwrite, extra, request.together, context);
  return {request.target};
}

Paths write_gltf_data(const Data& data, const WriteRequest& request, const Context& context) {
  const auto& [model, performance, landmarks] = std::get<ModelData>(data);
  return write_gltf_model(model, performance, request.target, asked_for(request, {}), request.extra,
                          context);
}

ReadValue read_regions_data(const std::string& text, const ReadRequest& request, const Context&) {
  return {{text, RegionData{read_regions(text, request.vertices, *request.triangles), {}}}, {text}};
}

ReadValue read_fit_data(const std::string& text, const ReadRequest&, const Context&) {
  return {{text, read_fit(text)}, {text}};
}

ReadValue read_document(const std::string& text, const ReadRequest&, const Context&) {
  return {{text, Document{read_file(text)}}, {text}};
}

/// Writer of a text format; `text_of` converts a value to text.
template <typename Value>
std::function<Paths(const Data&, const WriteRequest&, const Context&)> writer_of(
    std::string (*text_of)(const Value&)) {
  return [text_of](const Data& data, const WriteRequest& request, const Context&) {
    return write_text(request, text_of(std::get<Value>(data)));
  };
}

BoundParameters<SequenceWriteOptions> writing_parameters(SequenceFormat::Precision precision) {
  switch (precision) {
    case SequenceFormat::Precision::single:
      return BoundParameters<SequenceWriteOptions>();
    case SequenceFormat::Precision::single_or_double:
      return mesh_writing_parameters();
    case SequenceFormat::Precision::double_or_single:
      return array_writing_parameters();
  }
  return BoundParameters<SequenceWriteOptions>();
}

constexpr auto kAvatar = "VRM avatar, read as glTF";

void add_sequence_formats(OperationTable& table) {
  const auto add = [&table](std::string name, std::vector<std::string> extensions,
                            const BoundParameters<SequenceWriteOptions>& writing,
                            std::function<HeldParts(const Parameters&)> holds,
                            bool has_fields = false) {
    table.add(Format{
        .name = std::move(name),
        .kind = DataKind::sequence,
        .extensions = std::move(extensions),
        .reading = sequence_parameters().declared(),
        .read = read_sequence_data,
        .writing = writing.declared(),
        .write =
            [writing](const Data& data, const WriteRequest& request, const Context& context) {
              return write_sequence_data(data, request, writing.read(request.parameters), context);
            },
        .fields = has_fields,
        .holds = std::move(holds)});
  };
  for (const SequenceFormat& format : sequence_formats()) {
    add(
        format.name, format.extensions, writing_parameters(format.precision),
        [held = format.holds](const Parameters&) { return held; }, format.fields != nullptr);
  }
  add("folder of meshes", {Format::kFolder}, folder_writing_parameters(),
      [](const Parameters& options) {
        return parts_held_by(folder_writing_parameters().read(options).format);
      });
  table.add(Format{.name = kAvatar,
                   .kind = DataKind::sequence,
                   .extensions = {".vrm"},
                   .reading = sequence_parameters().declared(),
                   .read = read_sequence_data});
  table.add(Format{.name = "eos model, by weights",
                   .kind = DataKind::sequence,
                   .extensions = {".bin"},
                   .reading = sequence_parameters().declared(),
                   .read = read_sequence_data});
}

void add_model_formats(OperationTable& table) {
  table.add(Format{.name = "folder of shapes",
                   .kind = DataKind::model,
                   .extensions = {Format::kFolder},
                   .read = read_model_data,
                   .write = write_model_data});
  table.add(Format{.name = "eos shape model",
                   .kind = DataKind::model,
                   .extensions = {".bin"},
                   .read = read_model_data});
  table.add(Format{.name = "glTF 2.0",
                   .kind = DataKind::model,
                   .extensions = {".glb", ".gltf"},
                   .read = read_model_data,
                   .write = write_gltf_data});
  table.add(Format{
      .name = kAvatar, .kind = DataKind::model, .extensions = {".vrm"}, .read = read_model_data});
  table.add(Format{.name = "mesh without expressions",
                   .kind = DataKind::model,
                   .extensions = mesh_extensions(),
                   .read = read_model_data});
}

/// Notes that a list of vertices loses the weights of regions with a soft border.
std::vector<std::string> lost_weights(const Data& data, const std::filesystem::path& target) {
  if (std::get<RegionData>(data).regions.weights.size() == 0) return {};
  return {target.string() +
          ": this format holds no weights of vertices; written without, .json and .vtp hold them, "
          "which --regions takes"};
}

}  // namespace

void add_formats(OperationTable& table) {
  add_sequence_formats(table);
  add_model_formats(table);
  table.add(Format{.name = "VTKHDF over time",
                   .kind = DataKind::sequence,
                   .extensions = {".vtkhdf"},
                   .writing = mesh_writing_parameters().declared(),
                   .write = write_vtkhdf_sequence,
                   .fields = true,
                   .displacements = true,
                   .holds = [](const Parameters&) { return HeldParts{.polygons = true}; }});
  table.add(Format{.name = "VTKHDF over time with region fields",
                   .kind = DataKind::regions,
                   .extensions = {".vtkhdf"},
                   .writing = mesh_writing_parameters().declared(),
                   .write = write_vtkhdf_regions});
  table.add(Format{.name = "OM mesh with region properties",
                   .kind = DataKind::regions,
                   .extensions = {".om"},
                   .read = read_regions_data,
                   .writing = mesh_writing_parameters().declared(),
                   .write = write_om_regions});
  table.add(Format{.name = "SPLOCS components (HDF5)",
                   .kind = DataKind::components,
                   .extensions = {".h5", ".hdf5"},
                   .read = read_components_data,
                   .write = write_components_data});
  table.add(Format{.name = "region set",
                   .kind = DataKind::regions,
                   .extensions = {".json"},
                   .read = read_regions_data,
                   .write = writer_of<RegionData>(
                       [](const RegionData& data) { return regions_json(data.regions); })});
  table.add(Format{.name = "vertices and their regions",
                   .kind = DataKind::regions,
                   .extensions = {".csv"},
                   .read = read_regions_data,
                   .write = writer_of<RegionData>(
                       [](const RegionData& data) { return regions_csv(data.regions); }),
                   .losses = lost_weights});
  table.add(Format{.name = "list of vertices, or mask",
                   .kind = DataKind::regions,
                   .extensions = {".txt"},
                   .read = read_regions_data});
  table.add(Format{.name = "coefficients and cameras",
                   .kind = DataKind::fit,
                   .extensions = {".json"},
                   .read = read_fit_data,
                   .write = writer_of<FittedCoefficients>(fit_json)});
  table.add(Format{.name = "text",
                   .kind = DataKind::document,
                   .extensions = {Format::kAnyFile},
                   .read = read_document});
}

}  // namespace mimetra
