#include "toolkit/pipeline/measure.h"

#include <algorithm>
#include <array>
#include <utility>

#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/splocs/reduction.h"
#include "toolkit/transfer/seams.h"

namespace mimetra {

namespace {

/// Whether some vertices take more of the motion than others.
bool has_border(const Selection& selection) {
  if (selection.weights.size() > 0) {
    return selection.weights.minCoeff() < selection.weights.maxCoeff();
  }
  return std::ranges::count(selection.inside, false) > 0;
}

}  // namespace

TransferError error_of(const Solution& solution, const Source& source, const Target& target,
                       const Selection& selection, const SolveOptions& options,
                       const Context& context) {
  TransferErrorOptions of_error{.edges = options.edges.value_or(EdgeSum::all),
                                .pairing = target.pairing,
                                .inside = selection.inside,
                                .weights = selection.weights};
  const double seams = has_border(selection) ? 0.2 : 0;
  if (seams > 0) {
    of_error.weld = closed_seams_of(source, target, context.part(0, seams).without_ranks());
  }
  return transfer_error(*source.sequence, *solution.sequence, selection.triangles, of_error,
                        context.part(seams, 1));
}

void note_crease(const TransferError& error, const Target& target, const Context& context) {
  if (error.crease < kVisibleCrease) return;
  context.note(target.name + ": the surface folds at the regions' border by " +
                   readable(error.crease, 2) + " degrees more than the source does, by " +
                   readable(error.largest_crease, 2) + " where it is worst: a crease that is seen",
               Topic::visible_crease);
}

std::string unusable_by(const TransferError& error) {
  std::string wrong;
  if (missed_share(error) > kUnusableMissedShare) {
    wrong = percent(missed_share(error)) + " of the deformation is missing";
  }
  if (flipped_share(error) > kUnusableFlippedShare) {
    wrong += (wrong.empty() ? "" : ", and ") +
             readable(error.flipped / double(error.per_frame.size()), 2) +
             " triangles a frame are flipped";
  }
  return wrong;
}

namespace {

/// Mean of `per_triangle` over the selected triangles.
double mean_over(const Eigen::VectorXd& per_triangle, const std::vector<int>& selected) {
  double sum = 0;
  for (const int triangle : selected) sum += per_triangle[triangle];
  return sum / static_cast<double>(selected.size());
}

/// MPE; empty if the full transfer of a mesh of this size is exact up to the rounding of single
/// precision files.
std::optional<double> percentage_error(double full, double k, double size) {
  constexpr double kRounding = 1e-7;
  if (full <= kRounding * size * kRounding * size) return {};
  return mean_percentage_error(full, k);
}

EvaluatedTransfer solved(const Source& source, const Target& target, const Selection& selection,
                         const SolveOptions& options, const Context& context) {
  const PlacedSource placed = placed_at(target, source, options.axes, context);
  EvaluatedTransfer result{{}, solve(placed.source, target, selection, options, context), {}};
  result.error =
      error_of(result.solution, placed.source, target, selection, options, context.part(1, 1));
  result.row.de_all = result.error.de_all;
  result.row.de_region = result.error.de_region;
  result.row.transfer_seconds = result.solution.seconds;
  result.row.leak = result.error.leak;
  result.row.crease = result.error.crease;
  result.row.largest_crease = result.error.largest_crease;
  return result;
}

/// Share of the decomposition in the work of a row; the transfer takes the rest.
constexpr double kAnalysisShare = 0.9;

/// Radius of all regions of the source, without added discs; empty if the radii differ.
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
                                const SolveOptions& options, const Context& context) {
  EvaluatedTransfer result = solved(source, target, whole(target), options, context);
  result.row.vertices = source.sequence->vertices();
  result.row.triangles = static_cast<int>(source.sequence->triangles().rows());
  result.row.de_region = result.row.de_all;
  return result;
}

EvaluatedTransfer evaluate_by(const Regions& regions, const EvaluatedTransfer& full,
                              const Source& source, const Target& target,
                              const SolveOptions& options, const Context& context) {
  const Selection selection =
      bordered_selection(regions, target, options, source.moving, context.part(0, 0));
  EvaluatedTransfer result = solved(source, target, selection, options, context);
  EvaluationRow& row = result.row;
  result.regions = with_border(regions, selection, target);
  row.vertices = result.regions.vertex_count();
  row.triangles = static_cast<int>(result.regions.triangles.size());
  row.vertex_share = result.regions.vertex_share();
  row.triangle_share = result.regions.triangle_share();
  row.radius = common_radius(regions);
  const double size = result.solution.sequence->diameter();
  row.mpe_all = percentage_error(full.error.de_all, row.de_all, size);
  row.mpe_region = percentage_error(
      mean_over(full.error.per_triangle, with_partners(selection.triangles, target.pairing.get())),
      row.de_region, size);
  return result;
}

namespace {

/// Shares of the triangles along a curve.
constexpr std::array kCurveShares = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};

/// Makes the rows of one evaluation, one after the other.
class Rows {
 public:
  Rows(const FrameSource& sequence, const Target& given, const EvaluationOptions& options,
       const Context& context)
      : options_(options),
        context_(context),
        steps_(1 + number_of_rows(options)),
        matched_(sequence, given, asked_rest(sequence, options.source), context.part(0, 0)),
        target_(*matched_) {
    options_.solve = with_analysis(options.solve, options.analysis);
    if (options.curve || options.regions.select == Selector::transfer) {
      RegionChoiceOptions of_transfer = options.regions;
      of_transfer.select = Selector::transfer;
      check_selection(target_, of_transfer, options.solve.space);
    }
    check_rules(target_, options_.solve);
    check_border(options.given ? &*options.given : nullptr, target_, options_.solve);
    // The source keeps no ownership of `sequence`; nothing that is returned refers to it.
    source_ = prepare_source(
        std::shared_ptr<const FrameSource>(std::shared_ptr<const FrameSource>(), &sequence),
        options_.source, joint_search({target_}, options_.solve), context.part(0, 0));
    full_ = evaluate_full(source_, target_, options_.solve, next_part(0, 1));
  }

