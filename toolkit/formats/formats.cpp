#include "toolkit/formats/formats.h"

#include <algorithm>

#include "toolkit/formats/driven_sequence.h"
#include "toolkit/formats/gltf/gltf_format.h"
#include "toolkit/formats/hdf5/hdf5_formats.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/expression_notes.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

using Paths = Format::Paths;

/// Writes the rest pose with the fields, as one mesh.
Paths write_om_regions(const Data& data, const fs::path& target, const WriteOptions& options,
                       const Context& context) {
  const FieldSequence& shown = shown_regions(data, target);
  const FrameSource& frames = *shown.frames;
  const Frames rest = frames.rest().reshaped<Eigen::RowMajor>().transpose();
  WriteOptions with_fields = options;
  with_fields.fields = shown.fields;
  const MeshSequence mesh(frames.shared_connectivity(), rest);
  const auto sink = mesh_format(".om")->create(mesh.header(), target, with_fields, context);
  sink->write(0, mesh.positions());
  return sink->commit();
}

/// Reads one mesh as a model without expressions.
MorphableModel model_of_mesh(const fs::path& path, const Context& context) {
  TriMesh mesh = read_mesh(path, context);
  return {std::make_shared<Connectivity>(std::move(mesh.connectivity)),
          std::move(mesh.positions),
          {},
          {}};
}

MorphableModel model_of(const ModelSpec& spec, const ReadOptions& options, const Context& context) {
  const bool is_person = spec.fit || !spec.identity_text.empty();
  if (options.identities && !is_person && !is_mesh_extension(spec.path.extension().string())) {
    return read_model(spec.path, context);
  }
  if (!fs::exists(spec.path)) fail_missing(spec.path.string());
  if (fs::is_directory(spec.path) || is_model(spec.path)) {
    return MorphableModel(read_person(spec, context));
  }
  if (!is_person) return model_of_mesh(spec.path, context);
  throw MismatchError(spec.name() + ": '" + spec.path.string() +
                      "' is one mesh and has no identities");
}

