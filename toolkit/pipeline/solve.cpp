#include "toolkit/pipeline/solve.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/smoothness.h"
#include "toolkit/regions/falloff.h"
#include "toolkit/transfer/seams.h"
#include "toolkit/transfer/soft_border.h"

namespace mimetra {

namespace {

/// Throws std::invalid_argument if the options do not allow weights of each region.
void check_regional(const Target& target, const SolveOptions& options) {
  if (solves_for_vertices(target.model, options.space)) {
    throw std::invalid_argument("per_region: " + target.name +
                                " is solved for vertices, which have no weights");
  }
  if (options.smoothness > 0) {
    throw std::invalid_argument(
        "smoothness: weights of each region are found frame by frame; it must be 0");
  }
  if (options.symmetry > 0 || options.exclusive != Exclusive::none || !target.rules.empty()) {
    throw std::invalid_argument("per_region: " + target.name +
                                ": weights of each region follow no rules of expressions, neither "
                                "symmetry nor exclusive");
  }
}

Similarity similarity_between(const Positions& rest, const Target& target, Axes axes) {
  const BlendshapeModel& model = target.model;
  if (!target.pairing && rest == model.neutral()) return {};
  const std::vector<VertexIndex> used = target.pairing
                                            ? target.pairing->carried_vertices()
                                            : used_vertices(model.triangles(), model.vertices());
  const Positions to = model.neutral()(used, Eigen::all);
  const Positions from =
      target.pairing ? target.pairing->carried(rest, used) : rest(used, Eigen::all);
  switch (axes) {
    case Axes::fit:
      try {
        return similarity_fit(from, to);
      } catch (const MismatchError& error) {
        throw OptionError(Topic::undetermined_axes, target.name + ": " + error.what());
      }
    case Axes::none:
      break;
  }
  return scaling_fit(from, to);
}

}  // namespace

EdgeSum edge_sum(Compatibility compatibility) {
  return compatibility == Compatibility::paper ? EdgeSum::two : EdgeSum::all;
}

SolveOptions with_analysis(SolveOptions options, const AnalysisOptions& analysis) {
  if (!options.edges) options.edges = edge_sum(analysis.compatibility);
  if (!options.distances) options.distances = analysis.distances;
  return options;
}

bool solves_for_vertices(const BlendshapeModel& target, Space space) {
  return space == Space::vertex || target.expressions().size() == 0;
}

void check_rules(const Target& target, const SolveOptions& options) {
  if (options.per_region) check_regional(target, options);
  const BlendshapeModel& model = target.model;
  if (solves_for_vertices(model, options.space)) return;
  const auto& names = model.expressions().names;
  const ExpressionRules rules(names, target.rules, options.exclusive);
  if (options.symmetry > 0 && rules.unknowns().pairs.empty()) {
    throw OptionError(Topic::no_pairs,
                      target.name + ": no two of its expressions are named as left and right");
  }
  if (known_exclusives(names, options.exclusive).empty() && options.exclusive != Exclusive::none) {
    throw OptionError(Topic::no_exclusives,
                      target.name +
                          ": none of its expressions are named as those of ARKit that exclude "
                          "each other");
  }
}

void check_soft_border(const Target& target, const SolveOptions& options) {
  if (options.outside != Outside::identity) return;
  if (!solves_for_vertices(target.model, options.space)) return;
  throw OptionError(Topic::soft_outside,
                    "triangles that keep their shape hold nothing, but a soft border ends where "
                    "vertices stay");
}

PlacedSource placed_at(const Target& target, const Source& source, Axes axes,
                       const Context& context) {
  PlacedSource placed{source, similarity_between(source.sequence->rest(), target, axes)};
  placed.source.sequence = carried(source.sequence, placed.similarity);
  for (RigidTransform& motion : placed.source.motion) motion = placed.similarity.carry(motion);
  if (placed.similarity.mirrors()) {
    context.note(target.name + ": is the source's mirror image; its motion is mirrored too");
  }
  return placed;
}

Selection selection_of(const Regions& regions) {
  Selection selection{regions.triangles, regions.inside};
  for (const Region& region : regions.regions) selection.regions.push_back(region.vertices);
  return selection;
}

Selection whole(const FrameSource& sequence) {
  return {all_triangles(sequence.triangles()), {}};
}

Selection selection_of(const Regions& regions, const Target& target) {
  if (!target.pairing) return selection_of(regions);
  const Pairing& pairing = *target.pairing;
  const Triangles& triangles = target.model.get().triangles();
  Selection selection{
      pairing.with_gaps(triangles_over(pairing.triangles(), regions.triangles), triangles),
      pairing.over(regions.inside), regions_over(pairing, regions)};
  // Vertices without carriers are inside if all of their triangles are in L.
  std::vector<bool> in_l(triangles.rows(), false), leaves(pairing.target_vertices(), false);
  for (const int t : selection.triangles) in_l[t] = true;
  std::vector<bool> is_used(pairing.target_vertices(), false);
  for (int t = 0; t < triangles.rows(); ++t) {
    for (const VertexIndex v : triangles.row(t)) {
      is_used[v] = true;
      if (!in_l[t]) leaves[v] = true;
    }
  }
  for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
    if (pairing.carriers(v).empty()) selection.inside[v] = is_used[v] && !leaves[v];
  }
  return selection;
}

