#include "toolkit/cli/run_command.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <mutex>
#include <sstream>
#include <stop_token>
#include <thread>

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "toolkit/cli/exit_code.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/call.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/this_process.h"

namespace mimetra::cli {

namespace {

/// Size of a value, such as "300 frames of 6706 vertices".
std::string size_of(const NamedData& value) {
  const Data& data = value.data;
  if (const auto* sequence = std::get_if<FieldSequence>(&data)) {
    return counted(sequence->frames->frames(), "frame") + " of " +
           counted(sequence->frames->vertices(), "vertex", "vertices");
  }
  if (const auto* held = std::get_if<ModelData>(&data)) {
    const MorphableModel& model = held->model;
    std::string size = counted(model.vertices(), "vertex", "vertices") + ", ";
    if (model.identities().size() > 0) {
      size += counted(model.identities().size(), "identity", "identities") + ", ";
    }
    return size + counted(model.expressions().size(), "expression");
  }
  if (const auto* components = std::get_if<Components>(&data)) {
    return counted(components->count(), "component");
  }
  if (const auto* regions = std::get_if<RegionData>(&data)) {
    return counted(std::ssize(regions->regions.regions), "region");
  }
  if (const auto* track = std::get_if<LandmarkTrack>(&data)) {
    return counted(track->frames(), "frame") + " of " + counted(track->landmarks(), "landmark");
  }
  if (value.origin.run) return "a run of " + value.origin.run->record.operation;
  return "";
}

/// True for a sequence whose frames are all in memory.
bool is_in_memory(const Data& data) {
  const auto* sequence = std::get_if<FieldSequence>(&data);
  return sequence && sequence->is_in_memory();
}

/// Outcome of --dry-run: what a run would do after reading its inputs.
Outcome planned(const Operation& operation, const Invocation& invocation) {
  const double computing = operation.memory ? operation.memory(invocation) : 0;
  Json inputs = Json::array(), outputs = Json::array();
  std::ostringstream text;
  text << operation.name << '\n';
  for (const Input& input : operation.inputs) {
    const auto given = invocation.inputs.find(input.name);
    if (given == invocation.inputs.end()) continue;
    for (const NamedData& value : given->second) {
      const bool in_memory = is_in_memory(value.data);
      inputs.push_back({{"input", input.name},
                        {"name", value.name},
                        {"size", size_of(value)},
                        {"in_memory", in_memory}});
      text << "  reads   " << value.name << ": " << size_of(value)
           << (in_memory ? ", all in memory" : "") << '\n';
    }
  }
  for (const auto& [name, paths] : invocation.wanted) {
    for (const auto& path : paths) {
      outputs.push_back({{"output", name}, {"path", path.string()}});
      text << "  writes  " << path.string() << '\n';
    }
  }
  const MemoryUse use = MemoryUse::of_this_process();
  const double peak = std::max(use.peak, use.now + computing);
  const int processes = invocation.context.ranks().count();
  text << "  memory  " << megabytes(peak)
       << (processes > 1 ? " in each of " + std::to_string(processes) + " processes" : "")
       << ", of which " << megabytes(use.now) << " hold program and inputs\n";
  const double scratch = operation.scratch ? operation.scratch(invocation) : 0;
  if (scratch > 0) {
    text << "  scratch " << megabytes(scratch) << " in "
         << std::filesystem::temp_directory_path().string()
         << " (set TMPDIR for another folder), while it runs\n";
  }
  return {{},
          json_text(Json{{"operation", operation.name},
                         {"inputs", inputs},
                         {"outputs", outputs},
                         {"processes", processes},
                         {"memory_bytes", peak},
                         {"scratch_bytes", scratch}}),
          text.str()};
}

std::atomic<bool> interrupted = false;

/// A progress line on the terminal with the percentage. The time since the start, updated each
/// second, shows that a long step is still active.
class Bar {
 public:
  Bar(std::string title, bool shown) : title_(std::move(title)), shown_(shown) {
    if (shown) ticker_ = std::jthread([this](const std::stop_token& stop) { tick(stop); });
  }
  ~Bar() { end(); }
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;

  bool update(double share) {
    const int percent = static_cast<int>(std::floor(100 * share));
    if (percent != percent_.exchange(percent)) draw();
    return !interrupted;
  }

  /// Prints something in place of the line.
  void say(const std::function<void()>& text) {
    const std::scoped_lock lock(mutex_);
    clear();
    text();
  }

  void end() {
    const std::scoped_lock lock(mutex_);
    shown_ = false;
    clear();
  }

