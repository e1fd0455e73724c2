#include "tests/bench/large_bench.h"

#include <chrono>
#include <cstdio>
#include <span>

#include <nlohmann/json.hpp>

#include "tests/bench/process.h"
#include "tests/bench/subjects.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/splocs/decomposition.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra::bench {
namespace {

namespace fs = std::filesystem;

/// Progress of which decompose() tells as its first iteration begins, of 30.
constexpr double kShareOfStart = 5.0 / 35;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Runs a decomposition and measures its parts by when it asks for distances and tells of its
/// progress: of an iteration as it begins.
void measure_parts(const FrameSource& sequence, LargeRow& row) {
  const double before_setup = now();
  const SurfaceDistances distances(sequence.rest(), sequence.triangles(),
                                   Weld::exact(sequence.rest()));
  row.setup = now() - before_setup;
  double queries_of_start = 0, first_iteration = 0;
  DecompositionOptions options;
  options.count = row.count;
  options.tolerance = 0;
  options.distances = [&](std::span<const VertexIndex> sources) {
    const double before = now();
    Eigen::MatrixXd found = distances(sources);
    row.queries += now() - before;
    return found;
  };
  const auto note_start = [&](double share) {
    if (first_iteration == 0 && share >= kShareOfStart) {
      first_iteration = now();
      queries_of_start = row.queries;
    }
    return true;
  };
  const double begin = now();
  decompose(sequence, options, Context().with_progress(note_start));
  const double end = now();
  row.start = first_iteration - begin - queries_of_start;
  row.iterations = end - first_iteration - (row.queries - queries_of_start);
  row.sources = distances.computed();
}

void measure_command(const fs::path& mimetra, const fs::path& take, const fs::path& scratch,
                     LargeRow& row) {
  const std::vector<std::string> command = {mimetra,
                                            "decompose",
                                            take,
                                            "-k",
                                            std::to_string(row.count),
                                            "--tolerance",
                                            "0",
                                            "-o",
                                            scratch / "components.h5",
                                            "--force"};
  std::vector<std::string> dry = command;
  dry.insert(dry.end(), {"--dry-run", "--json"});
  row.predicted_bytes = nlohmann::json::parse(run_or_throw(dry, scratch).output)["memory_bytes"];
  const ProcessResult run = run_or_throw(command, scratch);
  row.command = run.seconds;
  row.peak_bytes = run.peak_bytes;
}

}  // namespace

std::vector<LargeRow> large_rows(const fs::path& mimetra, const fs::path& scratch, bool quick) {
  std::vector<LargeRow> rows;
  for (const int splits : quick ? std::vector{0} : std::vector{0, 2, 3, 4}) {
    const fs::path take = scratch / "large.npy";
    LargeRow row{.frames = quick ? 20 : 200, .count = quick ? 5 : 40};
    {
      const Subject subject = head(splits, row.frames);
      row.vertices = subject.performance.vertices();
      write_sequence(subject.performance, take, {.overwrite = true});
    }
    measure_command(mimetra, take, scratch, row);
    measure_parts(*open_sequence(take).frames, row);
    std::fprintf(stderr, "%s", table_of({row}).c_str());
    rows.push_back(row);
  }
  return rows;
}

std::string table_of(const std::vector<LargeRow>& rows) {
  std::string text =
      "| vertices | set-up of distances | distances | start | 30 iterations | command | predicted "
      "MB | "
      "largest MB |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const LargeRow& row : rows) {
    char line[200];
    std::snprintf(line, sizeof line,
                  "| %d | %.3g | %.3g (%d) | %.3g | %.3g | %.3g | %.0f | %.0f |\n", row.vertices,
                  row.setup, row.queries, row.sources, row.start, row.iterations, row.command,
                  row.predicted_bytes / 1e6, row.peak_bytes / 1e6);
    text += line;
  }
  return text;
}

}  // namespace mimetra::bench
