#include "tests/bench/suite.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <stdexcept>

#include <benchmark/benchmark.h>

namespace mimetra::bench {
namespace {

/// Seconds of every repetition, by the name of the benchmark.
class Collector : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      seconds_[run.run_name.function_name].push_back(
          run.GetAdjustedRealTime() / benchmark::GetTimeUnitMultiplier(run.time_unit));
    }
  }

  const std::vector<double>& seconds(const std::string& name) { return seconds_[name]; }

 private:
  std::map<std::string, std::vector<double>> seconds_;
};

std::string name_of(const Row& row) {
  return row.what + ", " + row.size.text();
}

}  // namespace

std::string Size::text() const {
  std::string text = subject;
  if (frames > 0) text += " " + std::to_string(frames) + " x";
  if (vertices > 0) text += " " + std::to_string(vertices);
  if (count > 0) text += ", " + count_name + " " + std::to_string(count);
  return text;
}

double bytes_below(const std::filesystem::path& folder) {
  double bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) bytes += static_cast<double>(entry.file_size());
  }
  return bytes;
}

double Row::median() const {
  if (seconds.empty()) throw std::runtime_error(name_of(*this) + ": was not measured");
  std::vector<double> sorted = seconds;
  std::ranges::sort(sorted);
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

std::vector<Row> measured(const std::vector<Case>& cases, bool quick) {
  std::vector<Row> rows;
  for (const Case& one : cases) {
    if (!quick) one.run();  // caches and memory as in the second frame of a long job
    const std::string name = name_of(one.row);
    benchmark::RegisterBenchmark(name.c_str(),
                                 [&one](benchmark::State& state) {
                                   for ([[maybe_unused]] const auto _ : state) one.run();
                                 })
        ->UseRealTime()
        ->Repetitions(quick ? 1 : kRepetitions)
        ->MinTime(quick ? 0.01 : 0.1);
    Collector collector;
    benchmark::RunSpecifiedBenchmarks(&collector);
    benchmark::ClearRegisteredBenchmarks();
    rows.push_back(one.row);
    rows.back().seconds = collector.seconds(name);
    std::fprintf(stderr, "  %-70s %10.3f ms\n", name.c_str(), 1e3 * rows.back().median());
  }
  return rows;
}

}  // namespace mimetra::bench