ReadValue read_model_data(const std::string& text, const ReadOptions& options,
                          const Context& context) {
  const ModelSpec spec = ModelSpec::parse(text);
  ReadValue read{{spec.name(), ModelData{model_of(spec, options, context)}, {.path = spec.path}},
                 {spec.path},
                 spec.notes()};
  if (spec.fit) read.files.push_back(*spec.fit);
  for (const std::string& note : notes_on_unread(spec.path)) read.notes.push_back(note);
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

Paths write_model_data(const Data& data, const fs::path& target, const WriteOptions& options,
                       const Context& context) {
  const auto& [model, performance, landmarks] = std::get<ModelData>(data);
  WriteOptions with_landmarks = options;
  if (!landmarks.empty()) {
    with_landmarks.extra.emplace_back("landmarks68.txt", mapping_text(landmarks));
  }
  const bool performs = !performance.names.empty();
  write_model(target, model, performs ? std::optional(performance) : std::nullopt, with_landmarks,
              context);
  return {target};
}

ReadValue read_regions_data(const std::string& text, const ReadOptions& options, const Context&) {
  return {{text, RegionData{read_regions(text, options.vertices, *options.triangles), {}}}, {text}};
}

ReadValue read_fit_data(const std::string& text, const ReadOptions&, const Context&) {
  return {{text, read_fit(text)}, {text}};
}

ReadValue read_document(const std::string& text, const ReadOptions&, const Context&) {
  return {{text, Document{read_file(text)}}, {text}};
}

/// Writer of a text format; `text_of` converts a value to text.
template <typename Value>
decltype(Format::write) writer_of(std::string (*text_of)(const Value&)) {
  return [text_of](const Data& data, const fs::path& target, const WriteOptions& options,
                   const Context&) {
    return write_text(target, options, text_of(std::get<Value>(data)));
  };
}

/// Notes that a list of vertices loses the weights of regions with a soft border.
std::vector<std::string> lost_weights(const Data& data, const fs::path& target) {
  if (std::get<RegionData>(data).regions.weights.size() == 0) return {};
  return {target.string() +
          ": this format holds no weights of vertices; written without, .json and .vtp hold them, "
          "which --regions takes"};
}

OpenSequence open_folder(const fs::path& path, const ReadOptions& options, const Context& context) {
  return open_frames(frames_of_folder(path), path, options, context);
}

OpenSequence open_model(const fs::path& path, const ReadOptions& options, const Context& context) {
  if (!is_model(path)) throw IoError(path.string(), "is not an eos shape model");
  return open_driven(ModelSpec{path, {}, {}}, options, context);
}

std::vector<Format> sequence_formats() {
  return {
      {.name = "folder of meshes",
       .extensions = {Format::kFolder},
       .reading = reading_parameters(),
       .writing = writing_parameters({"format", "double"}),
       .holds =
           [](const WriteOptions& options) { return held_in_folder('.' + options.frame_format); },
       .open = open_folder,
       .create = begin_folder},
      {.name = "eos model, by weights",
       .extensions = {".bin"},
       .reading = reading_parameters(),
       .open = open_model}};
}

std::vector<Format> model_formats() {
  return {{.name = "folder of shapes",
           .kind = DataKind::model,
           .extensions = {Format::kFolder},
           .read = read_model_data,
           .write = write_model_data},
          {.name = "eos shape model",
           .kind = DataKind::model,
           .extensions = {".bin"},
           .read = read_model_data},
          {.name = "mesh without expressions",
           .kind = DataKind::model,
           .extensions = mesh_extensions(),
           .read = read_model_data}};
}

std::vector<Format> region_formats() {
  return {{.name = "OM mesh with region properties",
           .kind = DataKind::regions,
           .extensions = {".om"},
           .read = read_regions_data,
           .writing = writing_parameters({"double"}),
           .write = write_om_regions},
          {.name = "region set",
           .kind = DataKind::regions,
           .extensions = {".json"},
           .read = read_regions_data,
           .write = writer_of<RegionData>(
               [](const RegionData& data) { return regions_json(data.regions); })},
          {.name = "vertices and their regions",
           .kind = DataKind::regions,
           .extensions = {".csv"},
           .read = read_regions_data,
           .write = writer_of<RegionData>(
               [](const RegionData& data) { return regions_csv(data.regions); }),
           .losses = lost_weights},
          {.name = "list of vertices, or mask",
           .kind = DataKind::regions,
           .extensions = {".txt"},
           .read = read_regions_data}};
}

std::vector<Format> other_formats() {
  return {{.name = "coefficients and cameras",
           .kind = DataKind::fit,
           .extensions = {".json"},
           .read = read_fit_data,
           .write = writer_of<FittedCoefficients>(fit_json)},
          {.name = "text",
           .kind = DataKind::document,
           .extensions = {Format::kAnyFile},
           .read = read_document}};
}

}  // namespace

const std::vector<Format>& formats() {
  static const std::vector<Format> all = [] {
    std::vector<Format> table;
    for (const std::vector<Format>& part :
         {std::vector<Format>{npy_format(), npz_format(), pc2_format(), mdd_format()},
          hdf5_formats(), gltf_formats(), mesh_formats(), sequence_formats(), model_formats(),
          region_formats(), other_formats()}) {
      table.insert(table.end(), part.begin(), part.end());
    }
    return table;
  }();
  return all;
}

const Format& folder_of_meshes() {
  return *std::ranges::find_if(formats(), [](const Format& format) {
    return format.kind == DataKind::sequence && format.has(Format::kFolder);
  });
}

const Format* sequence_format(const fs::path& path) {
  const std::string extension = lower_extension(path);
  const auto found = std::ranges::find_if(formats(), [&extension](const Format& format) {
    const bool is_of_frames = format.open || format.create || !format.built_by.empty();
    return format.kind == DataKind::sequence && is_of_frames && !extension.empty() &&
           format.has(extension);
  });
  return found == formats().end() ? nullptr : &*found;
}

}  // namespace mimetra
