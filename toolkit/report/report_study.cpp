#include "toolkit/report/report_study.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "toolkit/mesh/stopwatch.h"
#include "toolkit/operations/match_parameters.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/paint_parameter.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/pipeline/region_choice.h"
#include "toolkit/pipeline/solve.h"

namespace mimetra {

namespace {

/// Returns "take" for "shots/take/", for headlines.
std::string short_name(const std::string& name) {
  std::filesystem::path path(name);
  if (!path.has_filename()) path = path.parent_path();
  return path.filename().string();
}

/// Call of the run, with its sequence under the name that `transfer` uses.
Invocation call_of(const RunRead& run, std::vector<std::string>& notes, const Context& context) {
  Invocation call = run.invocation;
  if (!call.inputs.contains("source")) call.inputs["source"] = call.inputs.at("sequence");
  call.log = [&notes](LogLevel level, const std::string& message) {
    if (level == LogLevel::warning) notes.push_back(message);
  };
  call.context = context;
  call.context = with_notes_as_warnings(call);
  return call;
}

/// Target whose result `run` contains, or the first if it contains all. If there are several
/// targets, each has a folder of its name or a file NAME-TARGET.EXT.
const NamedData& target_of(const Invocation& call, const NamedData& run, const Log& log) {
  const std::vector<NamedData>& targets = call.inputs.at("target");
  const std::filesystem::path manifest =
      absolute(run.origin.run->record.manifest).lexically_normal();
  const std::string folder = manifest.parent_path().filename().string();
  const std::string file = std::filesystem::path(run.name).stem().string();
  const auto named = std::ranges::find_if(targets, [&](const NamedData& target) {
    return folder == target.name || file.ends_with('-' + target.name);
  });
  if (named != targets.end()) return *named;
  if (targets.size() > 1 && log) {
    log(LogLevel::warning, run.name + ": has " + std::to_string(targets.size()) +
                               " targets, the report shows " + targets.front().name +
                               "; name the folder or file of another one");
  }
  return targets.front();
}

/// Repeats the steps of a run. Contexts are parts of the call's context.
class RunSteps {
 public:
  RunSteps(const Invocation& call, const Context& context)
      : call_(call),
        sequence_(call.sequence("source")),
        targets_(targets_of(call, context)),
        source_(source_of(call, targets_, context)) {}

  const Source& source() const { return source_; }
  /// Target of the call, on the source's triangles.
  const Target& matched(const NamedData& target) const {
    return *targets_.at(&target - call_.inputs.at("target").data());
  }

  struct Found {
    Regions regions;
    RegionCompleter completer;
    std::optional<Components> components = {};
    double seconds = 0;
  };

  /// Whether regions are chosen for each target; without a target they are then unknown.
  bool selects() const { return region_options().select == Selector::transfer; }

  /// Regions as the run chose them for a target, or with at most `discs` discs.
  Found regions_for(const Target& target, std::optional<int> discs, const Context& context) const {
    const Stopwatch stopwatch;
    RegionChoiceOptions options = with_most_discs(region_options(), call_.parameters);
    if (discs) options.discs = discs;
    const SolveOptions of_solving = solve_options(call_);
    Found found = as_given({});
    found.regions = in_command_terms(call_.parameters, [&] {
      const PlacedSource placed = placed_at(target, source_, of_solving.axes, context.part(0, 0));
      RegionSelector selector(source_, options, analysis_options());
      return selector(placed.source, target, of_solving, context);
    });
    found.seconds = stopwatch.seconds();
    return found;
  }

  Found regions_as_run(const Context& context) const {
    const bool may_be_painted = call_.parameters.find("paint") != nullptr;
    if (const auto painted = may_be_painted ? painted_region_of(call_) : std::nullopt) {
      return as_given(painted->regions);
    }
    if (const RegionData* given = call_.find<RegionData>("regions")) {
      return as_given(given->regions);
    }
    const auto given = given_components(call_);
    if (!given) return regions_of(main_count(call_.parameters), context);
    return found_by(analysis_of(*given, sequence_, source_.moving, analysis_options(), context), 0,
                    context);
  }

  Found regions_of(int count, const Context& context) const {
    const Stopwatch stopwatch;
    AnalysisOptions options = analysis_options();
    options.count = count;
    const Context bounded = context.with_memory(within_memory(call_).memory());
    Analysis analysis =
        in_command_terms(call_.parameters, [&] { return analyse(source_, options, bounded); });
    return found_by(std::move(analysis), stopwatch.seconds(), context);
  }

  EvaluatedTransfer full(const Target& target, const Context& context) const {
    return in_command_terms(call_.parameters, [&] {
      return evaluate_full(source_, target, solve_options(call_), context);
    });
  }

  Regions completed(Found& found, const Target& target, const Context& context) const {
    if (selects()) return found.regions;
    return found.completer(found.regions, target, solve_options(call_), context);
  }