Selection whole(const Target& target) {
  return {all_triangles(target.model.get().triangles()), {}};
}

std::vector<std::vector<VertexIndex>> regions_over(const Pairing& pairing, const Regions& regions) {
  std::vector<std::vector<VertexIndex>> lists;
  for (const Region& region : regions.regions) {
    std::vector<bool> held(pairing.source_vertices(), false);
    for (const VertexIndex v : region.vertices) held[v] = true;
    const std::vector<bool> over = pairing.over(held);
    std::vector<VertexIndex>& list = lists.emplace_back();
    for (VertexIndex v = 0; v < pairing.target_vertices(); ++v) {
      if (over[v]) list.push_back(v);
    }
  }
  return lists;
}

std::vector<FollowingPart> described(const FollowingParts& following,
                                     const std::vector<double>& farthest,
                                     const BlendshapeModel& model) {
  const auto lists = following.parts();
  if (lists.empty()) return {};
  const SurfaceParts parts = surface_parts(model.neutral(), model.triangles());
  std::vector<FollowingPart> list;
  for (std::size_t p = 0; p < lists.size(); ++p) {
    list.push_back(
        {parts.of_vertex[lists[p].front()], static_cast<int>(lists[p].size()), farthest[p]});
  }
  std::ranges::sort(list, {}, &FollowingPart::component);
  return list;
}

void TargetNotes::add(const std::string& text, Topic topic) const {
  context_.note(start_ + text, topic);
}

void TargetNotes::add(const BlendshapeConditions& conditions) const {
  if (!conditions.unseen.empty()) {
    add(std::to_string(conditions.unseen.size()) +
        " expressions do not move in the regions and stay 0: " + listed(conditions.unseen));
  }
  if (!conditions.weakly_seen.empty()) {
    add(std::to_string(conditions.weakly_seen.size()) +
        " expressions are weakly seen in the regions: " + listed(conditions.weakly_seen));
  }
  if (conditions.condition > kPoorCondition) {
    add("the regions hardly tell the expressions apart (condition number " +
            readable(conditions.condition, 2) + ")",
        Topic::poor_condition);
  }
}

void TargetNotes::add(const std::vector<FollowingPart>& parts) const {
  if (parts.empty()) return;
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const FollowingPart& part : parts) {
    names.push_back("component:" + std::to_string(part.component) + " by up to " +
                    readable(part.farthest));
  }
  const bool one = parts.size() == 1;
  add(std::to_string(parts.size()) +
      (one ? " part without a partner in the source follows"
           : " parts without a partner in the source follow") +
      " the surface around " + (one ? "it: " : "them: ") + listed(names));
}

void TargetNotes::add_almost_welded(const BlendshapeModel& model) const {
  if (const int places = almost_welded_vertices(model.neutral(), model.triangles())) {
    add(described_almost_welded(places));
  }
}

void TargetNotes::add_unmoved(const Connectivity& connectivity) const {
  const std::vector<VertexIndex> used =
      used_vertices(connectivity.triangles, connectivity.vertices);
  const std::size_t unmoved = static_cast<std::size_t>(connectivity.vertices) - used.size();
  if (unmoved == 0) return;
  VertexIndex first = 0;
  while (static_cast<std::size_t>(first) < used.size() && used[first] == first) ++first;
  add(std::to_string(unmoved) + " vertices of no triangle, the first is vertex " +
      std::to_string(first) + ", stay where they are at rest");
}

