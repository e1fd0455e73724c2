#include "tests/bench/command_bench.h"

#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "tests/bench/process.h"
#include "tests/bench/splocs_bench.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"

namespace mimetra::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGroup = "whole commands";

int repetitions(const Settings& settings) {
  return settings.quick ? 1 : kRepetitions;
}

fs::path written_source(const Subject& subject, const fs::path& scratch) {
  const fs::path path = scratch / "source.npy";
  write_sequence(subject.performance, path, {.overwrite = true});
  return path;
}

/// What the command reads as the target.
std::string target_text(const Subject& subject, const fs::path& scratch) {
  if (!subject.target_text.empty()) return subject.target_text;
  const BlendshapeModel& target = subject.target;
  const MorphableModel model(target.shared_connectivity(), target.neutral(), {},
                             target.expressions());
  write_model(scratch / "actor", model, {}, {.overwrite = true});
  return scratch / "actor";
}

/// Shares of a run's time, by its manifest; the command writes after the manifest is made.
struct Split {
  double read, regions, solve, other, write;
};

Split split_of(const fs::path& manifest, double seconds) {
  std::ifstream stream(manifest);
  const auto told = nlohmann::json::parse(stream);
  Split split{};
  split.read = told["seconds"]["read"];
  split.regions = told["result"]["regions"]["seconds"];
  for (const auto& target : told["result"]["targets"]) {
    split.solve += target["seconds"].get<double>();
  }
  const double run = told["seconds"]["run"];
  split.other = run - split.regions - split.solve;
  split.write = seconds - split.read - run;
  return split;
}

}  // namespace

std::vector<Row> transfer_command_rows(const Subject& subject, int count, const fs::path& mimetra,
                                       const fs::path& scratch, const Settings& settings) {
  const fs::path source = written_source(subject, scratch);
  const std::string target = target_text(subject, scratch);
  const fs::path out = scratch / "out", regions = scratch / "regions";
  const Size size{subject.name, subject.performance.frames(), subject.performance.vertices(), "K",
                  count};
  Row whole{kGroup, "mimetra transfer, .npy to .ply and .pvd", size, {}};
  std::vector<Row> parts = {{kGroup, "  reads", size, {}},
                            {kGroup, "  finds regions", size, {}},
                            {kGroup, "  solves", size, {}},
                            {kGroup, "  measures errors", size, {}},
                            {kGroup, "  starts, hashes and writes", size, {}}};
  for (int i = 0; i < repetitions(settings); ++i) {
    const ProcessResult run =
        run_or_throw({mimetra, "transfer", source, target, "-k", std::to_string(count),
                      "--tolerance", "0", "--iterations", std::to_string(kIterations), "-o", out,
                      "--regions-out", regions / "roi.pvd", "--force", "--quiet"},
                     scratch);
    whole.seconds.push_back(run.seconds);
    whole.peak_bytes = std::max(whole.peak_bytes, run.peak_bytes);
    const Split split = split_of(out / "mimetra-run.json", run.seconds);
    const double shares[] = {split.read, split.regions, split.solve, split.other, split.write};
    for (std::size_t part = 0; part < parts.size(); ++part) {
      parts[part].seconds.push_back(shares[part]);
    }
  }
  // The decomposition is nearly all of the arithmetic.
  whole.work = decomposition_work(size.frames, size.vertices, count, settings.machine);
  whole.work.bytes +=
      static_cast<double>(fs::file_size(source)) + bytes_below(out) + bytes_below(regions);
  std::vector<Row> rows = {whole};
  rows.insert(rows.end(), parts.begin(), parts.end());
  return rows;
}

Row decompose_command_row(const Subject& subject, int count, const fs::path& mimetra,
                          const fs::path& scratch, const Settings& settings) {
  const fs::path source = written_source(subject, scratch);
  const fs::path out = scratch / "components.h5";
  const Size size{subject.name, subject.performance.frames(), subject.performance.vertices(), "K",
                  count};
  Row row{kGroup, "mimetra decompose, .npy to .h5", size, {}};
  for (int i = 0; i < repetitions(settings); ++i) {
    const ProcessResult run =
        run_or_throw({mimetra, "decompose", source, "-k", std::to_string(count), "--tolerance", "0",
                      "--iterations", std::to_string(kIterations), "-o", out, "--force", "--quiet"},
                     scratch);
    row.seconds.push_back(run.seconds);
    row.peak_bytes = std::max(row.peak_bytes, run.peak_bytes);
  }
  row.work = decomposition_work(size.frames, size.vertices, count, settings.machine);
  row.work.bytes += static_cast<double>(fs::file_size(source) + fs::file_size(out));
  return row;
}

}  // namespace mimetra::bench
