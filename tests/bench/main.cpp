// usage: mimetra_bench OUT [--quick] [--iterations | --steady | --per-region | --large]
// Times kernels and whole commands; writes OUT/bench.json and OUT/growth.png, and a table to
// stdout. With --iterations instead what more iterations of the decomposition give: the picture
// OUT/iterations.png, and a table to stdout; with --steady a table of what smoothness, symmetry and
// exclusive expressions take from flicker, and what they cost; with --per-region one of what
// weights of each region give; with --large one of where the time of decompositions of up to a
// million vertices goes.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "tests/bench/blocking_bench.h"
#include "tests/bench/command_bench.h"
#include "tests/bench/fitting_bench.h"
#include "tests/bench/geodesic_bench.h"
#include "tests/bench/growth.h"
#include "tests/bench/io_bench.h"
#include "tests/bench/iterations_bench.h"
#include "tests/bench/large_bench.h"
#include "tests/bench/numpy_bench.h"
#include "tests/bench/per_region_bench.h"
#include "tests/bench/report.h"
#include "tests/bench/splocs_bench.h"
#include "tests/bench/steady_bench.h"
#include "tests/bench/subjects.h"
#include "tests/bench/transfer_bench.h"
#include "tests/bench/video_bench.h"
#include "toolkit/drawing/picture.h"

namespace mimetra::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 100;
constexpr int kSources = 40;
constexpr int kComponents = 30;

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error(path.string() + ": not written");
}

/// A folder for what commands read and write, gone at the end.
class Scratch {
 public:
  explicit Scratch(fs::path path) : path_(std::move(path)) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

fs::path command_beside() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "mimetra";
}

/// One run of the whole suite.
class Run {
 public:
  Run(fs::path out, bool quick)
      : out_(std::move(out)), scratch_(out_ / "scratch"), mimetra_(command_beside()) {
    results_.settings = {quick, this_machine()};
    results_.at_start = measured_limits(results_.settings.machine, quick);
  }

  /// The machine's own numbers, on real faces where they are, or on the built-in head.
  void measure_faces() {
    const auto small = settings().quick ? std::nullopt : surrey();
    const auto large = settings().quick ? std::nullopt : ict(1000);
    if (!settings().quick && (!small || !large)) {
      results_.notes.emplace_back("no shared data beside the project: the built-in head instead");
    }
    const Subject first = small ? *small : head(0, settings().quick ? 30 : kFrames);
    measure_kernels(first, small.has_value());
    if (large) measure_kernels(first_frames(*large, kFrames), true);
    add(decomposition_row(first.name, first.performance, components(), settings()));
    add(splocs_kernel_rows(first.name, first.performance, components(), settings()));
    compare_with_numpy(first);
    if (!settings().quick) compare_blockings(first, components());
    if (large) measure_long_job(*large);
    const Subject told = large ? first_frames(*large, 300) : first;
    add(fitting_rows(settings()));
    const std::vector<Row> of_video = video_rows(scratch_.path(), settings());
    for (const Row& row : of_video) {
      if (!row.note.empty()) results_.notes.push_back(row.note);
    }
    add(of_video);
    add(io_rows(told, scratch_.path(), settings()));
    add(transfer_command_rows(told, components(), mimetra_, scratch_.path(), settings()));
  }

  /// How times grow on the built-in head; these rows stand in the growth part only.
  void measure_growth() {
    const bool quick = settings().quick;
    std::vector<Row> by_vertices, by_frames, by_count;
    for (const int splits : {0, 1, 2}) {
      const Subject subject = head(splits, quick ? 10 : 40);
      append(by_vertices, geodesic_rows(subject, quick ? 2 : 8, false, settings()));
      append(by_vertices, splocs_rows(subject, quick ? 5 : 10));
      append(by_vertices, transfer_rows(subject));
      append(by_vertices, vertex_rows(subject, settings()));
    }
    for (const int frames : quick ? std::vector{20, 40} : std::vector{50, 100, 200, 400}) {
      const Subject subject = head(0, frames);
      append(by_frames, splocs_rows(subject, quick ? 5 : 10));
      append(by_frames, transfer_rows(subject));
      append(by_frames, vertex_rows(subject, settings()));
    }
    const Subject subject = head(0, quick ? 20 : kFrames);
    for (const int count : quick ? std::vector{5, 10} : std::vector{10, 20, 40, 80}) {
      append(by_count, splocs_rows(subject, count));
      append(by_count, splocs_kernel_rows(subject.name, subject.performance, count, settings()));
    }
    draw_growth({growths(without_sum(by_vertices), "vertices", &Size::vertices),
                 growths(without_setup(by_frames), "frames", &Size::frames),
                 growths(by_count, "K", &Size::count)});
  }