void TargetNotes::add_degenerate(const Degenerate& triangles) const {
  if (triangles.collapsed > 0) {
    add(std::to_string(triangles.collapsed) +
        " triangles between vertices that a seam makes one take no part");
  }
  if (triangles.source > 0) {
    add(std::to_string(triangles.source) +
        " slivers of the source, triangles of hardly any area, take their neighbours' "
        "deformation");
  }
  if (triangles.target > 0) {
    add(std::to_string(triangles.target) + " slivers of the target, triangles of hardly any area");
  }
}

const Eigen::MatrixXd& Solution::weights() const {
  static const Eigen::MatrixXd none;
  if (regional) return regional->weights();
  return animation ? animation->weights() : none;
}

std::vector<std::string> Solution::weight_names() const {
  if (animation) return animation->model().expressions().names;
  std::vector<std::string> names;
  if (!regional) return names;
  const Eigen::Index regions = regional->shares().cols();
  for (Eigen::Index r = 0; r < regions; ++r) {
    const std::string region = r + 1 < regions ? std::to_string(r) : "background";
    for (const std::string& name : regional->model().expressions().names) {
      names.push_back(name + "@" + region);
    }
  }
  return names;
}

Weld closed_seams_of(const Source& source, const Target& target, const Context& context) {
  const FrameSource& performance = *source.sequence;
  const BlendshapeModel& model = target.model;
  return target.pairing ? closed_seams(performance, model.neutral(), model.triangles(),
                                       *target.pairing, context)
                        : closed_seams(performance, model.neutral(), context);
}

namespace {

/// Progress at which the search for seams ends (it reads every frame), and at which the solve ends
/// if smoothing follows.
constexpr double kSeamShare = 0.2;
constexpr double kUnsmoothedShare = 0.9;

/// Share of the solve for the whole face, before the weights of each region.
constexpr double kGlobalShare = 0.2;

EdgeSum edges_of(const SolveOptions& options) {
  return options.edges.value_or(EdgeSum::all);
}

/// Share of each region at the target's vertices.
RegionShares shares_on(const BlendshapeModel& model,
                       const std::vector<std::vector<VertexIndex>>& regions,
                       const SolveOptions& options, const Context& context) {
  const SurfaceDistances distances =
      distances_along(model.neutral(), model.triangles(),
                      options.distances.value_or(DistanceOptions()), context.quiet());
  const Length falloff = options.falloff.value_or(SolveOptions::kUsualFalloff);
  std::vector<VertexIndex> inside;
  for (const std::vector<VertexIndex>& region : regions) {
    inside.insert(inside.end(), region.begin(), region.end());
  }
  return partition_of_unity(
      model.triangles(), distances.weld(), regions,
      falloff.in(diameter_of_parts(model.neutral(), model.triangles(), inside)),
      [&distances](std::span<const VertexIndex> sources) {
        return distances.from_nearest(sources);
      });
}

void note_empty_regions(const std::vector<std::vector<VertexIndex>>& regions,
                        const std::string& name, const Context& context) {
  std::vector<int> empty;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (regions[k].empty()) empty.push_back(static_cast<int>(k));
  }
  if (empty.empty()) return;
  context.note(name + ": " + (empty.size() > 1 ? "regions " : "region ") +
               joined(words_of(empty), ", ", " and ") +
               " of the source lie on no vertex here; their weights are those of the "
               "whole face");
}

/// Solves for the weights of the selection's regions and of the surface around them, on all
/// triangles. `global` are the weights of the whole face (F x D).
Solution solve_regions(const FrameSource& performance, const Target& target,
                       const Selection& selection, const Eigen::MatrixXd& global,
                       const SolveOptions& options, const Context& context) {
  const BlendshapeModel& model = target.model;
  note_empty_regions(selection.regions, target.name, context);
  RegionShares shares = shares_on(model, selection.regions, options, context);
  const LocalWeights local(
      performance.rest(), model, shares, all_triangles(model.triangles()),
      {.ridge = options.region_ridge, .edges = edges_of(options), .pairing = target.pairing},
      context.part(0, 0));
  RegionalWeights found = local.weights(performance, global, context);
  Solution solution;
  solution.regional = std::make_shared<const RegionalAnimation>(
      std::make_shared<const BlendshapeModel>(model), std::move(shares), std::move(found.beta),
      performance.known_times());
  solution.sequence = solution.regional;
  solution.violation = found.violation;
  return solution;
}