  /// Adds a row of given regions, completed for the target.
  void add_given(const GivenRegions& given) {
    check_regions(given, *source_.sequence);
    RegionCompleter completion(source_, options_.regions, options_.analysis);
    const Regions regions = completion(given.regions, target_, options_.solve, next_part(0, 0));
    add(evaluate_by(regions, full_, source_, target_, options_.solve, next_part(0, 1)));
  }

  /// Adds a row of the strongest regions of k components.
  void add_energy(int k) {
    const Stopwatch stopwatch;
    const Analysis analysis = analysis_of(k);
    const Context chosen = next_part(kAnalysisShare, kAnalysisShare);
    const Regions regions = completer(analysis)(choose_regions(analysis, options_.regions, chosen),
                                                target_, options_.solve, chosen);
    add(regions, analysis, analysis.components.count(), stopwatch.seconds());
  }

  /// Adds a row of regions that are chosen for the transfer.
  void add_transfer(const SelectionBound& bound) {
    const Stopwatch stopwatch;
    if (!selector_) selector_.emplace(source_, options_.regions, options_.analysis);
    const PlacedSource placed = placed_at(target_, source_, options_.solve.axes, context_);
    const Regions regions = selector_
                                ->within({&bound, 1}, placed.source, target_, options_.solve,
                                         next_part(0, kAnalysisShare))
                                .front();
    const double seconds = stopwatch.seconds();
    EvaluatedTransfer result =
        evaluate_by(regions, full_, source_, target_, options_.solve, next_part(kAnalysisShare, 1));
    result.row.k = static_cast<int>(regions.regions.size());
    result.row.by = Selector::transfer;
    result.row.decompose_seconds = seconds;
    add(result);
  }

  /// Adds a row for each share of the curve by the strongest regions, all from one decomposition.
  /// Skips shares that are too small for a region, and shares that add no triangles.
  void add_energy_curve() {
    const Stopwatch stopwatch;
    const Analysis analysis = analysis_of(EvaluationOptions::kCurveComponents);
    const double seconds = stopwatch.seconds();
    RegionChoiceOptions of_share = options_.regions;
    const Context chosen = next_part(kAnalysisShare, kAnalysisShare);
    const Regions all = choose_regions(analysis, of_share, chosen);
    for (const double share : kCurveShares) {
      if (regions_within(all, share, source_.sequence->triangles()) == 0) continue;
      of_share.triangles = share;
      RegionCompleter completion(analysis, of_share);
      const Regions regions = completion(choose_regions(analysis, of_share, chosen.quiet()),
                                         target_, options_.solve, chosen.quiet());
      const auto triangles = static_cast<int>(regions.triangles.size());
      if (!rows_.empty() && rows_.back().triangles == triangles) continue;
      add(regions, analysis, static_cast<int>(regions.regions.size()), seconds);
    }
  }

