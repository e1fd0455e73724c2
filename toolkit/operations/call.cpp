#include "toolkit/operations/call.h"

#include <algorithm>
#include <cstdint>

#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/this_process.h"

namespace mimetra {

void check_kind(const Operation& operation, const Input& input, const Data& data) {
  const DataKind found = kind_of(data);
  if (found == input.kind) return;
  const std::string expected(kind_name(input.kind));
  const auto holds_poses = [](DataKind kind) {
    return kind == DataKind::sequence || kind == DataKind::model;
  };
  const bool is_near = holds_poses(input.kind) && holds_poses(found);
  throw UsageError("input '" + input.name + "' of '" + operation.name + "': expected the kind '" +
                   expected + "', found '" + std::string(kind_name(found)) + "'" +
                   (is_near ? "; a pose and its faces are a " + expected : ""));
}

namespace {

/// Reads the inputs one after the other.
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
    ReadOptions options = read_options(format.reading, input.shape ? as_it_is : parameters_);
    options.fields = input.fields;
    options.identities = input.identities;
    options.vertices = vertices_;
    options.triangles = &triangles_;
    const bool loads = input.kind == DataKind::sequence && !(may_stream_ && input.streamed);
    ReadValue read = format.read(text, options, loads ? context.part(0, 0) : context);
    if (loads) read.value.data = in_memory(std::move(read.value.data), context);
    context.report(1);
    for (const std::string& note : read.notes) {
      if (log_) log_(LogLevel::warning, note);
    }
    files.insert(files.end(), read.files.begin(), read.files.end());
    read.value.origin.notes = std::move(read.notes);
    return std::move(read.value);
  }

  /// Takes the mesh for region sets from a value; false if the value has none.
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

  /// Reads a manifest, and the inputs of its run.
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
  // Regions belong to the first input with a mesh.
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
  if (input.kind == DataKind::model) return name;  // name of a person
  const bool is_pattern = name.find_first_of("*%") != std::string::npos;
  ModelSpec spec = is_pattern ? ModelSpec{name, {}, {}} : ModelSpec::parse(name);
  if (spec.path.stem() == "*") spec.path = spec.path.parent_path();
  const std::string word = spec.name();
  if (!word.empty() && word.find('/') == std::string::npos) return word;
  throw UsageError(name + ": has no name for its output; give it one of its own");
}

namespace {

/// Ranks send hashes as numbers. A double holds 32 bits exactly, but not 64.
constexpr int kHalves = 2;
constexpr int kHalfBits = 32;

std::vector<double> numbers_of(const std::vector<std::filesystem::path>& files) {
  std::vector<double> numbers;
  numbers.reserve(kHalves * files.size());
  for (const auto& file : files) {
    const std::uint64_t hash = hash_of_ends(file);
    numbers.push_back(static_cast<double>(hash >> kHalfBits));
    numbers.push_back(static_cast<double>(hash & 0xffffffffu));
  }
  return numbers;
}

}  // namespace

void check_same_inputs(const std::vector<std::filesystem::path>& inputs, const Context& context) {
  const Ranks& ranks = context.ranks();
  if (ranks.count() == 1) return;
  const std::vector<std::filesystem::path> files = input_files(inputs);
  const std::vector<double> own = numbers_of(files);
  double count = static_cast<double>(own.size());
  ranks.broadcast(0, {&count, 1});
  std::vector<double> of_first = own;
  of_first.resize(static_cast<std::size_t>(count));
  ranks.broadcast(0, of_first);
  if (of_first == own) return;
  const std::string process = "process " + std::to_string(ranks.rank());
  if (of_first.size() != own.size()) {
    throw MismatchError(process + " reads " + counted(std::ssize(files), "file") + ", process 0 " +
                        std::to_string(of_first.size() / kHalves) +
                        "; all must see the same inputs");
  }
  const auto first = std::ranges::mismatch(own, of_first).in1 - own.begin();
  throw MismatchError(files[static_cast<std::size_t>(first / kHalves)].string() + ": " + process +
                      " reads another content than process 0; all must see the same inputs");
}

