#include "toolkit/pipeline/transfer.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "toolkit/mesh/frame_shapes.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/pipeline/measure.h"

namespace mimetra {

namespace {

/// Progress at which head motion is known, and at which the regions are known. For each target, the
/// progress at which it is solved.
constexpr double kSourceShare = 0.1;
constexpr double kRegionShare = 0.7;
constexpr double kSolveShare = 0.7;

void check_full(const TransferOptions& options) {
  if (options.full && options.solve.per_region) {
    throw std::invalid_argument("per_region: a full transfer has no regions");
  }
  if (options.full && options.solve.falloff) {
    throw std::invalid_argument("falloff: a full transfer has no regions");
  }
}

std::vector<MatchedTarget> matched_targets(const FrameSource& sequence,
                                           const std::vector<Target>& given,
                                           const SourceOptions& options, const Context& context) {
  std::vector<MatchedTarget> matched;
  for (const Target& target : given) {
    std::optional<Positions> rest;
    if (is_to_be_paired(sequence, target)) rest = asked_rest(sequence, options);
    matched.emplace_back(sequence, target, rest, context);
  }
  return matched;
}

/// Whether a frame differs from the rest pose. Reads until one does.
bool moves(const FrameSource& sequence) {
  const double least = kLeastMotion * sequence.diameter();
  for (int f = 0; f < sequence.frames(); ++f) {
    const FrameBlock block(sequence, f, 1);
    if ((block.frame(0) - sequence.rest()).rowwise().norm().maxCoeff() > least) return true;
  }
  return false;
}

/// Notes that all frames equal the rest pose. The result would be the target's neutral, without any
/// error. Throws MismatchError for a single such frame.
void expect_motion(const FrameSource& sequence, const std::string& name, const Context& context) {
  if (moves(sequence)) return;
  const bool single = sequence.frames() == 1;
  const std::string text =
      name + ": nothing moves: " +
      (single ? "it has one frame, its rest pose"
              : "all " + std::to_string(sequence.frames()) + " frames are its rest pose") +
      "; give what drives it (option 'weights') where it is a model, or its undeformed shape "
      "(option 'source-rest')";
  if (single) throw MismatchError(text);
  context.note(text);
}

struct Choice {
  std::optional<Regions> regions = {};
  std::optional<RegionCompleter> completion = {};
  /// Chooses the regions of each target, instead of the above.
  std::optional<RegionSelector> selector = {};
  std::optional<Components> components = {};
  double seconds = 0;
};

Choice choose(const Source& source, const TransferOptions& options, const Context& context) {
  if (options.full) return {};
  const FrameSource& sequence = *source.sequence;
  if (const auto* given = std::get_if<GivenRegions>(&options.given)) {
    check_regions(*given, sequence);
    return {given->regions, RegionCompleter(source, options.regions, options.analysis)};
  }
  if (options.regions.select == Selector::transfer) {
    Choice choice;
    choice.selector.emplace(source, options.regions, options.analysis);
    return choice;
  }
  const Stopwatch stopwatch;
  const auto* given = std::get_if<GivenComponents>(&options.given);
  Analysis analysis = given
                          ? analysis_of(*given, sequence, source.moving, options.analysis, context)
                          : analyse(source, options.analysis, context);
  Regions regions = choose_regions(analysis, options.regions, context.part(1, 1));
  RegionCompleter completion(analysis, options.regions);
  return {std::move(regions),
          std::move(completion),
          {},
          std::move(analysis.components),
          stopwatch.seconds()};
}

/// Returns the regions that a target is solved by; empty for all triangles.
std::optional<Regions> regions_for(const Target& target, const Source& placed, Choice& choice,
                                   const SolveOptions& of_solving, const Context& context) {
  if (choice.selector) {
    const Stopwatch stopwatch;
    Regions regions = (*choice.selector)(placed, target, of_solving, context);
    choice.seconds += stopwatch.seconds();
    return regions;
  }
  if (!choice.regions) return {};
  return (*choice.completion)(*choice.regions, target, of_solving, context);
}

/// Active options that hold a target back from the source's motion, in the spelling of parameters:
/// "option 'smoothness'".
std::vector<std::string> holding_options(const Target& target, const SolveOptions& options) {
  std::vector<std::string> names;
  const auto add = [&names](bool is_on, const std::string& name) {
    if (is_on) names.push_back("option '" + name + "'");
  };
  add(options.smoothness > 0, "smoothness");
  if (solves_for_vertices(target.model, options.space)) return names;
  add(options.ridge > 0, "ridge");
  add(options.sparsity > 0, "l1");
  add(options.symmetry > 0, "symmetry");
  add(options.exclusive != Exclusive::none, "exclusive");
  add(!target.rules.empty(), "rules");
  return names;
}

Target without_holds(Target target) {
  target.rules = {};
  return target;
}

SolveOptions without_holds(SolveOptions options) {
  options.smoothness = options.ridge = options.sparsity = options.symmetry = 0;
  options.exclusive = Exclusive::none;
  return options;
}

/// A target's solve, and the inputs of its error.
struct TargetSolve {
  const PlacedSource& placed;
  const Target& target;
  const Selection& selection;
  const SolveOptions& options;

