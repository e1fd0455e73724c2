#include "toolkit/operations/call.h"

#include <algorithm>

#include "toolkit/io/pending_output.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/operations/loading.h"
#include "toolkit/operations/memory_use.h"

namespace mimetra {

namespace {

// Reading and writing as shares of the progress.
constexpr double kReadingShare = 0.3;
constexpr double kWritingShare = 0.2;

}  // namespace

void check_kind(const Operation& operation, const Input& input, const Data& data) {
  const DataKind found = kind_of(data);
  if (found == input.kind) return;
  throw UsageError("input '" + input.name + "' of '" + operation.name + "': expected the kind '" +
                   std::string(kind_name(input.kind)) + "', found '" +
                   std::string(kind_name(found)) + "'");
}

Call::Call(const OperationTable& table, CallRequest request)
    : table_(table), request_(std::move(request)) {
  check_inputs();
  check_parameters_of_files();
  check_outputs();
}

std::optional<std::filesystem::path> Call::path_of(const Output& output) const {
  const auto asked = request_.paths.find(output.name);
  if (asked != request_.paths.end()) return asked->second;
  const auto main = request_.paths.find("out");
  if (output.companion.empty() || main == request_.paths.end()) return {};
  return table_.companion_path(*request_.operation, output, main->second);
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

/// They would be ignored.
void Call::check_parameters_of_files() const {
  Operation used;
  used.parameters = request_.operation->parameters;
  for (const Input& input : request_.operation->inputs) {
    if (request_.named.contains(input.name)) used.inputs.push_back(input);
  }
  for (const Output& output : request_.operation->outputs) {
    if (path_of(output)) used.outputs.push_back(output);
  }
  const Parameters applying(table_.parameters_of(used));
  for (const Parameter& parameter : request_.parameters.declared()) {
    if (!request_.parameters.is_set(parameter.name) || applying.find(parameter.name)) continue;
    throw UsageError("parameter '" + parameter.name +
                     "' speaks of files, and nothing that it applies to is read or written; leave "
                     "it out");
  }
}

/// Refuses, before anything is read, what cannot be written.
void Call::check_outputs() const {
  const auto is_several = [](const auto& input) { return input.second.size() > 1; };
  const bool several = std::ranges::any_of(request_.named, is_several) ||
                       std::ranges::any_of(request_.given, is_several);
  for (const Output& output : request_.operation->outputs) {
    const auto path = path_of(output);
    if (!path) continue;
    table_.writer(output, *path);
    if (!several || !output.repeated) {
      table_.check_writable(output, *path, request_.overwrite);
    }
  }
  if (request_.manifest) {
    PendingOutput(*request_.manifest, PendingOutput::Kind::file, request_.overwrite);
  }
}

std::vector<std::string> Call::repeated_names() const {
  std::vector<std::string> names;
  for (const Input& input : request_.operation->inputs) {
    const auto values = invocation_.inputs.find(input.name);
    if (!input.repeated || values == invocation_.inputs.end()) continue;
    for (const NamedData& value : values->second) {
      names.push_back(name_of_output(input, value.name));
    }
  }
  return names;
}

/// Where the values of the outputs go, now that names and files of the inputs are known.
void Call::place_outputs() {
  if (request_.paths.empty()) return;
  const std::vector<std::string> names = repeated_names();
  std::set<std::filesystem::path> places, folders;
  for (const Output& output : request_.operation->outputs) {
    const auto asked = path_of(output);
    if (!asked) continue;
    paths_[output.name] = table_.output_paths(output, *asked, names);
    for (const auto& path : paths_[output.name]) {
      table_.check_writable(output, path, request_.overwrite, finished_.inputs);
      if (!places.insert(path).second) {
        throw UsageError(path.string() +
                         ": two outputs would be written there; give each a name of its own, and "
                         "run inputs of one name one by one");
      }
      if (table_.writes_folder(output, path)) folders.insert(path);
    }
  }
  for (const auto& folder : folders) {
    for (const auto& place : places) {
      const auto below = place.lexically_relative(folder);
      if (place == folder || below.empty() || *below.begin() == "..") continue;
      throw UsageError(place.string() + ": lies in " + folder.string() +
                       ", another output, which a run replaces as a whole; name a place beside it");
    }
  }
}

void Call::load() {
  const Stopwatch stopwatch;
  const double read_until = request_.named.empty() ? 0 : kReadingShare;
  const double write_from = request_.paths.empty() ? 1 : 1 - kWritingShare;
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
  LoadedInputs loaded =
      load_inputs(table_, *request_.operation, request_.parameters, request_.named,
                  part_of(request_.progress, 0, read_until), request_.log, request_.threads,
                  std::move(given), request_.may_stream);
  finished_.inputs = std::move(loaded.files);
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
  invocation_.progress = part_of(request_.progress, read_until, write_from);
  invocation_.log = request_.log;
  invocation_.threads = request_.threads;
  finished_.read_seconds = stopwatch.seconds();
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
  outcome_ = request_.operation->run(invocation_);
  finished_.run_seconds = stopwatch.seconds();
  for (const auto& [name, targets] : paths_) {
    finished_.outputs.insert(finished_.outputs.end(), targets.begin(), targets.end());
  }
  finished_.peak_memory = MemoryUse::of_this_process().peak;
  return outcome_;
}

void Call::write_values(const Output& output, const Paths& targets, const std::string& manifest,
                        const Progress& progress, std::size_t& written) const {
  const auto made = outcome_.outputs.find(output.name);
  if (made == outcome_.outputs.end()) return;
  for (std::size_t i = 0; i < made->second.size(); ++i, ++written) {
    const auto& target = targets.at(i);
    WriteRequest write{target, request_.parameters, request_.overwrite, progress};
    write.threads = request_.threads;
    write.inputs = finished_.inputs;
    // What accompanies another output stands in that one's manifest.
    if (request_.paths.contains(output.name)) {
      write.extra.emplace_back(manifest_name(target, table_.writes_folder(output, target)),
                               manifest);
    }
    table_.writer(output, target).write(made->second[i].data, write);
  }
}

void Call::write() {
  if (!writes() && !request_.manifest) return;
  const Stopwatch stopwatch;
  const std::string manifest = mimetra::manifest(finished_, outcome_.report);
  std::size_t count = 0, written = 0;
  for (const auto& [name, targets] : paths_) count += targets.size();
  // Once one output stands, the others follow: an interrupted run leaves all of them or none.
  const Progress progress = [&](double share) {
    const double done = (static_cast<double>(written) + share) / static_cast<double>(count);
    const double all = 1 - kWritingShare + kWritingShare * done;
    return !request_.progress || request_.progress(all) || written > 0;
  };
  // What is drawn while it is written comes first: nothing stands yet where that fails or ends.
  std::vector<Output> outputs = request_.operation->outputs;
  std::ranges::stable_partition(
      outputs, [](const Output& output) { return output.kind == DataKind::pictures; });
  for (const Output& output : outputs) {
    const auto targets = paths_.find(output.name);
    if (targets != paths_.end()) {
      write_values(output, targets->second, manifest, progress, written);
    }
  }
  if (request_.manifest) write_file(*request_.manifest, manifest, request_.overwrite);
  write_seconds_ = stopwatch.seconds();
}

}  // namespace mimetra