namespace {

// Shares of reading and writing in the progress.
constexpr double kReadingShare = 0.3;
constexpr double kWritingShare = 0.2;

/// Returns one spelling of a path for each place.
std::filesystem::path place_of(const std::filesystem::path& path) {
  std::error_code unreadable;
  std::filesystem::path place = weakly_canonical(absolute(path), unreadable);
  if (unreadable) place = absolute(path).lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

/// Returns a sequence with its optional fields.
FieldSequence with_more_fields(const NamedData& value) {
  FieldSequence sequence = std::get<FieldSequence>(value.data);
  sequence.fields.insert(sequence.fields.end(), value.more_fields.begin(), value.more_fields.end());
  return sequence;
}

/// Throws IoError for a text that is neither a path nor one of the words that may replace it.
void check_words(const CallRequest& request) {
  for (const Parameter& parameter : request.operation->parameters) {
    if (parameter.kind != ParameterKind::file || parameter.choices.empty()) continue;
    for (const std::string& text : request.parameters.paths(parameter.name)) {
      std::error_code unreadable;
      if (std::filesystem::exists(text, unreadable) || unreadable) continue;
      throw IoError(text, "no such file; " + parameter.option() + " takes " +
                              joined(parameter.choices, ", ", " or ") + ", or a file" +
                              suggestion_for(text, parameter.choices));
    }
  }
}

/// Calls `work`. If that cannot read a file, reports a mistyped word first.
template <typename Work>
void reading_files(const CallRequest& request, const Work& work) {
  try {
    work();
  } catch (const IoError&) {
    check_words(request);
    throw;
  }
}

}  // namespace

Call::Call(const OperationTable& table, CallRequest request)
    : table_(table), request_(std::move(request)) {
  check_inputs();
  check_exclusions([this](const std::string& name) {
    return request_.given.contains(name) || request_.named.contains(name) ||
           request_.wanted.contains(name) || request_.destinations.contains(name);
  });
  check_parameters_of_files();
  check_outputs();
}

bool Call::helps_another() const {
  return request_.context.ranks().rank() > 0;
}

std::optional<Destination> Call::destination_of(const Output& output) const {
  const auto asked = request_.destinations.find(output.name);
  if (asked != request_.destinations.end()) return asked->second;
  const auto main = request_.destinations.find("out");
  if (output.companion.empty() || main == request_.destinations.end()) return {};
  return Destination{table_.companion_path(*request_.operation, output, main->second.path),
                     main->second.overwrite};
}

void Call::check_inputs() const {
  for (const Input& input : request_.operation->inputs) {
    const auto given = request_.given.find(input.name);
    if (given != request_.given.end()) {
      for (const NamedData& value : given->second) {
        check_kind(*request_.operation, input, value.data);
      }
    }
    const bool has_one = given != request_.given.end() || request_.named.contains(input.name);
    if (has_one || input.optional) continue;
    throw UsageError("operation '" + request_.operation->name + "' needs its input '" + input.name +
                     "': " + input.help);
  }
}

void Call::check_exclusions(const HasValue& has_value) const {
  const auto found = refusal(request_.operation->exclusions, request_.parameters, has_value);
  if (found) throw UsageError(*found);
}

/// Refuses parameters of files that would be ignored.
void Call::check_parameters_of_files() const {
  std::vector<Parameter> applying = request_.operation->parameters;
  for (const Input& input : request_.operation->inputs) {
    const auto named = request_.named.find(input.name);
    if (input.run || named == request_.named.end()) continue;
    for (const std::string& text : named->second) {
      const auto& reading = table_.reader(input.kind, text).reading;
      applying.insert(applying.end(), reading.begin(), reading.end());
    }
  }
  for (const Output& output : request_.operation->outputs) {
    const auto asked = destination_of(output);
    if (!asked) continue;
    const auto& writing = table_.writer(output, asked->path).writing;
    applying.insert(applying.end(), writing.begin(), writing.end());
  }
  for (const Parameter& parameter : request_.parameters.declared()) {
    const bool applies =
        std::ranges::find(applying, parameter.name, &Parameter::name) != applying.end();
    if (!request_.parameters.is_set(parameter.name) || applies) continue;
    throw UsageError("parameter '" + parameter.name + "' is about files (" + parameter.help +
                     "), and nothing that it applies to is read or written; leave "
                     "it out");
  }
}

/// Refuses outputs that cannot be written, before anything is read.
void Call::check_outputs() const {
  if (helps_another()) return;
  const auto is_several = [](const auto& input) { return input.second.size() > 1; };
  const bool several = std::ranges::any_of(request_.named, is_several) ||
                       std::ranges::any_of(request_.given, is_several);
  for (const Output& output : request_.operation->outputs) {
    const auto asked = destination_of(output);
    if (!asked) continue;
    table_.writer(output, asked->path);
    if (!several || !output.repeated) {
      table_.check_writable(output, asked->path, asked->overwrite);
    }
  }
  if (request_.manifest) check_manifest();
}

/// Checks the manifest's path before anything is read. Refuses to replace anything but a separate
/// manifest of the same operation.
void Call::check_manifest() const {
  const auto& [path, overwrite] = *request_.manifest;
  const bool may_replace =
      !accompanies_an_output(path) && is_manifest_of_operation(path, request_.operation->name);
  if (overwrite && std::filesystem::exists(path) && !may_replace) {
    throw OutputError(path.string(), "exists already, and is no manifest of a run of '" +
                                         request_.operation->name +
                                         "' that stands for itself; choose another name");
  }
  PendingOutput(path, PendingOutput::Kind::file, overwrite);
}

std::vector<std::string> Call::repeated_names() const {
  std::vector<std::string> names;
  // Inputs need names only if an output has one value for each.
  if (std::ranges::none_of(request_.operation->outputs, &Output::repeated)) return names;
  for (const Input& input : request_.operation->inputs) {
    const auto values = invocation_.inputs.find(input.name);
    if (!input.repeated || values == invocation_.inputs.end()) continue;
    for (const NamedData& value : values->second) {
      names.push_back(name_of_output(input, value.name));
    }
  }
  return names;
}

/// The files that were read and the folders that the user gave. A new file in such a folder would
/// be read next time.
Call::Paths Call::inputs_that_stay() const {
  Paths paths = finished_.inputs;
  for (const auto& [input, names] : finished_.named_inputs) {
    std::error_code unreadable;
    for (const std::string& name : names) {
      if (std::filesystem::is_directory(name, unreadable)) paths.emplace_back(name);
    }
  }
  return paths;
}

/// Sets the paths of the outputs, now that names and files of the inputs are known.
void Call::place_outputs() {
  const std::vector<std::string> names = repeated_names();
  // The user's spelling by place.
  std::map<std::filesystem::path, std::filesystem::path> places, folders;
  const auto claim = [&places](const std::filesystem::path& path) {
    if (places.emplace(place_of(path), path).second) return;
    throw UsageError(path.string() +
                     ": two outputs would be written there; give each a name of its own, and "
                     "run inputs of one name one by one");
  };
  for (const Output& output : request_.operation->outputs) {
    const auto asked = destination_of(output);
    if (!asked) continue;
    const bool is_folder = table_.writes_folder(output, asked->path);
    paths_[output.name] = table_.output_paths(output, asked->path, names);
    for (const auto& path : paths_[output.name]) {
      if (!helps_another()) {
        table_.check_writable(output, is_folder ? path / "" : path, asked->overwrite,
                              inputs_that_stay());
      }
      claim(path);
      if (is_folder) folders.emplace(place_of(path), path);
    }
  }
  if (request_.manifest) {
    check_inputs_stay(request_.manifest->path, inputs_that_stay());
    claim(request_.manifest->path);
  }
  for (const auto& [folder, folder_name] : folders) {
    for (const auto& [place, name] : places) {
      const auto below = place.lexically_relative(folder);
      if (place == folder || below.empty() || *below.begin() == "..") continue;
      throw UsageError(name.string() + ": lies in " + folder_name.string() +
                       ", another output, which a run replaces as a whole; name a place beside it");
    }
  }
}

void Call::load() {
  const Stopwatch stopwatch;
  const double read_until = request_.named.empty() ? 0 : kReadingShare;
  const double write_from = request_.destinations.empty() ? 1 : 1 - kWritingShare;
  finished_.operation = request_.operation->name;
  finished_.parameters = request_.parameters;
  finished_.arguments = std::move(request_.arguments);
  finished_.named_inputs = request_.named;
  std::map<std::string, std::vector<NamedData>> given;
  for (const Input& input : request_.operation->inputs) {
    for (NamedData& value : request_.given[input.name]) {
      finished_.given_inputs[input.name].push_back(value.name);
      given[input.name].push_back(std::move(value));
    }
  }
  request_.given.clear();
  LoadedInputs loaded = load_inputs(
      table_, *request_.operation, request_.parameters, request_.named, request_.log,
      std::move(given), request_.may_stream, request_.context.part(0, read_until).without_ranks());
  finished_.inputs = std::move(loaded.files);
  for (const std::filesystem::path file : request_.parameters.files()) {
    request_.files.push_back(file);
  }
  for (const auto& file : request_.files) {
    if (std::ranges::find(finished_.inputs, file) == finished_.inputs.end()) {
      finished_.inputs.push_back(file);
    }
  }
  invocation_.inputs = std::move(loaded.data);
  place_outputs();
  invocation_.parameters = request_.parameters;
  invocation_.wanted = paths_;
  for (const std::string& output : request_.wanted) want(output);
  for (const Output& output : request_.operation->outputs) {
    if (!output.optional) want(output.name);
  }
  invocation_.log = request_.log;
  invocation_.context = request_.context.part(read_until, write_from);
  if (!request_.operation->shared) invocation_.context = invocation_.context.without_ranks();
  invocation_.context = with_notes_as_warnings(invocation_);
  invocation_.landmark_finder = table_.landmark_finder();
  finished_.read_seconds = stopwatch.seconds();
}

void Call::foresee() const {
  const Operation& operation = *request_.operation;
  if (operation.foresee) reading_files(request_, [&] { operation.foresee(invocation_); });
  for (const Output& output : request_.operation->outputs) {
    const auto targets = paths_.find(output.name);
    if (targets == paths_.end()) continue;
    const Destination asked = *destination_of(output);
    const bool is_folder = table_.writes_folder(output, asked.path);
    for (const auto& target : targets->second) {
      const auto path = is_folder ? target / "" : target;
      const std::vector<std::string> refusals =
          output.kind == DataKind::sequence ? refused_companions(path, asked.overwrite)
                                            : refused_parts(path, asked.overwrite, output.paired);
      for (const std::string& refusal : refusals) invocation_.warn(refusal);
    }
  }
}

void Call::want(const std::string& output) {
  invocation_.wanted[output];
}

void Call::give(const std::string& input, NamedData data) {
  finished_.given_inputs[input] = {data.name};
  invocation_.inputs[input] = {std::move(data)};
}

const Outcome& Call::run() {
  const Stopwatch stopwatch;
  // Hosts may have given inputs and requested outputs since the constructor.
  check_exclusions([this](const std::string& name) {
    return invocation_.has_input(name) || invocation_.wants(name);
  });
  check_same_inputs(finished_.inputs, invocation_.context);
  reading_files(request_, [this] { outcome_ = request_.operation->run(invocation_); });
  finished_.run_seconds = stopwatch.seconds();
  for (const auto& [name, targets] : paths_) {
    finished_.outputs.insert(finished_.outputs.end(), targets.begin(), targets.end());
  }
  finished_.peak_memory = MemoryUse::of_this_process().peak;
  return outcome_;
}

void Call::write_values(const Output& output, const Paths& targets, const std::string& manifest,
                        PendingOutputs& together, const Context& context) const {
  const auto made = outcome_.outputs.find(output.name);
  if (made == outcome_.outputs.end()) return;
  const double count = static_cast<double>(made->second.size());
  const Destination asked = *destination_of(output);
  const Format& format = table_.writer(output, asked.path);
  const bool is_folder = format.has(Format::kFolder);
  for (std::size_t i = 0; i < made->second.size(); ++i) {
    const auto& target = targets.at(i);
    // A folder's name may contain a dot, so it ends in a slash.
    const std::filesystem::path path = is_folder ? target / "" : target;
    WriteOptions options = write_options(format.writing, request_.parameters);
    options.overwrite = asked.overwrite;
    options.inputs = inputs_that_stay();
    options.together = &together;
    // The main output's manifest covers its companions.
    if (request_.destinations.contains(output.name)) {
      options.extra.emplace_back(manifest_name(target, is_folder), manifest);
    }
    for (const auto& [ending, text] : made->second[i].beside) {
      const std::string name = is_folder ? ending.substr(1) : target.stem().string() + ending;
      options.extra.emplace_back(name, text);
    }
    const NamedData& value = made->second[i];
    const double done = static_cast<double>(i);
    const Context of_value = context.part(done / count, (done + 1) / count);
    if (format.fields && !value.more_fields.empty()) {
      format.write(with_more_fields(value), path, options, of_value);
    } else {
      format.write(value.data, path, options, of_value);
    }
    for (const std::string& note : notes_on_losses(format, value.data, path, options)) {
      if (request_.log) request_.log(LogLevel::warning, note);
    }
  }
}

void Call::write() {
  const Stopwatch stopwatch;
  // An interrupted run leaves all of its outputs or none.
  PendingOutputs together(false, inputs_that_stay());
  if ((writes() || request_.manifest) && !helps_another()) write_outputs(together);
  // If another process fails, no output appears.
  invocation_.context.ranks().meet([this] {
    request_.context.report(1);
    return true;
  });
  together.commit();
  write_seconds_ = stopwatch.seconds();
}

void Call::write_outputs(PendingOutputs& together) const {
  const std::string manifest = mimetra::manifest(finished_, outcome_.report);
  const Context writing = request_.context.part(1 - kWritingShare, 1).without_ranks();
  double count = 0, written = 0;
  for (const auto& [name, targets] : paths_) count += static_cast<double>(targets.size());
  for (const Output& output : request_.operation->outputs) {
    const auto targets = paths_.find(output.name);
    if (targets == paths_.end()) continue;
    const double until = written + static_cast<double>(targets->second.size());
    write_values(output, targets->second, manifest, together,
                 writing.part(written / count, until / count));
    written = until;
  }
  if (request_.manifest) {
    write_file(request_.manifest->path, manifest, request_.manifest->overwrite, &together);
  }
}

}  // namespace mimetra