Solution solve_blendshapes(const Source& source, const Target& target, const Selection& selection,
                           const SolveOptions& options, const Context& context) {
  const Stopwatch stopwatch;
  const BlendshapeModel& model = target.model;
  BlendshapeTransferOptions of_space{.edges = edges_of(options),
                                     .ridge = options.ridge,
                                     .sparsity = options.sparsity,
                                     .smoothness = options.smoothness,
                                     .symmetry = options.symmetry,
                                     .exclusive = options.exclusive,
                                     .rules = target.rules,
                                     .pairing = target.pairing};
  const bool is_soft = selection.weights.size() > 0;
  if (is_soft) of_space.triangle_weights = triangle_weights(model.triangles(), selection.weights);
  const FrameSource& performance = *source.sequence;
  const bool regional = options.per_region && !selection.regions.empty();
  const double global = regional ? kGlobalShare : 1;
  const BlendshapeTransfer transfer(performance.rest(), model,
                                    regional ? whole(target).triangles : selection.triangles,
                                    of_space, context.part(0, 0));
  const Eigen::MatrixXd beta = transfer.weights(performance, context.part(0, global));
  Solution solution;
  if (regional) {
    solution =
        solve_regions(performance, target, selection, beta, options, context.part(global, 1));
  } else {
    solution.animation = std::make_shared<const Animation>(
        std::make_shared<const BlendshapeModel>(is_soft ? faded(model, selection.weights) : model),
        beta, performance.known_times());
    solution.sequence = solution.animation;
  }
  solution.seconds = stopwatch.seconds();
  solution.conditions = transfer.conditions();
  solution.degenerate_source_triangles = solution.conditions.degenerate_source_triangles;
  solution.degenerate_target_triangles = solution.conditions.degenerate_target_triangles;
  const TargetNotes notes(target.name, context);
  notes.add(solution.conditions);
  notes.add_degenerate({.source = solution.degenerate_source_triangles,
                        .target = solution.degenerate_target_triangles,
                        .collapsed = solution.collapsed_triangles});
  // Expressions of another face never match the source's exactly. Some want to be negative even
  // with an exact neutral, so a known neutral is not doubted.
  const bool may_be_wrong = !source.neutral_is_known;
  if (may_be_wrong && transfer.rest_looks_unneutral(performance, beta, context.part(1, 1))) {
    notes.add(
        "many expressions want to be negative, so the source's rest pose is likely not its "
        "neutral",
        Topic::unneutral_rest);
  }
  return solution;
}

void check_anchor(const SolveOptions& options, const Target& target, const Selection& selection) {
  if (!options.anchor) return;
  const BlendshapeModel& model = target.model;
  const bool is_vertex = *options.anchor == Anchor::vertex;
  const std::string vertex = "vertex " + std::to_string(options.anchor_vertex);
  if (is_vertex && options.anchor_vertex >= model.vertices()) {
    throw OptionError(Topic::anchor_vertex,
                      vertex + ", the mesh has " + std::to_string(model.vertices()) + " (0-based)");
  }
  if (is_vertex && target.pairing) {
    const FollowingParts following(model.neutral(), model.triangles(), Weld::exact(model.neutral()),
                                   *target.pairing);
    if (following.without_motion()[options.anchor_vertex]) {
      throw OptionError(Topic::anchor_vertex,
                        vertex +
                            " is on a part without a partner in the source; name a vertex of the "
                            "face");
    }
  }
  if (selection.weights.size() > 0) {
    if (selection.weights.minCoeff() > 0) return;
    throw OptionError(Topic::anchor_and_weights, "vertices of weight 0 are fixed already");
  }
  const bool all = selection.triangles.size() == static_cast<std::size_t>(model.triangles().rows());
  if (options.outside == Outside::fixed && !all) {
    throw OptionError(Topic::held_anchor, "vertices outside the regions are fixed already");
  }
}

/// Throws for weights of a selection that are invalid, or that other options contradict.
void check_weights_of(const Selection& selection, const Target& target,
                      const SolveOptions& options) {
  if (selection.weights.size() == 0) return;
  check_weights(selection.weights, target.model.get().vertices());
  if (options.per_region) {
    throw std::invalid_argument(
        "per_region: weights of each region fade by the falloff; a selection has none beside");
  }
  check_soft_border(target, options);
}

