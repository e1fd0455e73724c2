#include "toolkit/pipeline/solution.h"

#include <algorithm>
#include <mutex>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/frame_store.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/model/animation.h"
#include "toolkit/model/motion_filter.h"
#include "toolkit/pipeline/regional_solution.h"
#include "toolkit/transfer/following_parts.h"
#include "toolkit/transfer/seams.h"
#include "toolkit/transfer/soft_border.h"

namespace mimetra {

namespace {

/// Looking for seams, which reads every frame, as a part of a solve's progress; and until poses are
/// solved for that are smoothed afterwards.
constexpr double kSeamShare = 0.2;
constexpr double kUnsmoothedShare = 0.9;

/// The weights of the whole face, as a part of those of each region.
constexpr double kGlobalShare = 0.2;

EdgeSum edges_of(const SolveOptions& options) {
  return options.edges.value_or(EdgeSum::all);
}

RegionalOptions regional_options(const Target& target, const SolveOptions& options) {
  return {target.name,
          options.falloff.value_or(SolveOptions::kUsualFalloff),
          options.distances.value_or(DistanceOptions()),
          {.ridge = options.region_ridge, .edges = edges_of(options), .pairing = target.pairing}};
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
    RegionalSolution local =
        solve_regions(performance, model, selection.regions, beta,
                      regional_options(target, options), context.part(global, 1));
    solution.violation = local.violation;
    solution.regional = std::move(local.animation);
    solution.sequence = solution.regional;
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
  // Another face's expressions are never quite the source's: with an exact neutral, too, some want
  // to be negative.
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

/// Throws for weights of a selection that are none, or that other options contradict.
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

/// Hands poses on and keeps how far each part that follows moves.
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

bool solves_for_vertices(const BlendshapeModel& target, Space space) {
  return space == Space::vertex || target.expressions().size() == 0;
}

void check_soft_border(const Target& target, const SolveOptions& options) {
  if (options.outside != Outside::identity) return;
  if (!solves_for_vertices(target.model, options.space)) return;
  throw OptionError(Topic::soft_outside,
                    "triangles that keep their shape hold nothing, but a soft border ends where "
                    "vertices stay");
}

namespace {

/// Throws std::invalid_argument where such weights cannot be found as the options say.
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

}  // namespace

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

Selection selection_of(const Regions& regions, const Target& target) {
  if (!target.pairing) return selection_of(regions);
  const Pairing& pairing = *target.pairing;
  const Triangles& triangles = target.model.get().triangles();
  Selection selection{
      pairing.with_gaps(triangles_over(pairing.triangles(), regions.triangles), triangles),
      pairing.over(regions.inside), regions_over(pairing, regions)};
  // Vertices without carriers are inside where all of their triangles are in L.
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

Weld closed_seams_of(const Source& source, const Target& target, const Context& context) {
  const FrameSource& performance = *source.sequence;
  const BlendshapeModel& model = target.model;
  return target.pairing ? closed_seams(performance, model.neutral(), model.triangles(),
                                       *target.pairing, context)
                        : closed_seams(performance, model.neutral(), context);
}

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
