#include "toolkit/cli/run_command.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <functional>
#include <iostream>
#include <mutex>
#include <stop_token>
#include <thread>

#include <spdlog/spdlog.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "toolkit/cli/dry_run.h"
#include "toolkit/cli/terminal_text.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/call.h"
#include "toolkit/operations/json.h"
#include "toolkit/operations/memory_use.h"
#include "toolkit/operations/option_words.h"

namespace mimetra::cli {

namespace {

std::atomic<bool> interrupted = false;

/// A line on the terminal with the percentage and, each second, the time since the start, which
/// shows that a long step is at work.
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

  /// Says something in the place of the line.
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
  std::jthread ticker_;  // ends before the others do
};

bool shows_bar(const Request& request) {
  if (request.quiet || request.progress == ProgressBar::never) return false;
  return request.progress == ProgressBar::always || isatty(STDERR_FILENO);
}

/// What the program asks of the operation.
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

/// Computes what the operation shares, in silence; the first process writes.
void help_first(const OperationTable& table, const Request& request, const Context& context) {
  if (!request.operation->shared || request.dry_run) return;
  Call call(table, call_of(request, context, [](double) { return !interrupted; }));
  call.load();
  call.run();
  call.write();
}

/// What a run that wrote something has cost.
std::string cost(const Call& call) {
  const FinishedRun& run = call.finished();
  return "read in " + readable(run.read_seconds) + " s, computed in " + readable(run.run_seconds) +
         " s, written in " + readable(call.write_seconds()) + " s, at most " +
         megabytes(MemoryUse::of_this_process().peak) + " of memory\n";
}

}  // namespace

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
