#include "toolkit/operations/loading.h"

#include <algorithm>

#include "toolkit/io/components_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"

namespace mimetra {

namespace {

/// Reads one input after the other.
class Loader {
 public:
  Loader(const OperationTable& table, const Parameters& parameters, const Progress& progress,
         const Log& log, int threads, bool may_stream)
      : table_(table),
        parameters_(parameters),
        progress_(progress),
        log_(log),
        threads_(threads),
        may_stream_(may_stream) {}

  NamedData load(const Input& input, const std::string& text) {
    switch (input.kind) {
      case DataKind::sequence:
        return sequence(input, text);
      case DataKind::model:
        return model(text, input.identities);
      case DataKind::components:
        files.push_back(text);
        return {text, read_components(text)};
      case DataKind::regions:
        return {text, regions(text)};
      case DataKind::landmarks:
        return landmarks(text);
      case DataKind::document:
        if (input.run) return run(text);
        files.push_back(text);
        return {text, Document{read_file(text)}};
      case DataKind::table:
      case DataKind::fit:
      case DataKind::pictures:
        break;
    }
    throw UsageError(text + ": no file holds a value of the kind '" +
                     std::string(kind_name(input.kind)) + "'");
  }

  /// The mesh that region sets are for, if the value has one.
  bool know(const Data& data) {
    if (const auto* sequence = std::get_if<FieldSequence>(&data)) {
      return know(sequence->frames->vertices(), sequence->frames->triangles());
    }
    if (const auto* model = std::get_if<ModelData>(&data)) {
      return know(model->model.vertices(), model->model.connectivity().triangles);
    }
    const auto* components = std::get_if<Components>(&data);
    return components && know(components->vertices(), components->triangles);
  }

  std::vector<std::filesystem::path> files;

 private:
  /// A sequence in a format that also holds fields; none where another reader is needed.
  std::optional<FieldSequence> with_fields(const std::string& text) {
    const FieldReader* reader = table_.field_reader(text);
    if (!reader) return {};
    const auto frames = parameters_.optional_text("frames");
    const auto selected = [&frames](int count) { return selected_frames(frames, count); };
    FieldSequence read = reader->read(text, selected, progress_);
    for (const auto& file : reader->files(text)) files.push_back(file);
    return read;
  }

  NamedData sequence(const Input& input, const std::string& text) {
    if (auto read = with_fields(text)) {
      if (!input.fields) read->fields.clear();
      return {text, std::move(*read)};
    }
    SequenceSource source = frames_asked_for();
    const auto path = [this](const char* name) {
      const auto value = parameters_.optional_text(name);
      return value ? std::optional<std::filesystem::path>(*value) : std::nullopt;
    };
    source.weights = path("weights");
    source.topology = path("topology");
    if (may_stream_ && input.streamed) {
      OpenSequence open = noted(open_sequence(text, source));
      return {text, FieldSequence(std::move(open.frames)), {.model_driven = open.model_driven}};
    }
    SequenceRead read = noted(read_sequence(text, source));
    return {text, FieldSequence(std::move(read.sequence)), {.model_driven = read.model_driven}};
  }

  NamedData landmarks(const std::string& text) {
    LandmarksRead read =
        noted(table_.landmark_reader().read(text, frames_asked_for(), parameters_));
    Origin origin;
    origin.images = std::move(read.images);
    origin.frame_notes = std::move(read.frame_notes);
    return {text, std::move(read.track), std::move(origin)};
  }

  SequenceSource frames_asked_for() const {
    SequenceSource source;
    source.frames = parameters_.optional_text("frames");
    source.fps = parameters_.optional_number("fps");
    source.threads = threads_;
    source.progress = progress_;
    return source;
  }

  /// Logs the notes of what was read, and keeps its files for the manifest.
  template <typename Read>
  Read noted(Read read) {
    for (const std::string& note : read.notes) {
      if (log_) log_(LogLevel::warning, note);
    }
    files.insert(files.end(), read.files.begin(), read.files.end());
    return read;
  }

  bool know(int vertices, const Triangles& triangles) {
    vertices_ = vertices;
    triangles_ = triangles;
    return true;
  }

  NamedData model(const std::string& text, bool with_identities) {
    const ModelSpec spec = ModelSpec::parse(text);
    const bool is_person = spec.fit || !spec.identity_text.empty();
    Origin origin;
    origin.path = spec.path;
    files.push_back(spec.path);
    if (!std::filesystem::exists(spec.path)) {
      throw IoError(spec.path.string(), "no such file or folder");
    }
    if (spec.fit) files.push_back(*spec.fit);
    if (std::filesystem::is_directory(spec.path) || is_model(spec.path)) {
      const auto read = [&] {
        return with_identities && !is_person ? read_model(spec.path, threads_)
                                             : MorphableModel(read_person(spec, threads_));
      };
      return {spec.name(), ModelData{read()}, std::move(origin)};
    }
    if (is_person) {
      throw MismatchError(text + ": '" + spec.path.string() +
                          "' is one mesh and has no identities");
    }
    TriMesh mesh = read_mesh(spec.path);
    MorphableModel model(std::make_shared<Connectivity>(std::move(mesh.connectivity)),
                         std::move(mesh.positions), {}, {});
    return {spec.name(), ModelData{std::move(model)}, std::move(origin)};
  }

