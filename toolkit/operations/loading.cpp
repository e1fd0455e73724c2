#include "toolkit/operations/loading.h"

#include <algorithm>

#include "toolkit/io/model_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// Reads one input after the other.
class Loader {
 public:
  Loader(const OperationTable& table, const Parameters& parameters, const Log& log, bool may_stream)
      : table_(table), parameters_(parameters), log_(log), may_stream_(may_stream) {}

  NamedData load(const Input& input, const std::string& text, const Context& context) {
    if (input.run) return run(text, context);
    const Format& format = table_.reader(input.kind, text);
    if (input.kind == DataKind::regions && vertices_ == 0) {
      throw UsageError(text + ": regions speak of a mesh, and no input has one");
    }
    const Parameters as_it_is(parameters_.declared());
    const ReadRequest request{.parameters = input.shape ? as_it_is : parameters_,
                              .fields = input.fields,
                              .identities = input.identities,
                              .may_stream = may_stream_ && input.streamed,
                              .vertices = vertices_,
                              .triangles = &triangles_};
    ReadValue read = format.read(text, request, context);
    for (const std::string& note : read.notes) {
      if (log_) log_(LogLevel::warning, note);
    }
    files.insert(files.end(), read.files.begin(), read.files.end());
    read.value.origin.notes = std::move(read.notes);
    return std::move(read.value);
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
  bool know(int vertices, const Triangles& triangles) {
    vertices_ = vertices;
    triangles_ = triangles;
    return true;
  }

  /// The manifest; and what the run read, read again.
  NamedData run(const std::string& text, const Context& context) {
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
                                      log_, {}, false, context);
    for (const Input& input : operation->inputs) {
      if (input.optional || loaded.data.contains(input.name)) continue;
      throw IoError(read.record.manifest.string(), "names no " + input.name + " of the run");
    }
    files.push_back(read.record.manifest);
    files.insert(files.end(), loaded.files.begin(), loaded.files.end());
    invocation.inputs = std::move(loaded.data);
    invocation.context = Context().with_threads(context.threads());
    invocation.landmark_finder = table_.landmark_finder();
    Document manifest{read_file(read.record.manifest)};
    Origin origin;
    origin.run = std::make_shared<const RunRead>(std::move(read));
    return {text, std::move(manifest), std::move(origin)};
  }

  const OperationTable& table_;
  const Parameters& parameters_;
  const Log& log_;
  bool may_stream_;
  int vertices_ = 0;
  Triangles triangles_;
};

}  // namespace

LoadedInputs load_inputs(const OperationTable& table, const Operation& operation,
                         const Parameters& parameters,
                         const std::map<std::string, std::vector<std::string>>& names,
                         const Log& log, std::map<std::string, std::vector<NamedData>> given,
                         bool may_stream, const Context& context) {
  Loader loader(table, parameters, log, may_stream);
  LoadedInputs loaded{std::move(given), {}};
  double count = 0, done = 0;
  for (const auto& [name, texts] : names) count += static_cast<double>(texts.size());
  const auto load = [&](const Input& input) {
    const auto named = names.find(input.name);
    if (named == names.end()) return;
    for (const std::string& text : named->second) {
      const Context part = context.part(done / count, (done + 1) / count);
      loaded.data[input.name].push_back(loader.load(input, text, part));
      ++done;
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