/// Passes poses on and records how far each part that follows moves.
class WatchedSink : public FrameSink {
 public:
  WatchedSink(FrameSink& sink, const FollowingParts& following)
      : sink_(sink), following_(following), farthest_(following.parts().size(), 0) {}

  void write(int first, const Frames& poses) override {
    const std::vector<double> moves = following_.farthest(poses);
    {
      const std::scoped_lock lock(mutex_);
      for (std::size_t p = 0; p < moves.size(); ++p) {
        farthest_[p] = std::max(farthest_[p], moves[p]);
      }
    }
    sink_.write(first, poses);
  }
  std::vector<std::filesystem::path> commit() override { return sink_.commit(); }

  const std::vector<double>& farthest() const { return farthest_; }

 private:
  FrameSink& sink_;
  const FollowingParts& following_;
  std::mutex mutex_;
  std::vector<double> farthest_;
};

Solution solve_vertices(const Source& source, const Target& target, const Selection& selection,
                        const SolveOptions& options, const Context& context) {
  const Stopwatch stopwatch;
  const BlendshapeModel& model = target.model;
  check_anchor(options, target, selection);
  const FrameSource& performance = *source.sequence;
  VertexTransferOptions of_space{
      .triangle_weight = options.triangle_weight,
      .outside = options.outside,
      .inside = selection.inside,
      .weights = selection.weights,
      .weld = closed_seams_of(source, target, context.part(0, kSeamShare).without_ranks()),
      .pairing = target.pairing,
      .outside_weight = options.outside_weight,
      .outside_smoothness = options.outside_smoothness,
      .anchor = options.anchor,
      .anchor_vertex = options.anchor_vertex};
  if (target.pairing) {
    of_space.following = std::make_shared<FollowingParts>(model.neutral(), model.triangles(),
                                                          of_space.weld, *target.pairing);
  }
  const bool smooths = options.smoothness > 0;
  const double solved = smooths ? kUnsmoothedShare : 1;
  const Context solving = context.part(kSeamShare, solved);
  const VertexTransfer transfer(performance.rest(), model.neutral(), model.triangles(),
                                selection.triangles, of_space, solving.part(0, 0));
  const auto store = std::make_shared<FrameStore>(
      SequenceHeader{model.shared_connectivity(), performance.times(), model.neutral(), true,
                     performance.times_are_known()});
  std::optional<WatchedSink> watched;
  if (of_space.following) watched.emplace(*store, *of_space.following);
  FrameSink& sink = watched ? static_cast<FrameSink&>(*watched) : *store;
  if (smooths) {
    const MotionFilter filter(performance.times(), options.smoothness);
    sink.write(
        0, filter(transfer.frames(performance, solving), context.part(solved, 1).without_ranks()));
  } else {
    transfer.write_frames(performance, sink, solving);
  }
  sink.commit();
  Solution solution;
  solution.sequence = store;
  solution.seconds = stopwatch.seconds();
  solution.collapsed_triangles = transfer.collapsed_triangles();
  solution.degenerate_source_triangles = transfer.degenerate_source_triangles();
  solution.degenerate_target_triangles = transfer.degenerate_target_triangles();
  if (watched) {
    solution.following_parts = described(*of_space.following, watched->farthest(), model);
  }
  const TargetNotes notes(target.name, context);
  notes.add(solution.following_parts);
  notes.add_almost_welded(model);
  notes.add_unmoved(model.connectivity());
  notes.add_degenerate({.source = solution.degenerate_source_triangles,
                        .target = solution.degenerate_target_triangles,
                        .collapsed = solution.collapsed_triangles});
  return solution;
}

}  // namespace

Solution solve(const Source& source, const Target& target, const Selection& selection,
               const SolveOptions& options, const Context& context) {
  check_options(options);
  const BlendshapeModel& model = target.model;
  if (options.space == Space::blendshape && model.expressions().size() == 0) {
    throw OptionError(Topic::no_expressions, target.name + ": has no expressions");
  }
  check_rules(target, options);
  check_weights_of(selection, target, options);
  return solves_for_vertices(model, options.space)
             ? solve_vertices(source, target, selection, options, context)
             : solve_blendshapes(source, target, selection, options, context);
}

}  // namespace mimetra
