#include <mimetra/cli/run_command.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <set>

#include <spdlog/spdlog.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <mimetra/cli/manifest.h>
#include <mimetra/operations/loading.h>
#include <mimetra/operations/report.h>

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

/// Refuses what exists before anything is computed.
void check_outputs(const OperationTable& table, const Request& request) {
  const std::size_t targets =
      request.inputs.contains("target") ? request.inputs.at("target").size() : 1;
  for (const Output& output : request.operation->outputs) {
    const auto wanted = request.outputs.find(output.name);
    if (wanted == request.outputs.end()) continue;
    table.writer(output.kind, wanted->second);
    const bool one = targets == 1 || output.kind == DataKind::regions;
    if (!request.force && one && std::filesystem::exists(wanted->second)) {
      throw OutputError(wanted->second.string(), "exists already; use --force to replace it");
    }
  }
}

/// Two targets of one name would write to one place.
void check_names(const LoadedInputs& loaded) {
  const auto targets = loaded.data.find("target");
  if (targets == loaded.data.end()) return;
  std::set<std::string> names;
  for (const NamedData& target : targets->second) {
    if (!names.insert(target.name).second) {
      throw UsageError("two targets are named '" + target.name + "'; give them apart");
    }
  }
}

void write_outputs(const OperationTable& table, const Request& request, const Outcome& outcome,
                   const std::string& manifest_text, Bar& bar) {
  for (const Output& output : request.operation->outputs) {
    const auto wanted = request.outputs.find(output.name);
    const auto made = outcome.outputs.find(output.name);
    if (wanted == request.outputs.end() || made == outcome.outputs.end()) continue;
    for (const NamedData& data : made->second) {
      const auto target = output_path(wanted->second, data.name, made->second.size());
      const WriteRequest write{
          target,
          request.parameters,
          request.force,
          [&bar](double share) { return bar.update(share); },
          {{manifest_name(target, table.writes_folder(output.kind, target)), manifest_text}}};
      table.writer(output.kind, target).write(data.data, write);
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

  RunRecord record;
  const Stopwatch reading;
  LoadedInputs loaded = load_inputs(table, *request.operation, request.parameters, request.inputs,
                                    part_of(progress, 0, 0.3), log);
  check_names(loaded);
  record.inputs = std::move(loaded.files);
  record.read_seconds = reading.seconds();

  Invocation invocation;
  invocation.inputs = std::move(loaded.data);
  invocation.parameters = request.parameters;
  invocation.wanted = request.outputs;
  invocation.progress = part_of(progress, 0.3, 0.8);
  invocation.log = log;
  const Stopwatch running;
  const Outcome outcome = request.operation->run(invocation);
  record.run_seconds = running.seconds();
  record.report = outcome.report;
  const std::string manifest_text =
      request.outputs.empty() ? std::string() : manifest(request, record);
  write_outputs(table, request, outcome, manifest_text, bar);
  bar.clear();
  print_result(request, outcome);
}

}  // namespace mimetra::cli