  RegionData regions(const std::string& text) {
    if (vertices_ == 0) throw UsageError(text + ": regions speak of a mesh, and no input has one");
    files.push_back(text);
    return {table_.region_reader(text).read(text, vertices_, triangles_), {}};
  }

  /// The manifest; and what the run read, read again.
  NamedData run(const std::string& text) {
    RunRead read;
    read.record = read_run(text);
    const Operation* operation = table_.find(read.record.operation);
    if (!operation) {
      throw MismatchError(read.record.manifest.string() + ": a run of '" + read.record.operation +
                          "', which this program does not know");
    }
    Invocation& invocation = read.invocation;
    invocation.parameters = Parameters(table_.parameters_of(*operation));
    for (const auto& [name, value] : read.record.options) {
      const Parameter* parameter = invocation.parameters.find(name);
      if (parameter && value != to_text(parameter->fallback)) {
        invocation.parameters.set(name, parse_value(*parameter, value));
      }
    }
    LoadedInputs loaded = load_inputs(table_, *operation, invocation.parameters, read.record.inputs,
                                      progress_, log_, threads_);
    for (const Input& input : operation->inputs) {
      if (input.optional || loaded.data.contains(input.name)) continue;
      throw IoError(read.record.manifest.string(), "names no " + input.name + " of the run");
    }
    files.push_back(read.record.manifest);
    files.insert(files.end(), loaded.files.begin(), loaded.files.end());
    invocation.inputs = std::move(loaded.data);
    invocation.threads = threads_;
    Document manifest{read_file(read.record.manifest)};
    Origin origin;
    origin.run = std::make_shared<const RunRead>(std::move(read));
    return {text, std::move(manifest), std::move(origin)};
  }

  const OperationTable& table_;
  const Parameters& parameters_;
  const Progress& progress_;
  const Log& log_;
  int threads_;
  bool may_stream_;
  int vertices_ = 0;
  Triangles triangles_;
};

}  // namespace

LoadedInputs load_inputs(const OperationTable& table, const Operation& operation,
                         const Parameters& parameters,
                         const std::map<std::string, std::vector<std::string>>& names,
                         const Progress& progress, const Log& log, int threads,
                         std::map<std::string, std::vector<NamedData>> given, bool may_stream) {
  Loader loader(table, parameters, progress, log, threads, may_stream);
  LoadedInputs loaded{std::move(given), {}};
  const auto load = [&](const Input& input) {
    const auto named = names.find(input.name);
    if (named == names.end()) return;
    for (const std::string& text : named->second) {
      loaded.data[input.name].push_back(loader.load(input, text));
    }
  };
  for (const Input& input : operation.inputs) {
    if (input.kind != DataKind::regions) load(input);
  }
  // Regions are for the first mesh.
  const auto has_mesh = [&](const Input& input) {
    const auto values = loaded.data.find(input.name);
    return values != loaded.data.end() && !values->second.empty() &&
           loader.know(values->second.front().data);
  };
  for (const Input& input : operation.inputs) {
    if (has_mesh(input)) break;
  }
  for (const Input& input : operation.inputs) {
    if (input.kind == DataKind::regions) load(input);
  }
  loaded.files = std::move(loader.files);
  for (const char* name : {"weights", "topology"}) {
    const auto path = parameters.find(name) ? parameters.optional_text(name) : std::nullopt;
    if (!path ||
        std::ranges::find(loaded.files, std::filesystem::path(*path)) != loaded.files.end())
      continue;
    throw MismatchError("--" + std::string(name) + " " + *path + ": no input is " +
                        (name == std::string("weights") ? "a model that it could drive"
                                                        : "an array that needs its faces"));
  }
  return loaded;
}

std::string name_of_output(const Input& input, const std::string& name) {
  if (input.kind == DataKind::model) return name;  // a person's own
  const bool is_pattern = name.find_first_of("*%") != std::string::npos;
  ModelSpec spec = is_pattern ? ModelSpec{name, {}, {}} : ModelSpec::parse(name);
  if (spec.path.stem() == "*") spec.path = spec.path.parent_path();
  const std::string word = spec.name();
  if (!word.empty() && word.find('/') == std::string::npos) return word;
  throw UsageError(name + ": has no name for its output; give it one of its own");
}

}  // namespace mimetra