  EvaluatedTransfer by(const Regions& regions, const EvaluatedTransfer& full, const Target& target,
                       const Context& context) const {
    return in_command_terms(call_.parameters, [&] {
      return evaluate_by(regions, full, source_, target, solve_options(call_), context);
    });
  }

 private:
  static SolveOptions solve_options(const Invocation& call) {
    SolveOptions options = solving_parameters().read(call.parameters);
    if (call.inputs.contains("target")) set_usual_border(call, options);
    const AnalysisOptions analysis = analysis_parameters().read(call.parameters);
    options.edges = edge_sum(analysis.compatibility);
    options.distances = analysis.distances;
    return options;
  }

  static std::vector<MatchedTarget> targets_of(const Invocation& call, const Context& context) {
    std::vector<MatchedTarget> targets;
    if (!call.inputs.contains("target")) return targets;
    const MeshSequence& sequence = call.sequence("source");
    const SourceOptions of_source =
        source_rest_parameters().read(call.parameters, &call.get<FieldSequence>("source"));
    for (const Target& target : mimetra::targets_of(call)) {
      targets.push_back(in_command_terms(call.parameters, [&] {
        return MatchedTarget(sequence, target, asked_rest(sequence, of_source), context);
      }));
    }
    return targets;
  }

  static Source source_of(const Invocation& call, const std::vector<MatchedTarget>& targets,
                          const Context& context) {
    const NamedData& input = call.input("source");
    const MeshSequence& sequence = call.sequence("source");
    BoundParameters<SourceOptions> list = alignment_parameters();
    list.add(targets.empty() ? rest_parameters() : source_rest_parameters());
    const SourceOptions options =
        described(list.read(call.parameters, &std::get<FieldSequence>(input.data)), input);
    JointSearch joint;
    if (!targets.empty()) {
      std::vector<Target> all;
      all.reserve(targets.size());
      for (const MatchedTarget& target : targets) all.push_back(*target);
      joint = joint_search(all, solve_options(call));
    }
    return in_command_terms(call.parameters,
                            [&] { return prepare_source(sequence, options, joint, context); });
  }

  Found as_given(const Regions& regions) const {
    return {regions, RegionCompleter(source_, region_options(), analysis_options())};
  }

  Found found_by(Analysis analysis, double seconds, const Context& context) const {
    Regions regions = choose_regions(analysis, region_options(), context.part(1, 1));
    RegionCompleter completer(analysis, region_options());
    return {std::move(regions), std::move(completer), std::move(analysis.components), seconds};
  }

  AnalysisOptions analysis_options() const {
    BoundParameters<AnalysisOptions> list = analysis_parameters();
    if (call_.inputs.contains("target")) list.add(analysis_rest_parameters());
    return list.read(call_.parameters, &call_.get<FieldSequence>("source"));
  }

  RegionChoiceOptions region_options() const {
    BoundParameters<RegionChoiceOptions> list = region_parameters();
    if (!targets_.empty()) list.add(completion_parameters());
    return list.read(call_.parameters);
  }