  /// Adds the rows of the curve by regions that are chosen for the transfer.
  void add_transfer_curve() {
    for (const double share : kCurveShares) add_transfer({share, {}});
  }

  std::vector<EvaluationRow> with_full() && {
    judge(full_);
    if (!unusable_.empty()) {
      context_.note(target_.name + ": rows of which the result may not be usable: " +
                    joined(unusable_, "; ", "; "));
    }
    rows_.push_back(full_.row);
    return std::move(rows_);
  }

 private:
  static double number_of_rows(const EvaluationOptions& options) {
    if (options.given) return 1;
    if (options.curve) return 2 * static_cast<double>(kCurveShares.size());
    return std::max(1.0, static_cast<double>(options.counts.size()));
  }

  /// Part of the progress that belongs to the current row.
  Context next_part(double from, double to) const {
    const double done = full_.solution.sequence ? static_cast<double>(rows_.size()) + 1 : 0;
    return context_.part(std::min(1.0, (done + from) / steps_),
                         std::min(1.0, (done + to) / steps_));
  }

  /// Remembers results that are probably unusable.
  void judge(const EvaluatedTransfer& result) {
    std::string wrong = unusable_by(result.error);
    if (result.error.crease >= kVisibleCrease) {
      wrong += (wrong.empty() ? "" : ", and ") + std::string("a crease of ") +
               readable(result.error.crease, 2) + " degrees is seen";
    }
    if (wrong.empty()) return;
    const EvaluationRow& row = result.row;
    unusable_.push_back((row.k ? "K = " + std::to_string(*row.k)
                               : percent(row.triangle_share) + " of the triangles") +
                        ": " + wrong);
  }

  /// \pre `result.row` is complete
  void add(const EvaluatedTransfer& result) {
    judge(result);
    rows_.push_back(result.row);
  }

  Analysis analysis_of(int k) {
    options_.analysis.count = k;
    return analyse(source_, options_.analysis, next_part(0, kAnalysisShare));
  }

  RegionCompleter& completer(const Analysis& analysis) {
    if (!completer_) completer_.emplace(analysis, options_.regions);
    return *completer_;
  }

  void add(const Regions& regions, const Analysis& analysis, int k, double seconds) {
    EvaluatedTransfer result =
        evaluate_by(regions, full_, source_, target_, options_.solve, next_part(kAnalysisShare, 1));
    result.row.k = k;
    result.row.by = Selector::energy;
    result.row.decompose_seconds = seconds;
    result.row.converged = analysis.components.converged;
    add(result);
  }

  EvaluationOptions options_;
  const Context& context_;
  double steps_;
  MatchedTarget matched_;
  Target target_;
  Source source_;
  EvaluatedTransfer full_;
  std::optional<RegionCompleter> completer_;
  std::optional<RegionSelector> selector_;
  std::vector<EvaluationRow> rows_;
  std::vector<std::string> unusable_;
};

}  // namespace

std::vector<EvaluationRow> evaluate(const FrameSource& sequence, const Target& target,
                                    const EvaluationOptions& options, const Context& context) {
  check_options(options);
  check_options(options.analysis);
  check_options(options.regions);
  check_options(options.solve);
  if (options.analysis.count != AnalysisOptions().count) {
    throw std::invalid_argument("analysis.count: give the numbers of components as `counts`");
  }
  Rows rows(sequence, target, options, context);
  if (options.given) {
    rows.add_given(*options.given);
  } else if (options.curve) {
    rows.add_energy_curve();
    rows.add_transfer_curve();
  } else if (options.regions.select == Selector::energy) {
    for (const int k : options.counts) rows.add_energy(k);
  } else {
    SelectionBound bound = selection_bound(options.regions);
    if (options.counts.empty()) rows.add_transfer(bound);
    for (const int k : options.counts) {
      if (!options.regions.triangles) bound.share = 1;
      bound.count = k;
      rows.add_transfer(bound);
    }
  }
  return std::move(rows).with_full();
}

