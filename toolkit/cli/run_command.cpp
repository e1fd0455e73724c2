#include "toolkit/cli/run_command.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>
#include <set>

#include <spdlog/spdlog.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "toolkit/cli/dry_run.h"
#include "toolkit/cli/manifest.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/loading.h"

namespace mimetra::cli {

namespace {

std::atomic<bool> interrupted = false;

/// A line on the terminal that is drawn again whenever the percentage changes.
class Bar {
 public:
  Bar(std::string title, bool shown) : title_(std::move(title)), shown_(shown) {}
  ~Bar() { clear(); }
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;

  bool update(double share) {
    const int percent = static_cast<int>(std::floor(100 * share));
    if (shown_ && percent != percent_) {
      percent_ = percent;
      std::fprintf(stderr, "\r%s %3d %%", title_.c_str(), percent);
      std::fflush(stderr);
    }
    return !interrupted;
  }

  void clear() {
    if (shown_ && percent_ >= 0) std::fprintf(stderr, "\r\033[K");
    percent_ = -1;
  }

 private:
  std::string title_;
  bool shown_;
  int percent_ = -1;
};

bool shows_bar(const Request& request) {
  if (request.quiet || request.progress == ProgressBar::never) return false;
  return request.progress == ProgressBar::always || isatty(STDERR_FILENO);
}

// Reading, running and writing as shares of the progress bar.
constexpr double kRunningFrom = 0.3;
constexpr double kWritingFrom = 0.8;

using OutputPaths = std::map<std::string, std::vector<std::filesystem::path>>;

/// Where an output was asked for, or goes because it accompanies another; none for one that is not
/// made.
std::optional<std::filesystem::path> path_of(const OperationTable& table, const Request& request,
                                             const Output& output) {
  if (const auto asked = request.outputs.find(output.name); asked != request.outputs.end()) {
    return asked->second;
  }
  const auto main = request.outputs.find("out");
  if (output.companion.empty() || main == request.outputs.end()) return {};
  return table.companion_path(*request.operation, output, main->second);
}

/// Refuses, before anything is read, what cannot be written.
void check_outputs(const OperationTable& table, const Request& request) {
  const bool several = std::ranges::any_of(
      request.inputs, [](const auto& input) { return input.second.size() > 1; });
  for (const Output& output : request.operation->outputs) {
    const auto path = path_of(table, request, output);
    if (!path) continue;
    table.writer(output.kind, *path);
    if (!several || !output.repeated) table.check_writable(output.kind, *path, request.force);
  }
}

/// Where the values of the outputs asked for go, given the names of the repeated input and all that
/// was read.
OutputPaths output_paths(const OperationTable& table, const Request& request,
                         const std::vector<std::string>& names,
                         const std::vector<std::filesystem::path>& inputs) {
  OutputPaths all;
  std::set<std::filesystem::path> places, folders;
  for (const Output& output : request.operation->outputs) {
    const auto asked = path_of(table, request, output);
    if (!asked) continue;
    all[output.name] = table.output_paths(output, *asked, names);
    for (const auto& path : all[output.name]) {
      table.check_writable(output.kind, path, request.force, inputs);
      if (!places.insert(path).second) {
        throw UsageError(path.string() +
                         ": two outputs would be written there; give each a name of its own, and "
                         "run inputs of one name one by one");
      }
      if (table.writes_folder(output.kind, path)) folders.insert(path);
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
  return all;
}

/// Names of the repeated input.
std::vector<std::string> repeated_names(const Operation& operation, const LoadedInputs& loaded) {
  std::vector<std::string> names;
  for (const Input& input : operation.inputs) {
    const auto values = loaded.data.find(input.name);
    if (!input.repeated || values == loaded.data.end()) continue;
    for (const NamedData& value : values->second) {
      names.push_back(name_of_output(input, value.name));
    }
  }
  return names;
}

void write_outputs(const OperationTable& table, const Request& request, const FinishedRun& run,
                   const OutputPaths& paths, const Outcome& outcome,
                   const std::string& manifest_text, Bar& bar) {
  std::size_t count = 0, written = 0;
  for (const auto& [name, targets] : paths) count += targets.size();
  // Once one output stands, the others follow: an interrupted run leaves all of them or none.
  const Progress progress = [&](double share) {
    const double done = (static_cast<double>(written) + share) / static_cast<double>(count);
    return bar.update(kWritingFrom + (1 - kWritingFrom) * done) || written > 0;
  };
  // What is drawn while it is written comes first: nothing stands yet where that fails or ends.
  std::vector<Output> outputs = request.operation->outputs;
  std::ranges::stable_partition(
      outputs, [](const Output& output) { return output.kind == DataKind::pictures; });
  for (const Output& output : outputs) {
    const auto wanted = paths.find(output.name);
    const auto made = outcome.outputs.find(output.name);
    if (wanted == paths.end() || made == outcome.outputs.end()) continue;
    for (std::size_t i = 0; i < made->second.size(); ++i, ++written) {
      const auto& target = wanted->second.at(i);
      WriteRequest write{target, request.parameters, request.force, progress};
      write.threads = request.threads;
      write.inputs = run.inputs;
      // What accompanies another output stands in that one's manifest.
      if (request.outputs.contains(output.name)) {
        write.extra.emplace_back(manifest_name(target, table.writes_folder(output.kind, target)),
                                 manifest_text);
      }
      table.writer(output.kind, target).write(made->second[i].data, write);
    }
  }
}

void print_result(const Request& request, const Outcome& outcome) {
  if (request.json) {
    std::cout << Json::parse(outcome.report).dump(2) << '\n';
  } else if (!request.quiet) {
    std::cout << outcome.summary;
  }
  if (!std::cout.flush()) throw OutputError("standard output", "cannot be written");
}

/// What a run that wrote something has cost.
std::string cost(const FinishedRun& run, double write_seconds) {
  return "read in " + readable(run.read_seconds) + " s, computed in " + readable(run.run_seconds) +
         " s, written in " + readable(write_seconds) + " s, at most " +
         megabytes(MemoryUse::of_this_process().peak) + " of memory\n";
}

}  // namespace

void interrupt() {
  interrupted = true;
}

void run_command(const OperationTable& table, const Request& request) {
  check_outputs(table, request);
  Bar bar("mimetra " + request.operation->name, shows_bar(request));
  const Progress progress = [&bar](double share) { return bar.update(share); };
  const Log log = [&bar](LogLevel level, const std::string& message) {
    bar.clear();
    if (level == LogLevel::warning)
      spdlog::warn(message);
    else
      spdlog::info(message);
  };

  FinishedRun run;
  const Stopwatch reading;
  LoadedInputs loaded =
      load_inputs(table, *request.operation, request.parameters, request.inputs,
                  part_of(progress, 0, kRunningFrom), log, request.threads, {}, true);
  run.inputs = std::move(loaded.files);
  for (const std::filesystem::path file : request.files) {
    if (std::ranges::find(run.inputs, file) == run.inputs.end()) {
      run.inputs.push_back(file);
    }
  }
  const OutputPaths paths =
      output_paths(table, request, repeated_names(*request.operation, loaded), run.inputs);
  run.read_seconds = reading.seconds();

  Invocation invocation;
  invocation.inputs = std::move(loaded.data);
  invocation.parameters = request.parameters;
  invocation.wanted = paths;
  invocation.progress = part_of(progress, kRunningFrom, kWritingFrom);
  invocation.log = log;
  invocation.threads = request.threads;
  if (request.dry_run) {
    bar.clear();
    print_result(request, planned(table, *request.operation, invocation));
    return;
  }
  const Stopwatch running;
  const Outcome outcome = request.operation->run(invocation);
  run.run_seconds = running.seconds();
  for (const auto& [name, targets] : paths) {
    run.outputs.insert(run.outputs.end(), targets.begin(), targets.end());
  }
  run.report = outcome.report;
  run.peak_memory = MemoryUse::of_this_process().peak;
  const std::string manifest_text =
      request.outputs.empty() ? std::string() : manifest(request, run);
  const Stopwatch writing;
  write_outputs(table, request, run, paths, outcome, manifest_text, bar);
  bar.clear();
  if (!paths.empty() && !request.quiet) std::cerr << cost(run, writing.seconds());
  print_result(request, outcome);
}

}  // namespace mimetra::cli
