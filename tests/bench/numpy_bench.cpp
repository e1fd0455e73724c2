#include "tests/bench/numpy_bench.h"

#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "tests/bench/process.h"
#include "tests/bench/splocs_bench.h"
#include "tests/test_folders.h"
#include "toolkit/io/array_file.h"

namespace mimetra::bench {
namespace {

constexpr const char* kGroup = "beside NumPy";
constexpr double kAgreement = 1e-6;

/// The first Python that has NumPy.
std::optional<std::string> python(const std::filesystem::path& scratch) {
  for (const char* candidate : {"/usr/bin/python3", "python3"}) {
    if (run_process({candidate, "-c", "import numpy"}, scratch).code == 0) return candidate;
  }
  return {};
}

/// Writes the distances from every vertex that our decomposition asked for, and those vertices.
void write_distances(const std::set<VertexIndex>& sources, const DistanceFunction& distances,
                     int vertices, const std::filesystem::path& scratch) {
  // Frames of points are the only arrays that are written: distances take the place of x.
  const auto count = static_cast<Eigen::Index>(sources.size());
  Frames table = Frames::Zero(count, 3 * vertices), ids = Frames::Zero(count, 3);
  Eigen::Index row = 0;
  for (const VertexIndex source : sources) {
    const Eigen::MatrixXd values = distances({&source, 1});
    for (int v = 0; v < vertices; ++v) table(row, 3 * v) = values(v, 0);
    ids(row++, 0) = source;
  }
  write_npy_frames(scratch / "distances.npy", table);
  write_npy_frames(scratch / "sources.npy", ids);
}

std::string with_digits(double value) {
  return nlohmann::json(value).dump();
}

}  // namespace

NumpyComparison compared_with_numpy(const std::string& name, const MeshSequence& sequence,
                                    int count, const std::filesystem::path& scratch,
                                    const Settings& settings) {
  const std::optional<std::string> interpreter = python(scratch);
  if (!interpreter) return {{}, "NumPy: skipped, neither /usr/bin/python3 nor python3 has it"};

  DecompositionOptions options = prepared_options(sequence, count);
  options.sign_rule = SignRule::literal;
  std::set<VertexIndex> sources;
  DecompositionOptions recording = options;
  recording.distances = [&sources,
                         distances = options.distances](std::span<const VertexIndex> asked) {
    sources.insert(asked.begin(), asked.end());
    return distances(asked);
  };
  const Components components = decompose(sequence, recording, Context().with_threads(1));
  write_distances(sources, options.distances, sequence.vertices(), scratch);
  write_npy_frames(scratch / "frames.npy", sequence.positions());
  const Positions& rest = sequence.rest();
  write_npy_frames(scratch / "rest.npy", Eigen::Map<const Frames>(rest.data(), 1, rest.size()));

  const Size size{name, sequence.frames(), sequence.vertices(), "K", count};
  const Work work =
      decomposition_work(sequence.frames(), sequence.vertices(), count, settings.machine);
  NumpyComparison result;
  result.rows = measured(
      {{{kGroup, kNumpyPair, size, work}, [&] { decompose(sequence, options); }}}, settings.quick);
  const ProcessResult run = run_or_throw(
      {*interpreter, (test::source_folder() / "tests/bench/splocs_numpy.py").string(),
       scratch.string(), std::to_string(count), with_digits(components.d_min),
       with_digits(components.d_max), std::to_string(settings.quick ? 1 : kRepetitions)},
      scratch);
  const auto told = nlohmann::json::parse(run.output);
  const double energy = told["energy"];
  if (std::abs(energy - components.energies.back()) > kAgreement * components.energies.back()) {
    throw std::runtime_error("NumPy ends with the energy " + with_digits(energy) +
                             ", mimetra with " + with_digits(components.energies.back()));
  }
  Row row{kGroup, kNumpy, size, work};
  row.seconds = told["seconds"].get<std::vector<double>>();
  result.rows.push_back(row);
  result.note = "NumPy " + told["numpy"].get<std::string>() + " by " + *interpreter +
                " with the BLAS " + told["blas"].get<std::string>() +
                "; both end with the energy " + with_digits(energy);
  return result;
}

}  // namespace mimetra::bench
