#include "toolkit/operations/call.h"

#include <algorithm>

#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_companions.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/suggestion.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/command_terms.h"
#include "toolkit/operations/input_files.h"
#include "toolkit/operations/loading.h"
#include "toolkit/operations/memory_use.h"

namespace mimetra {

namespace {

// Reading and writing as shares of the progress.
constexpr double kReadingShare = 0.3;
constexpr double kWritingShare = 0.2;

/// One spelling for each place.
std::filesystem::path place_of(const std::filesystem::path& path) {
  std::error_code unreadable;
  std::filesystem::path place = weakly_canonical(absolute(path), unreadable);
  if (unreadable) place = absolute(path).lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

/// A sequence with the fields that nobody asked for.
FieldSequence with_more_fields(const NamedData& value) {
  FieldSequence sequence = std::get<FieldSequence>(value.data);
  sequence.fields.insert(sequence.fields.end(), value.more_fields.begin(), value.more_fields.end());
  return sequence;
}

/// Throws IoError for what is given where a word could be, and is neither one nor a path.
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

/// Does `work`; where it cannot read a file, a word that was mistaken for one is what is wrong.
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

/// They would be ignored.
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

/// Refuses, before anything is read, what cannot be written.
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

/// Before anything is read: what it would replace is a manifest that stands for itself.
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
  // Where no output is one for each of them, an input needs no name.
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

/// What was read, and the folders that were named: a new file in one of those would be read next
/// time.
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

/// Where the values of the outputs go, now that names and files of the inputs are known.
void Call::place_outputs() {
  const std::vector<std::string> names = repeated_names();
  // What people typed, by where it is.
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
  // Hosts may have given and asked for more since.
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
    // With a slash at its end a folder's name may have a dot.
    WriteRequest write{is_folder ? target / "" : target, request_.parameters, asked.overwrite};
    write.inputs = inputs_that_stay();
    write.together = &together;
    // What accompanies another output stands in that one's manifest.
    if (request_.destinations.contains(output.name)) {
      write.extra.emplace_back(manifest_name(target, is_folder), manifest);
    }
    for (const auto& [ending, text] : made->second[i].beside) {
      const std::string name = is_folder ? ending.substr(1) : target.stem().string() + ending;
      write.extra.emplace_back(name, text);
    }
    const NamedData& value = made->second[i];
    const double done = static_cast<double>(i);
    const Context of_value = context.part(done / count, (done + 1) / count);
    if (format.fields && !value.more_fields.empty()) {
      format.write(with_more_fields(value), write, of_value);
    } else {
      format.write(value.data, write, of_value);
    }
    for (const std::string& note : notes_on_losses(format, value.data, write)) {
      if (request_.log) request_.log(LogLevel::warning, note);
    }
  }
}

void Call::write() {
  const Stopwatch stopwatch;
  // An interrupted run leaves all of its outputs or none.
  PendingOutputs together(false, inputs_that_stay());
  if ((writes() || request_.manifest) && !helps_another()) write_outputs(together);
  // Nothing stands of a run that another process could not finish.
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
