#include "toolkit/operations/loading.h"

#include <algorithm>

#include "toolkit/io/components_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/model_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/operations/sequence_parameters.h"

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
        return {text, sequence(text, may_stream_ && input.streamed)};
      case DataKind::model:
        return model(text);
      case DataKind::components:
        files.push_back(text);
        return {text, read_components(text)};
      case DataKind::regions:
        return {text, regions(text)};
      case DataKind::fields:
        return {text, fields(text)};
      case DataKind::landmarks:
        return {text, landmarks(text)};
      case DataKind::morphable_model:
        files.push_back(text);
        return {text, ModelRead{read_model(text, threads_), text}};
      case DataKind::run:
        return {text, run(text)};
      default:
        break;
    }
    throw UsageError(text + ": no file holds a value of the kind '" +
                     std::string(kind_name(input.kind)) + "'");
  }

  /// The mesh that region sets are for, if the value has one.
  bool know(const Data& data) {
    if (const auto* read = std::get_if<SequenceRead>(&data)) {
      return know(read->frames().vertices(), read->frames().triangles());
    }
    if (const auto* fields = std::get_if<FieldSequence>(&data)) {
      return know(fields->sequence.vertices(), fields->sequence.triangles());
    }
    if (const auto* model = std::get_if<BlendshapeModel>(&data)) {
      return know(model->vertices(), model->connectivity().triangles);
    }
    if (const auto* read = std::get_if<ModelRead>(&data)) {
      return know(read->model.vertices(), read->model.connectivity().triangles);
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
    const auto frames = frame_parameters().read(parameters_).frames;
    const auto selected = [&frames](int count) { return selected_frames(frames, count); };
    FieldSequence read = reader->read(text, selected, progress_);
    for (const auto& file : reader->files(text)) files.push_back(file);
    return read;
  }

  FieldSequence fields(const std::string& text) {
    if (auto read = with_fields(text)) return std::move(*read);
    return {sequence(text, false).sequence, {}};
  }

  SequenceRead sequence(const std::string& text, bool streamed) {
    if (auto read = with_fields(text)) return {std::move(read->sequence), false, {}, {}};
    const SequenceSource source = source_by(sequence_parameters());
    if (!streamed) return noted(read_sequence(text, source));
    OpenSequence open = open_sequence(text, source);
    return noted(SequenceRead{{},
                              open.model_driven,
                              std::move(open.files),
                              std::move(open.notes),
                              std::move(open.frames)});
  }

  LandmarksRead landmarks(const std::string& text) {
    return noted(table_.landmark_reader().read(text, source_by(frame_parameters()), parameters_));
  }

  SequenceSource source_by(const BoundParameters<SequenceSource>& list) const {
    SequenceSource source = list.read(parameters_);
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

  NamedData model(const std::string& text) {
    const ModelSpec spec = ModelSpec::parse(text);
    files.push_back(spec.path);
    if (!std::filesystem::exists(spec.path)) {
      throw IoError(spec.path.string(), "no such file or folder");
    }
    if (spec.fit) files.push_back(*spec.fit);
    if (std::filesystem::is_directory(spec.path) || is_model(spec.path)) {
      return {spec.name(), read_person(spec, threads_)};
    }
    if (!spec.identity_text.empty()) {
      throw MismatchError(text + ": '" + spec.path.string() +
                          "' is one mesh and has no identities");
    }
    TriMesh mesh = read_mesh(spec.path);
    ShapeBasis none{{}, Eigen::MatrixXd(mesh.positions.size(), 0)};
    return {spec.name(),
            BlendshapeModel(std::make_shared<Connectivity>(std::move(mesh.connectivity)),
                            std::move(mesh.positions), std::move(none))};
  }

  RegionData regions(const std::string& text) {
    if (vertices_ == 0) throw UsageError(text + ": regions speak of a mesh, and no input has one");
    files.push_back(text);
    return {table_.region_reader(text).read(text, vertices_, triangles_), {}};
  }

  /// What the run read, read again.
  RunRead run(const std::string& text) {
    RunRead read{read_run(text), {}};
    const Operation* operation = table_.find(read.record.operation);
    if (!operation) {
      throw MismatchError(read.record.manifest.string() + ": a run of '" + read.record.operation +
                          "', which this program does not know");
    }
    Invocation invocation;
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
    read.invocation = std::make_shared<const Invocation>(std::move(invocation));
    return read;
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
  const auto check_read = [&](const std::string& name, const std::string& reader) {
    const auto path = parameters.find(name) ? parameters.optional_text(name) : std::nullopt;
    if (!path) return;
    const bool is_read =
        std::ranges::find(loaded.files, std::filesystem::path(*path)) != loaded.files.end();
    if (!is_read) throw MismatchError("--" + name + " " + *path + ": no input is " + reader);
  };
  check_read("weights", "a model that it could drive");
  check_read("topology", "an array that needs its faces");
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
