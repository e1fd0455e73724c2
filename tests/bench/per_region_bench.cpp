#include "tests/bench/per_region_bench.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <random>

#include "toolkit/mesh/measures.h"
#include "toolkit/pipeline/transfer.h"

namespace mimetra::bench {
namespace {

constexpr int kHalves = 2;
constexpr int kMostFrames = 60;

MeshSequence evenly(const MeshSequence& sequence) {
  if (sequence.frames() <= kMostFrames) return sequence;
  std::vector<int> chosen;
  for (int i = 0; i < kMostFrames; ++i) chosen.push_back(i * sequence.frames() / kMostFrames);
  return MeshSequence(*selected(std::make_shared<const MeshSequence>(sequence), chosen));
}

Subject thinned(Subject subject) {
  subject.performance = evenly(subject.performance);
  if (subject.truth) subject.truth = evenly(*subject.truth);
  return subject;
}

/// A solution of weights, and what it misses.
struct Measured {
  Solution solution;
  TransferError error;
};

/// One subject's source where its target is, and its regions.
class PerRegionComparison {
 public:
  PerRegionComparison(const Subject& subject, int count)
      : subject_(subject),
        target_{subject.name, subject.target},
        source_(prepare_source(subject.performance)),
        placed_(placed_at(target_, source_)),
        selection_(selection_of(choose_regions(analyse(source_, {.count = count})))) {}

  int regions() const { return static_cast<int>(selection_.regions.size()); }

  Measured of_all(const SolveOptions& options) const {
    Solution solution = solve(placed_.source, target_, selection(options), options);
    TransferError error = error_of(*solution.sequence);
    return {std::move(solution), std::move(error)};
  }

  /// The errors of triangles where they were held out (M).
  Eigen::VectorXd held_out(const SolveOptions& options, const RegionShares* shares) const {
    std::vector<int> order = all_triangles(subject_.target.triangles());
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    Eigen::VectorXd errors(static_cast<Eigen::Index>(order.size()));
    for (int half = 0; half < kHalves; ++half) {
      std::vector<int> seen, held;
      for (std::size_t i = 0; i < order.size(); ++i) {
        (static_cast<int>(i) % kHalves == half ? held : seen).push_back(order[i]);
      }
      std::ranges::sort(seen);
      const TransferError error = error_of(*solved_on(seen, options, shares));
      errors(held) = error.per_triangle(held);
    }
    return errors;
  }

  std::optional<PerRegionRow::Distance> distance_from_truth(const FrameSource& result) const {
    if (!subject_.truth) return {};
    const Frames& truth = subject_.truth->positions();
    const Frames frames = result.read(0, result.frames());
    PerRegionRow::Distance distance;
    const Eigen::Index vertices = frames.cols() / 3;
    for (Eigen::Index f = 0; f < frames.rows(); ++f) {
      for (Eigen::Index v = 0; v < vertices; ++v) {
        const double d = (frames.row(f).segment<3>(3 * v) - truth.row(f).segment<3>(3 * v)).norm();
        distance.mean += d;
        distance.largest = std::max(distance.largest, d);
      }
    }
    const double percent = 100 / diameter(subject_.target.neutral());
    distance.mean *= percent / static_cast<double>(frames.rows() * vertices);
    distance.largest *= percent;
    return distance;
  }

 private:
  Selection selection(const SolveOptions& options) const {
    return options.per_region ? selection_ : whole(target_);
  }

  TransferError error_of(const FrameSource& result) const {
    return transfer_error(*placed_.source.sequence, result,
                          all_triangles(subject_.target.triangles()));
  }

  /// The weights that some triangles give; of the whole face without shares.
  std::shared_ptr<const FrameSource> solved_on(const std::vector<int>& triangles,
                                               const SolveOptions& options,
                                               const RegionShares* shares) const {
    const FrameSource& performance = *placed_.source.sequence;
    const auto model = std::make_shared<const BlendshapeModel>(subject_.target);
    const Eigen::MatrixXd global =
        BlendshapeTransfer(performance.rest(), *model, triangles).weights(performance);
    if (!shares) return std::make_shared<const Animation>(model, global);
    const LocalWeights local(performance.rest(), *model, *shares, triangles,
                             {.ridge = options.region_ridge});
    return std::make_shared<const RegionalAnimation>(model, *shares,
                                                     local.weights(performance, global).beta);
  }

  const Subject& subject_;
  Target target_;
  Source source_;
  PlacedSource placed_;
  Selection selection_;
};

std::string per_region_cell(double value, const char* format) {
  char text[48];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// By how many percent less.
double fall(double before, double after) {
  return 100 * (before - after) / before;
}

}  // namespace

std::vector<PerRegionRow> per_region_rows(const Subject& given, bool quick) {
  const Subject subject = thinned(given);
  std::vector<PerRegionRow> rows;
  for (const int count : quick ? std::vector{3} : std::vector{10, 30}) {
    const PerRegionComparison comparison(subject, count);
    const Measured whole = comparison.of_all({});
    const double held_out_whole = comparison.held_out({}, nullptr).mean();
    for (const double falloff : quick ? std::vector{0.1} : std::vector{0.1, 0.25}) {
      const bool first = count == 10 && falloff == 0.1;
      for (const double ridge : first ? std::vector{0.01, 0.1, 1.0, 10.0} : std::vector{1.0}) {
        SolveOptions options;
        options.per_region = true;
        options.falloff = Length::share(falloff);
        options.region_ridge = ridge;
        const Measured regions = comparison.of_all(options);
        PerRegionRow row{subject.name, comparison.regions(), falloff, ridge};
        row.de_whole = whole.error.de_all;
        row.de_regions = regions.error.de_all;
        row.held_out_whole = held_out_whole;
        row.held_out_regions =
            comparison.held_out(options, &regions.solution.regional->shares()).mean();
        row.true_whole = comparison.distance_from_truth(*whole.solution.sequence);
        row.true_regions = comparison.distance_from_truth(*regions.solution.sequence);
        row.seconds_whole = whole.solution.seconds;
        row.seconds_regions = regions.solution.seconds;
        row.violation = regions.solution.violation;
        rows.push_back(std::move(row));
        std::fprintf(stderr, "%s", table_of({rows.back()}).c_str());
      }
    }
  }
  return rows;
}

std::string table_of(const std::vector<PerRegionRow>& rows) {
  std::string text =
      "| | regions | falloff | ridge | DE, whole face | DE falls by % | held out: by % | true "
      "error: "
      "whole face | per region | s, whole face | per region | KKT |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  const auto distance = [](const std::optional<PerRegionRow::Distance>& found) {
    return found ? per_region_cell(found->mean, "%.4f, ") + per_region_cell(found->largest, "%.2f")
                 : std::string("-");
  };
  for (const PerRegionRow& row : rows) {
    text += "| " + row.subject + " | " + std::to_string(row.regions) + " | " +
            per_region_cell(row.falloff, "%.2f | ") + per_region_cell(row.ridge, "%g | ") +
            per_region_cell(row.de_whole, "%.4g | ") +
            per_region_cell(fall(row.de_whole, row.de_regions), "%.1f | ") +
            per_region_cell(fall(row.held_out_whole, row.held_out_regions), "%.1f | ") +
            distance(row.true_whole) + " | " + distance(row.true_regions) + " | " +
            per_region_cell(row.seconds_whole, "%.2f | ") +
            per_region_cell(row.seconds_regions, "%.2f | ") +
            per_region_cell(row.violation, "%.0e |\n");
  }
  return text;
}

}  // namespace mimetra::bench
