#include "toolkit/pipeline/evaluation.h"

#include "toolkit/mesh/stopwatch.h"
#include "toolkit/pipeline/joint_motion.h"
#include "toolkit/pipeline/region_completer.h"

namespace mimetra {

namespace {

/// Mean over frames and the selected triangles of the squared error.
double mean_over(const Eigen::VectorXd& per_triangle, const std::vector<int>& selected) {
  double sum = 0;
  for (const int triangle : selected) sum += per_triangle[triangle];
  return sum / static_cast<double>(selected.size());
}

/// MPE; none where the full transfer of a mesh of this size is exact up to rounding.
std::optional<double> percentage_error(double full, double k, double size) {
  constexpr double kRounding = 1e-12;
  if (full <= kRounding * size * kRounding * size) return {};
  return mean_percentage_error(full, k);
}

EvaluatedTransfer solved(const Source& source, const Target& target, const Selection& selection,
                         const SolveOptions& options) {
  const PlacedSource placed = placed_at(target, source, options);
  EvaluatedTransfer result{{}, solve(placed.source, target, selection, options), {}};
  result.error = transfer_error(
      *placed.source.sequence, *result.solution.sequence, selection.triangles,
      {.edges = options.edges, .pairing = target.pairing, .threads = options.threads});
  result.row.de_all = result.error.de_all;
  result.row.de_region = result.error.de_region;
  result.row.transfer_seconds = result.solution.seconds;
  return result;
}

/// The work of one decomposition in a row; the rest is its transfer.
constexpr double kAnalysisShare = 0.9;

/// Of all regions of the source; none where they differ.
std::optional<double> common_radius(const Regions& regions) {
  std::optional<double> radius;
  for (const Region& region : regions.regions) {
    if (!region.added_for.empty()) continue;
    if (radius && *radius != region.radius) return {};
    radius = region.radius;
  }
  return radius;
}

}  // namespace

EvaluatedTransfer evaluate_full(const Source& source, const Target& target,
                                const SolveOptions& options) {
  EvaluatedTransfer result = solved(source, target, whole(target), options);
  result.row.vertices = source.sequence->vertices();
  result.row.triangles = static_cast<int>(source.sequence->triangles().rows());
  result.row.de_region = result.row.de_all;
  return result;
}

EvaluatedTransfer evaluate_by(const Regions& regions, const EvaluatedTransfer& full,
                              const Source& source, const Target& target,
                              const SolveOptions& options) {
  const Selection selection = selection_of(regions, target);
  EvaluatedTransfer result = solved(source, target, selection, options);
  EvaluationRow& row = result.row;
  row.vertices = regions.vertex_count();
  row.triangles = static_cast<int>(regions.triangles.size());
  row.vertex_share = regions.vertex_share();
  row.triangle_share = regions.triangle_share();
  row.radius = common_radius(regions);
  const double size = result.solution.sequence->diameter();
  row.mpe_all = percentage_error(full.error.de_all, row.de_all, size);
  row.mpe_region = percentage_error(
      mean_over(full.error.per_triangle, with_partners(selection.triangles, target.pairing.get())),
      row.de_region, size);
  return result;
}

std::vector<EvaluationRow> evaluate(const MeshSequence& sequence, const Target& given,
                                    const EvaluationOptions& options) {
  check_options(options);
  SourceOptions of_source = options.source;
  of_source.notes = options.notes;
  of_source.threads = options.threads;
  AnalysisOptions of_analysis = options.analysis;
  of_analysis.threads = options.threads;
  of_analysis.notes = options.notes;
  RegionChoiceOptions of_regions = options.regions;
  of_regions.notes = options.notes;
  SolveOptions of_solving = options.solving;
  of_solving.threads = options.threads;
  of_solving.notes = options.notes;
  of_solving.edges = edge_sum(options.analysis.compatibility);
  of_solving.distances = options.analysis.distances;

  const MatchedTarget matched(sequence, given,
                              {.source_rest = asked_rest(sequence, options.source),
                               .threads = options.threads,
                               .notes = options.notes});
  const Target& target = *matched;
  of_source.joint = joint_search({target}, of_solving);
  const Source source = prepare_source(sequence, of_source);
  const double steps = static_cast<double>(options.counts.size()) + 1;
  of_solving.progress = part_of(options.progress, 0, 1 / steps);
  const EvaluatedTransfer full = evaluate_full(source, target, of_solving);
  std::vector<EvaluationRow> rows;
  std::optional<RegionCompleter> completion;
  for (const int k : options.counts) {
    const double done = static_cast<double>(rows.size()) + 1;
    const Progress progress = part_of(options.progress, done / steps, (done + 1) / steps);
    const Stopwatch stopwatch;
    of_analysis.decomposition.count = k;
    of_analysis.progress = part_of(progress, 0, kAnalysisShare);
    const Analysis analysis = analyse(source, of_analysis);
    if (!completion) completion.emplace(analysis, of_regions);
    const Regions regions = (*completion)(choose_regions(analysis, of_regions), target, of_solving);
    const double seconds = stopwatch.seconds();
    of_solving.progress = part_of(progress, kAnalysisShare, 1);
    rows.push_back(evaluate_by(regions, full, source, target, of_solving).row);
    rows.back().k = analysis.components.count();
    rows.back().decompose_seconds = seconds;
    rows.back().converged = analysis.components.converged;
  }
  rows.push_back(full.row);
  return rows;
}

}  // namespace mimetra