namespace {

constexpr double kNumber = sizeof(double);

/// A transfer's constant vectors, and sixteen frames per thread. Each frame is stored as read,
/// gathered, summed, as the right-hand side, and solved.
constexpr double kPullPerTriangle = 72;
constexpr double kLanesPerVertex = 5 * 3 * 16 * kNumber;

/// Bytes that a FrameStore keeps in memory; it writes larger sequences to a file.
double kept_bytes(double all) {
  return all > static_cast<double>(FrameStore::kMemoryBytes) ? 0 : all;
}

}  // namespace

double frame_bytes(const FrameSource& sequence) {
  return kNumber * 3 * sequence.frames() * sequence.vertices();
}

double simplify_bytes(const FrameSource& sequence) {
  // Quadrics of six poses, positions and normals of 13, half-edges, and the decimater's heap.
  constexpr double kOfVertex = 2800;
  return kOfVertex * sequence.vertices();
}

double stored_bytes(const FrameSource& sequence) {
  return sequence.is_quick() ? 0 : kept_bytes(frame_bytes(sequence));
}

DecompositionPlan analysis_plan(const FrameSource& sequence, const AnalysisOptions& options,
                                const Context& context) {
  DecompositionOptions decomposition = decomposition_options(options);
  decomposition.count = component_count(sequence, sequence.diameter(), options);
  const GeodesicMethod method = options.distances.method;
  const int vertices = sequence.vertices(), sources = decomposition.count;
  DecompositionPlan plan =
      planned_decomposition(sequence, Reduction(vertices, context).part(), decomposition,
                            beside_distances(method, vertices, sources, context));
  plan.bytes += distance_bytes(method, vertices, sources, context);
  return plan;
}

double selection_bytes(const FrameSource& sequence, const BlendshapeModel& target) {
  const double frames = std::min(sequence.frames(), RegionSelector::kMostFrames);
  const auto triangles = static_cast<double>(target.triangles().rows());
  const auto expressions = static_cast<double>(target.expressions().size());
  // The frames, the part of each triangle's motion that is missing, and the data of each disc.
  return kNumber * (frames * (3.0 * sequence.vertices() + 6 * triangles) +
                    RegionSelector::kCandidates * expressions * (expressions + frames)) +
         kFactorsPerVertex * sequence.vertices();
}

double solution_bytes(const FrameSource& sequence, const BlendshapeModel& target,
                      const SolveOptions& options, const Context& context) {
  const auto expressions = static_cast<double>(target.expressions().size());
  const double vertices = target.vertices(),
               triangles = static_cast<double>(target.triangles().rows());
  // Weights: the displacement fields at the used vertices, the result's fields, and the weights.
  // Vertices: the factors, and the poses of a short result.
  const double poses = kNumber * 3 * vertices * sequence.frames();
  const bool has_vertices = solves_for_vertices(target, options.space);
  double space = has_vertices ? kFactorsPerVertex * vertices + kept_bytes(poses)
                              : kNumber * expressions * (6 * vertices + 2 * sequence.frames());
  // Smoothing over time needs all poses, or a banded system of all weights.
  if (options.smoothness > 0) {
    space += has_vertices ? poses : kNumber * 4 * sequence.frames() * expressions * expressions;
  }
  const double threads = context.thread_count();
  return space + kPullPerTriangle * triangles + threads * kLanesPerVertex * vertices;
}

double regional_bytes(const FrameSource& sequence, const BlendshapeModel& target, int regions,
                      const Context& context) {
  const auto expressions = static_cast<double>(target.expressions().size());
  const double unknowns = (regions + 1) * expressions;
  const double threads = context.thread_count();
  // The Gram matrix, the system, and a factor per thread. Each thread's fields of a region,
  // gathered and shared out. The shares, twice, and the weights.
  return kNumber *
         ((2 + 2 * threads) * unknowns * unknowns + threads * 6 * expressions * target.vertices() +
          2.0 * (regions + 1) * target.vertices() + 2 * unknowns * sequence.frames());
}

}  // namespace mimetra