  Results finish() && {
    std::ranges::stable_sort(results_.rows, {}, [order = groups()](const Row& row) {
      return std::ranges::find(order, row.group) - order.begin();
    });
    results_.at_end = measured_limits(settings().machine, settings().quick);
    for (const auto& [own, other] :
         {std::pair(kGeodesicAll, kGeodesicCgal), std::pair(kNumpyPair, kNumpy)}) {
      for (Comparison& found : compared(results_.rows, own, other)) {
        results_.comparisons.push_back(std::move(found));
      }
    }
    return std::move(results_);
  }

 private:
  const Settings& settings() const { return results_.settings; }
  int components() const { return settings().quick ? 10 : kComponents; }

  /// Groups in the order in which they first appear.
  std::vector<std::string> groups() const {
    std::vector<std::string> groups;
    for (const Row& row : results_.rows) {
      if (std::ranges::find(groups, row.group) == groups.end()) groups.push_back(row.group);
    }
    return groups;
  }

  static void append(std::vector<Row>& rows, std::vector<Row> more) {
    for (Row& row : more) rows.push_back(std::move(row));
  }
  void add(std::vector<Row> rows) { append(results_.rows, std::move(rows)); }
  void add(Row row) { results_.rows.push_back(std::move(row)); }

  std::vector<Row> splocs_rows(const Subject& subject, int count) {
    return {decomposition_row(subject.name, subject.performance, count, settings())};
  }
  std::vector<Row> transfer_rows(const Subject& subject) {
    return blendshape_rows(subject, 1, false, settings());
  }

  /// CGAL's own query serves the models of one component.
  void measure_kernels(const Subject& subject, bool with_cgal) {
    add(geodesic_rows(subject, kSources, with_cgal, settings()));
    add(blendshape_rows(subject, 1, true, settings()));
    add(blendshape_rows(subject, 0.2, false, settings()));
    add(vertex_rows(subject, settings()));
  }

  /// A thousand frames: what memory and bandwidth make of the decomposition.
  void measure_long_job(const Subject& subject) {
    constexpr int kManyComponents = 40;
    add(decomposition_row(subject.name, subject.performance, kManyComponents, settings()));
    add(splocs_kernel_rows(subject.name, subject.performance, kManyComponents, settings()));
    compare_blockings(subject, kManyComponents);
    add(decompose_command_row(subject, kManyComponents, mimetra_, scratch_.path(), settings()));
  }

  void compare_with_numpy(const Subject& subject) {
    NumpyComparison comparison = compared_with_numpy(subject.name, subject.performance,
                                                     components(), scratch_.path(), settings());
    add(std::move(comparison.rows));
    results_.notes.push_back(comparison.note);
  }

  void compare_blockings(const Subject& subject, int count) {
    for (Comparison& found : blocking_comparisons(subject, count, settings())) {
      results_.comparisons.push_back(std::move(found));
    }
  }

  /// Set-up and query are shown.
  static std::vector<Row> without_sum(std::vector<Row> rows) {
    std::erase_if(rows, [](const Row& row) { return row.what == kGeodesicAll; });
    return rows;
  }

  /// Set-up sees no frames.
  static std::vector<Row> without_setup(std::vector<Row> rows) {
    std::erase_if(rows, [](const Row& row) {
      return row.what == kBlendshapeSetup || row.what == kVertexSetup;
    });
    return rows;
  }