  const Invocation& call_;
  const MeshSequence& sequence_;
  std::vector<MatchedTarget> targets_;
  Source source_;
};

EvaluationRow completed(EvaluationRow row, const RunSteps::Found& found, const RunSteps& steps) {
  if (steps.selects()) {
    row.k = static_cast<int>(found.regions.regions.size());
    row.by = Selector::transfer;
    row.decompose_seconds = found.seconds;
  }
  if (!found.components) return row;
  row.k = found.components->count();
  row.by = Selector::energy;
  row.converged = found.components->converged;
  if (found.seconds > 0) row.decompose_seconds = found.seconds;
  return row;
}

/// Returns 1 if two meshes may have the same unit of length, otherwise the factor that makes their
/// sizes equal.
double shown_scale(const FrameSource& source, const FrameSource& target) {
  constexpr double kOneUnit = 3;
  const double ratio = source.diameter() / target.diameter();
  return ratio > kOneUnit || ratio < 1 / kOneUnit ? ratio : 1;
}

void enlarge(MeshSequence& sequence, double scale) {
  if (scale == 1) return;
  const Positions rest = scale * sequence.rest();
  sequence = sequence.with_frames(scale * sequence.positions()).with_rest(rest);
}

/// Drops warnings of `work`, which do not belong to the run.
template <typename Work>
auto apart_from(std::vector<std::string>& notes, const Work& work) {
  const std::size_t before = notes.size();
  auto result = work();
  notes.resize(before);
  return result;
}

/// Source regions carried to the vertices of a target.
std::vector<int> regions_over(const std::vector<int>& regions, const Target& target) {
  if (!target.pairing) return regions;
  std::vector<int> over(static_cast<std::size_t>(target.pairing->target_vertices()), -1);
  for (VertexIndex v = 0; v < target.pairing->target_vertices(); ++v) {
    const auto carriers = target.pairing->carriers(v);
    if (carriers.empty()) continue;
    const auto most = std::ranges::max_element(carriers, {}, &Pairing::Carrier::weight);
    over[static_cast<std::size_t>(v)] = regions[static_cast<std::size_t>(most->vertex)];
  }
  return over;
}

ReportedTransfer transferred(const RunSteps& steps, const Target& to, RunSteps::Found& main,
                             const std::vector<int>& counts, std::vector<std::string>& notes,
                             const Context& context) {
  ReportedTransfer transfer;
  transfer.target = short_name(to.name);
  EvaluatedTransfer full = apart_from(notes, [&] { return steps.full(to, context.part(0, 0.1)); });
  main.regions = steps.completed(main, to, context.part(0.1, 0.1));
  EvaluatedTransfer by_regions = steps.by(main.regions, full, to, context.part(0.1, 0.2));
  main.regions = std::move(by_regions.regions);
  transfer.expressions = by_regions.solution.weight_names();
  const EvaluationRow main_row = completed(by_regions.row, main, steps);
  transfer.rows.push_back(main_row);
  const std::set<int> more(counts.begin(), counts.end());
  double done = 0.2;
  const double each = (1 - done) / static_cast<double>(std::max<std::size_t>(1, more.size()));
  for (const int k : more) {
    const Context part = context.part(done, done + each);
    done += each;
    if (k == main_row.k || k > main.regions.vertices) continue;
    transfer.rows.push_back(apart_from(notes, [&] {
      const Context until_found = part.part(0, 0.7);
      auto found = steps.selects() ? steps.regions_for(to, k, until_found)
                                   : steps.regions_of(k, until_found);
      found.regions = steps.completed(found, to, part.part(0.7, 0.7));
      return completed(steps.by(found.regions, full, to, part.part(0.7, 1)).row, found, steps);
    }));
  }
  std::ranges::stable_sort(transfer.rows, {}, [](const EvaluationRow& row) { return row.k; });
  transfer.main_row = static_cast<std::size_t>(
      std::ranges::find(transfer.rows, main_row.k, &EvaluationRow::k) - transfer.rows.begin());
  transfer.rows.push_back(full.row);
  transfer.full = MeshSequence(*full.solution.sequence);
  transfer.by_regions = MeshSequence(*by_regions.solution.sequence);
  transfer.regions_of_vertices = regions_over(strongest_regions(main.regions), to);
  transfer.weights = by_regions.solution.weights();
  transfer.shown_scale = shown_scale(*steps.source().sequence, transfer.by_regions);
  enlarge(transfer.full, transfer.shown_scale);
  enlarge(transfer.by_regions, transfer.shown_scale);
  return transfer;
}

/// Numbers of components for the table: the given ones, and those of an evaluation unless it used a
/// painting.
std::vector<int> all_counts(std::vector<int> counts, const Parameters& parameters) {
  if (parameters.find("k")->kind != ParameterKind::integer_list) return counts;
  if (parameters.optional_text("paint")) return counts;
  const auto& own = parameters.integers("k");
  counts.insert(counts.end(), own.begin(), own.end());
  return counts;
}

}  // namespace

std::vector<int> strongest_regions(const Regions& regions) {
  std::vector<int> strongest;
  const Field region = fields_of(regions).front();
  for (const double index : region.values.col(0)) {
    strongest.push_back(static_cast<int>(std::lround(index)));
  }
  return strongest;
}

int main_count(const Parameters& parameters) {
  if (parameters.find("k")->kind == ParameterKind::integer) return parameters.integer("k");
  return static_cast<int>(*std::ranges::max_element(parameters.integers("k")));
}

ReportStudy study(const NamedData& run, const std::vector<int>& counts, const Log& log,
                  const Context& context) {
  const RunRead& read = *run.origin.run;
  ReportStudy result;
  result.run = read.record;
  for (const auto& file : read.record.changed) {
    if (!log) break;
    log(LogLevel::warning, file.string() + ": has changed since " + read.record.manifest.string() +
                               " was written; the report shows what it gives now");
  }
  const Invocation call = call_of(read, result.notes, context);
  result.source = short_name(call.input("source").name);
  const RunSteps steps(call, call.context.part(0, 0));
  result.moved_head = !steps.source().motion.empty();
  result.sequence = MeshSequence(*steps.source().sequence);
  const NamedData* target = call.inputs.contains("target") ? &target_of(call, run, log) : nullptr;
  const double found_at = target ? 0.3 : 1;
  const Context until_found = call.context.part(0, found_at);
  auto found = target && steps.selects()
                   ? steps.regions_for(steps.matched(*target), {}, until_found)
                   : steps.regions_as_run(until_found);
  if (target) {
    result.transfer =
        transferred(steps, steps.matched(*target), found, all_counts(counts, call.parameters),
                    result.notes, call.context.part(found_at, 1));
  }
  result.regions = std::move(found.regions);
  result.components = std::move(found.components);
  return result;
}

}  // namespace mimetra
