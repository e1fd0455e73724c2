#include "tests/bench/steady_bench.h"

#include <cmath>
#include <cstdio>
#include <random>

#include "toolkit/model/smooth_weights.h"
#include "toolkit/model/smoothness.h"
#include "toolkit/pipeline/solve.h"
#include "toolkit/transfer/transfer_error.h"

namespace mimetra::bench {
namespace {

constexpr double kNoise = 0.005;

double box_of(const Positions& positions) {
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).norm();
}

MeshSequence with_noise(const MeshSequence& clip) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal(0, kNoise * box_of(clip.rest()) / std::sqrt(3.0));
  Frames frames = clip.positions();
  for (double& coordinate : frames.reshaped<Eigen::RowMajor>()) coordinate += normal(generator);
  return {clip.shared_connectivity(), std::move(frames), clip.times(), clip.rest()};
}

double flicker_of(const FrameSource& sequence) {
  const Frames poses = sequence.read(0, sequence.frames());
  const Eigen::Index count = poses.rows() - 2;
  double sum = 0;
  for (Eigen::Index f = 0; f < count; ++f) {
    sum += (poses.row(f) - 2 * poses.row(f + 1) + poses.row(f + 2)).squaredNorm();
  }
  return 100 * std::sqrt(sum / static_cast<double>(count * sequence.vertices())) /
         box_of(sequence.rest());
}

/// Of weights that were smoothed together.
double violation_of(const Source& source, const BlendshapeModel& target, const Solution& solution,
                    double smoothness) {
  const FrameSource& frames = *source.sequence;
  const BlendshapeTransfer transfer(frames.rest(), target, all_triangles(target.triangles()));
  Eigen::MatrixXd h(frames.frames(), target.expressions().size());
  for (int f = 0; f < frames.frames(); ++f) {
    const FrameBlock block(frames, f, 1);
    h.row(f) = transfer.right_hand_side(block.frame(0)).transpose();
  }
  const double mu =
      smoothness_penalty(smoothness, frames.times(), transfer.gram().diagonal().mean());
  return smooth_optimality_violation({transfer.gram()}, h, frames.times(), mu, solution.weights());
}

class Study {
 public:
  explicit Study(const Subject& subject)
      : subject_(subject),
        target_{subject.name, subject.target},
        clean_(placed(subject.performance)),
        noisy_(placed(with_noise(subject.performance))) {}

  std::vector<SteadyRow> both(const SolveOptions& options, const std::string& words) const {
    return {row(clean_, false, options, words), row(noisy_, true, options, words)};
  }

 private:
  Source placed(const MeshSequence& clip) const {
    return placed_at(target_, prepare_source(clip, {.head_motion = HeadMotion::none}), {}).source;
  }

  SteadyRow row(const Source& source, bool noisy, const SolveOptions& options,
                const std::string& words) const {
    const Selection all = whole(target_);
    const Solution solution = solve(source, target_, all, options);
    const bool has_vertices = options.space == Space::vertex;
    SteadyRow row{has_vertices ? "vertices" : "weights", words, noisy,
                  flicker_of(*solution.sequence)};
    row.de = transfer_error(*clean_.sequence, *solution.sequence, all.triangles).de_all;
    row.seconds = solution.seconds;
    if (!has_vertices && options.smoothness > 0) {
      row.violation = violation_of(source, subject_.target, solution, options.smoothness);
    }
    return row;
  }

  const Subject& subject_;
  Target target_;
  Source clean_, noisy_;
};

}  // namespace

std::vector<SteadyRow> steady_rows(const Subject& subject, bool quick) {
  const Study study(subject);
  std::vector<SteadyRow> rows;
  const auto add = [&](const SolveOptions& options, const std::string& words) {
    for (SteadyRow& row : study.both(options, words)) rows.push_back(std::move(row));
  };
  const std::vector<double> seconds =
      quick ? std::vector{0.0, 0.05} : std::vector{0.0, 0.017, 0.033, 0.05, 0.1, 0.5, 1.0};
  for (const Space space : {Space::blendshape, Space::vertex}) {
    for (const double smoothness : seconds) {
      char words[32];
      std::snprintf(words, sizeof words, "--smoothness %g", smoothness);
      add({.space = space, .smoothness = smoothness}, smoothness > 0 ? words : "");
    }
  }
  const auto has_groups =
      !known_exclusives(subject.target.expressions().names, Exclusive::eyes).empty();
  if (!has_groups) return rows;
  for (const double symmetry : {0.1, 1.0, 10.0}) {
    char words[32];
    std::snprintf(words, sizeof words, "--symmetry %g", symmetry);
    add({.space = Space::blendshape, .symmetry = symmetry}, words);
  }
  for (const Exclusive exclusive : {Exclusive::eyes, Exclusive::all}) {
    add({.space = Space::blendshape, .exclusive = exclusive},
        "--exclusive " + std::string(choice_name(exclusive)));
  }
  return rows;
}

std::string table_of(const std::vector<SteadyRow>& rows) {
  std::string text =
      "| space | options | source | flicker % | DE | seconds | KKT |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n";
  for (const SteadyRow& row : rows) {
    char line[200];
    std::snprintf(line, sizeof line, "| %s | %s | %s | %.4f | %.4g | %.2f | ", row.space.c_str(),
                  row.options.c_str(), row.noisy ? "noisy" : "clean", row.flicker, row.de,
                  row.seconds);
    text += line;
    if (row.violation) {
      std::snprintf(line, sizeof line, "%.1e", *row.violation);
      text += line;
    }
    text += " |\n";
  }
  return text;
}

}  // namespace mimetra::bench