  void draw_growth(const std::vector<std::vector<Growth>>& parts) {
    std::vector<Chart> charts;
    for (const auto& part : parts) {
      charts.push_back(chart_of(part, "time against " + part.front().against));
      results_.growths.insert(results_.growths.end(), part.begin(), part.end());
    }
    write_text(out_ / "growth.png", png_of(draw(charts, {.width = 640, .height = 720})));
  }

  fs::path out_;
  Scratch scratch_;
  fs::path mimetra_;
  Results results_;
};

void run(const fs::path& out, bool quick) {
  Run suite(out, quick);
  suite.measure_faces();
  suite.measure_growth();
  const Results results = std::move(suite).finish();
  write_text(out / "bench.json", json_of(results));
  std::printf("%s\nwritten: %s, %s\n", table_of(results).c_str(), (out / "bench.json").c_str(),
              (out / "growth.png").c_str());
}

/// Real faces where they are, or the built-in head.
void run_iterations(const fs::path& out, bool quick) {
  std::vector<Subject> subjects;
  if (!quick) {
    constexpr int kTalking = 300;
    for (auto& found : {surrey(), ict(kTalking), bent_facecap()}) {
      if (found) subjects.push_back(*found);
    }
  }
  if (subjects.empty()) subjects.push_back(head(0, quick ? 10 : kFrames));
  std::vector<IterationCurve> curves;
  for (const Subject& subject : subjects) {
    std::ranges::move(iteration_curves(subject, quick), std::back_inserter(curves));
  }
  write_text(out / "iterations.png", png_of(picture_of(curves)));
  std::printf("%s\nwritten: %s\n", table_of(curves).c_str(), (out / "iterations.png").c_str());
}

/// What flickers, and what helps.
void run_steady(const fs::path&, bool quick) {
  constexpr int kTalking = 1000;
  const auto large = quick ? std::nullopt : ict(kTalking);
  const Subject subject = large ? *large : head(0, quick ? 20 : kFrames);
  std::printf("%s\n", table_of(steady_rows(subject, quick)).c_str());
}

/// The same subjects, and two that the weights of a whole face cannot follow: a source whose
/// quarters move by themselves, and a target without what one half of a face does.
void run_per_region(const fs::path&, bool quick) {
  std::vector<Subject> subjects;
  if (!quick) {
    constexpr int kTalking = 300;
    for (auto& found :
         {surrey(), quartered_surrey(), ict(kTalking), bent_facecap(), symmetric_ict(kTalking)}) {
      if (found) subjects.push_back(*found);
    }
  }
  if (subjects.empty()) subjects.push_back(head(0, quick ? 10 : kFrames));
  std::vector<PerRegionRow> rows;
  for (const Subject& subject : subjects) {
    std::ranges::move(per_region_rows(subject, quick), std::back_inserter(rows));
  }
  std::printf("%s", table_of(rows).c_str());
}

void run_large(const fs::path& out, bool quick) {
  const Scratch scratch(out / "scratch");
  std::printf("%s", table_of(large_rows(command_beside(), scratch.path(), quick)).c_str());
}

}  // namespace
}  // namespace mimetra::bench

int main(int argc, char** argv) {
  const std::set<std::string> modes(argv + std::min(argc, 2), argv + argc);
  const bool quick = modes.contains("--quick"), iterations = modes.contains("--iterations");
  const bool steady = modes.contains("--steady"), per_region = modes.contains("--per-region");
  const bool large = modes.contains("--large");
  const int subjects = int{iterations} + int{steady} + int{per_region} + int{large};
  if (argc < 2 || modes.size() != static_cast<std::size_t>(int{quick} + subjects) || subjects > 1) {
    std::fprintf(
        stderr,
        "usage: mimetra_bench OUT [--quick] [--iterations | --steady | --per-region | --large]\n");
    return 2;
  }
  try {
    const auto run = iterations   ? mimetra::bench::run_iterations
                     : steady     ? mimetra::bench::run_steady
                     : per_region ? mimetra::bench::run_per_region
                     : large      ? mimetra::bench::run_large
                                  : mimetra::bench::run;
    run(std::filesystem::absolute(argv[1]), quick);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "mimetra_bench: %s\n", error.what());
    return 1;
  }
}