  TransferError error(const Solution& solution, const Context& context) const {
    return error_of(solution, placed.source, target, selection, options, context);
  }

  /// Error of a solve without the options that hold the target back; without notes.
  TransferError error_without_holds(const Context& context) const {
    const Target unruled = without_holds(target);
    const Context quiet = context.quiet();
    return error(solve(placed.source, unruled, selection, without_holds(options), quiet), quiet);
  }
};

/// Notes a result that is probably unusable, by its error before head motion is given back, and the
/// likely cause. Solves for weights again without the options that hold them back.
void note_usability(const TargetSolve& solved, const TransferError& error,
                    const TransferOptions& options, const Context& context) {
  const Target& target = solved.target;
  const std::string wrong = unusable_by(error);
  if (wrong.empty()) return;
  std::string text = target.name + ": the result may not be usable: " + wrong;
  const FrameSource& source = *solved.placed.source.sequence;
  const OddFrames odd = odd_frames(source, frame_shapes(source, context.without_ranks()));
  if (odd.any()) {
    context.note(text +
                 "; look at the source's frames, of which some can be no poses of its "
                 "mesh: `mimetra check` names them");
    return;
  }
  const std::vector<std::string> holds = holding_options(target, solved.options);
  if (!holds.empty()) {
    const std::string names = joined(holds, ", ", " and ");
    if (solves_for_vertices(target.model, solved.options.space)) {
      text += "; " + names + " is on, which damps motion";
    } else {
      const TransferError free = solved.error_without_holds(context);
      if (unusable_by(free).empty()) {
        context.note(text + "; without " + names + ' ' + percent(missed_share(free)) +
                     " of the deformation is missing, and the result is usable");
        return;
      }
      text += "; without " + names + " still " + unusable_by(free);
    }
  }
  if (!options.full) {
    context.note(text, Topic::poor_condition);
  } else if (target.pairing) {
    context.note(text +
                 "; source and target are paired: look at the result, and add markers "
                 "where it is wrong");
  } else {
    context.note(text +
                 "; look whether source and target have the same vertices in the same "
                 "order, and whether both rest poses are neutral");
  }
}

/// Rounding error, as a share of an opening's width.
constexpr double kNoMotion = 1e-9;

/// Compares the openings if markers were searched for. Notes openings that do not close, except
/// those that the regions' border holds still.
std::vector<ComparedOpening> openings_on(const MatchedTarget& target, const FrameSource& source,
                                         const Solution& solution, const Selection& selection,
                                         const Context& context) {
  if (!target.report() || !target.report()->found) return {};
  std::vector<ComparedOpening> openings = compared_openings(
      source, *solution.sequence, *target.report()->found, context.without_ranks());
  for (const ComparedOpening& opening : openings) {
    const bool is_held = std::ranges::count(selection.inside, false) > 0 &&
                         opening.target_most - opening.target_least < kNoMotion;
    if (is_held || !opening.stays_open()) continue;
    context.note((*target).name + ": the " + std::string(opening.name) +
                 " closes on the source, here " + percent(opening.target_least) +
                 " of its width stay open; look at it, and add markers around it");
  }
  return openings;
}

/// Adds the discs of `completed` that `regions` lack.
void take_over(const Regions& completed, Regions& regions, const Triangles& triangles) {
  std::vector<Region> added;
  for (const Region& region : completed.regions) {
    const bool is_known = std::ranges::any_of(regions.regions, [&region](const Region& other) {
      return other.center == region.center && other.vertices == region.vertices;
    });
    if (!region.added_for.empty() && !is_known) added.push_back(region);
  }
  regions = with_added(regions, std::move(added), triangles);
}

/// Returns the common regions of all targets; empty if each target has its own.
std::optional<Regions> regions_of(const std::vector<TransferredTarget>& targets, Choice& choice,
                                  const RegionChoiceOptions& options, const Triangles& triangles) {
  if (targets.size() == 1) return targets.front().regions;
  if (has_own_regions(options)) return {};
  for (const TransferredTarget& each : targets) {
    if (each.regions) take_over(*each.regions, *choice.regions, triangles);
  }
  return std::move(choice.regions);
}

}  // namespace

TransferResult transfer(const FrameSource& sequence, const std::vector<Target>& given,
                        const TransferOptions& options, const Context& context) {
  check_options(options);
  check_options(options.analysis);
  check_options(options.regions);
  check_options(options.solve);
  check_full(options);
  const std::vector<MatchedTarget> matched =
      matched_targets(sequence, given, options.source, context.part(0, 0));
  const SolveOptions of_solving = with_analysis(options.solve, options.analysis);
  std::vector<Target> targets;
  for (const MatchedTarget& target : matched) {
    if (!options.full) check_selection(*target, options.regions, options.solve.space);
    targets.push_back(*target);
  }
  for (const Target& target : targets) {
    check_rules(target, of_solving);
    check_border(std::get_if<GivenRegions>(&options.given), target, of_solving);
  }
  // The source keeps no ownership of `sequence`; nothing that is returned refers to it.
  const std::shared_ptr<const FrameSource> unowned(std::shared_ptr<const FrameSource>(), &sequence);
  const Source source = prepare_source(unowned, options.source, joint_search(targets, of_solving),
                                       context.part(0, kSourceShare));
  expect_motion(*source.sequence, options.source.name, context);
  Choice choice = choose(source, options, context.part(kSourceShare, kRegionShare));
  const bool give_back = !source.motion.empty() && options.head_motion == RemovedMotion::keep;

  TransferResult result;
  const double first = choice.regions ? kRegionShare : kSourceShare;
  const double chosen = choice.selector ? kRegionShare * kSolveShare : 0;
  const auto count = static_cast<double>(targets.size());
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const Context of_this = context.part(first + (1 - first) * static_cast<double>(t) / count,
                                         first + (1 - first) * static_cast<double>(t + 1) / count);
    const Context done = of_this.part(1, 1);
    const Target& target = targets[t];
    const PlacedSource placed = placed_at(target, source, of_solving.axes, of_this);
    std::optional<Regions> regions =
        regions_for(target, placed.source, choice, of_solving, of_this.part(0, chosen));
    const Selection selection =
        regions ? bordered_selection(*regions, target, of_solving, source.moving,
                                     of_this.part(chosen, chosen))
                : whole(target);
    if (regions) regions = with_border(std::move(*regions), selection, target);
    Solution solution =
        solve(placed.source, target, selection, of_solving, of_this.part(chosen, kSolveShare));
    const Stopwatch of_error;
    const TargetSolve of_target{placed, target, selection, of_solving};
    TransferError error = of_target.error(solution, of_this.part(kSolveShare, 1));
    const double error_seconds = of_error.seconds();
    note_usability(of_target, error, options, done);
    // Expressions that do not fade move the whole face, so they make no crease at the regions'
    // border.
    if (solution.weights().size() == 0 || selection.weights.size() > 0) {
      note_crease(error, target, context);
    }
    std::vector<ComparedOpening> openings =
        openings_on(matched[t], *placed.source.sequence, solution, selection, done);
    if (give_back) solution.sequence = with_head_motion(solution.sequence, placed.source.motion);
    result.targets.push_back({std::move(solution), std::move(regions), placed.similarity,
                              std::move(error), target.pairing, matched[t].report(), error_seconds,
                              std::move(openings), selection.weights});
  }
  result.head_motion = source.head_motion;
  result.regions = regions_of(result.targets, choice, options.regions, sequence.triangles());
  result.components = std::move(choice.components);
  result.region_seconds = choice.seconds;
  return result;
}

}  // namespace mimetra