 private:
  /// \pre the mutex is held
  void clear() {
    if (is_drawn_) std::fprintf(stderr, "\r\033[K");
    is_drawn_ = false;
  }

  void draw() {
    const std::scoped_lock lock(mutex_);
    if (!shown_) return;
    std::fprintf(stderr, "\r%s %3d %%", title_.c_str(), std::max(0, percent_.load()));
    if (const double seconds = stopwatch_.seconds(); seconds >= 1) {
      std::fprintf(stderr, " %.0f s", std::floor(seconds));
    }
    std::fflush(stderr);
    is_drawn_ = true;
  }

  void tick(const std::stop_token& stop) {
    std::mutex unused;
    std::unique_lock lock(unused);
    std::condition_variable_any second;
    while (!second.wait_for(lock, stop, std::chrono::seconds(1), [] { return false; }) &&
           !stop.stop_requested()) {
      draw();
    }
  }

  std::string title_;
  Stopwatch stopwatch_;
  std::atomic<int> percent_ = -1;
  std::mutex mutex_;
  bool shown_;
  bool is_drawn_ = false;
  std::jthread ticker_;  // destroyed first, so the thread ends before the other members
};

bool shows_bar(const Request& request) {
  if (request.quiet || request.progress == ProgressBar::never) return false;
  return request.progress == ProgressBar::always || isatty(STDERR_FILENO);
}

/// Converts the command line to a request for the operation.
CallRequest call_of(const Request& request, const Context& context, Progress progress) {
  CallRequest call;
  call.operation = request.operation;
  call.parameters = request.parameters;
  call.named = request.inputs;
  for (const auto& [output, path] : request.outputs) {
    call.destinations[output] = {path, request.force};
  }
  call.may_stream = true;
  call.context = context.with_threads(request.threads).with_progress(std::move(progress));
  call.arguments = request.arguments;
  call.files.assign(request.files.begin(), request.files.end());
  return call;
}

void print_result(const Request& request, const Outcome& outcome,
                  const std::vector<std::string>& warnings, bool has_outputs) {
  if (request.json) {
    Json report = Json::parse(outcome.report);
    if (!warnings.empty() && !report.contains("warnings")) report["warnings"] = warnings;
    std::cout << json_text(report, 2) << '\n';
  } else if (!request.quiet) {
    std::cout << terminal_text(outcome.summary);
  }
  if (std::cout.flush()) return;
  throw OutputError("standard output", std::string("cannot be written") +
                                           (has_outputs ? "; the outputs are in place" : ""));
}

/// Computes this process's part of a shared operation, without output; rank 0 writes.
void help_first(const OperationTable& table, const Request& request, const Context& context) {
  if (!request.operation->shared || request.dry_run) return;
  Call call(table, call_of(request, context, [](double) { return !interrupted; }));
  call.load();
  call.run();
  call.write();
}

/// Time and memory of a run that wrote files.
std::string cost(const Call& call) {
  const FinishedRun& run = call.finished();
  return "read in " + readable(run.read_seconds) + " s, computed in " + readable(run.run_seconds) +
         " s, written in " + readable(call.write_seconds()) + " s, at most " +
         megabytes(MemoryUse::of_this_process().peak) + " of memory\n";
}

}  // namespace

std::string megabytes(double bytes) {
  return std::to_string(std::lround(bytes / 1e6)) + " MB";
}

void interrupt() {
  interrupted = true;
}

void run_command(const OperationTable& table, const Request& request, const Context& context) {
  if (context.ranks().rank() > 0) return help_first(table, request, context);
  Bar bar("mimetra " + request.operation->name, shows_bar(request));
  CallRequest asked = call_of(request, context, [&bar](double share) { return bar.update(share); });
  std::vector<std::string> warnings;
  asked.log = [&bar, &warnings](LogLevel level, const std::string& text) {
    const std::string message = with_options_spelled(text, spelled_for_command);
    const bool is_warning = level == LogLevel::warning;
    if (is_warning) warnings.push_back(message);
    bar.say([&] {
      is_warning ? spdlog::warn(terminal_text(message)) : spdlog::info(terminal_text(message));
    });
  };
  Call call(table, std::move(asked));
  call.load();
  if (request.dry_run) {
    call.foresee();
    bar.end();
    print_result(request, planned(*request.operation, call.invocation()), warnings, false);
    return;
  }
  call.run();
  call.write();
  bar.end();
  if (call.writes() && !request.quiet) std::cerr << cost(call);
  print_result(request, call.outcome(), warnings, call.writes());
}

}  // namespace mimetra::cli
