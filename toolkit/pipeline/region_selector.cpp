#include "toolkit/pipeline/region_selector.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "toolkit/mesh/text.h"
#include "toolkit/pipeline/moving_parts.h"
#include "toolkit/regions/farthest_discs.h"

namespace mimetra {

namespace {

/// Solving for the weights by all triangles, as a part of the work.
constexpr double kFullShare = 0.2;

/// Of RegionSelectionOptions, for regions that serve other identities too: chosen on one at a fifth
/// of the triangles, five others lose 0.4 to 1.2 % with 30, 0.4 to 1.9 % with 10, 0.3 to 2.2 % with
/// 100.
constexpr double kNoise = 30;

/// A share that is missed by more than this is worth a note: less than one disc as a rule.
constexpr double kMissedTriangles = 0.02;

/// At most so many frames in memory, evenly spread.
MeshSequence spread_frames(const std::shared_ptr<const FrameSource>& sequence, int most,
                           const Context& context) {
  const int frames = sequence->frames();
  const int count = std::min(frames, most);
  std::vector<int> chosen(count);
  for (int i = 0; i < count; ++i) {
    chosen[i] = static_cast<int>(std::int64_t{i} * frames / count);
  }
  return MeshSequence(*with_rest(selected(sequence, std::move(chosen)), sequence->rest()),
                      context.without_ranks());
}

Region region_of(const Disc& disc, double radius) {
  Region region;
  region.center = disc.center;
  region.radius = radius;
  region.vertices = disc.vertices;
  return region;
}

}  // namespace

SelectionBound selection_bound(const RegionChoiceOptions& options) {
  const double usual = options.discs ? 1 : RegionChoiceOptions::kUsualShare;
  return {options.triangles.value_or(usual), options.discs};
}

void check_selection(const Target& target, const RegionChoiceOptions& regions, Space space) {
  if (regions.select != Selector::transfer || !solves_for_vertices(target.model, space)) return;
  throw OptionError(Topic::no_selection,
                    target.name +
                        ": is solved for vertices, and regions are chosen for a "
                        "transfer by what they tell of expressions");
}

RegionSelector::RegionSelector(const Source& source, const RegionChoiceOptions& options,
                               const AnalysisOptions& analysis)
    : rest_(source.sequence->rest()),
      triangles_(source.sequence->triangles()),
      options_(options),
      of_distances_(analysis.distances) {
  check_options(options);
  options_.select = Selector::transfer;
  const MovingParts moving = moving_parts(source.moving, rest_, triangles_);
  radius_ = kDiscRadius * options.radius.in(moving.diameter);
  inside_ = analysis.inside;
  if (inside_.empty()) inside_ = moving.vertices;
}

const std::vector<Disc>& RegionSelector::candidates(const Context& context) {
  if (!candidates_.empty()) return candidates_;
  const SurfaceDistances distances = distances_along(rest_, triangles_, of_distances_, context);
  candidates_ =
      farthest_discs(rest_, triangles_,
                     [&](std::span<const VertexIndex> sources) { return distances.once(sources); },
                     {.radius = radius_, .count = kCandidates, .inside = inside_});
  return candidates_;
}

Regions RegionSelector::operator()(const Source& source, const Target& target,
                                   const SolveOptions& options, const Context& context) {
  const SelectionBound bound = selection_bound(options_);
  Regions regions = std::move(within({&bound, 1}, source, target, options, context).front());
  const bool is_capped = bound.count && static_cast<int>(regions.regions.size()) == *bound.count;
  if (!is_capped && regions.triangle_share() < bound.share - kMissedTriangles) {
    context.note(target.name + ": the " + std::to_string(regions.regions.size()) +
                     " regions that serve the transfer hold " + percent(regions.triangle_share()) +
                     " of the triangles, " + percent(bound.share) + " were allowed",
                 Topic::few_discs);
  }
  return regions;
}

std::vector<Regions> RegionSelector::within(std::span<const SelectionBound> bounds,
                                            const Source& source, const Target& target,
                                            const SolveOptions& options, const Context& context) {
  check_selection(target, options_, options.space);
  const MeshSequence frames = spread_frames(source.sequence, kMostFrames, context.part(0, 0));
  const RegionSelection selection(
      frames, target.model,
      {.noise = kNoise, .edges = options.edges.value_or(EdgeSum::all), .pairing = target.pairing},
      context.part(0, kFullShare));
  Regions none;
  none.vertices = static_cast<int>(rest_.rows());
  none.all_triangles = static_cast<int>(triangles_.rows());
  none.vertex_energy = motion_on_vertices(frames, {}, context.part(kFullShare, kFullShare));
  std::vector<Regions> result;
  for (const SelectionBound& bound : bounds) {
    std::vector<Region> chosen;
    for (const int disc :
         selection.choose(candidates(context), bound, context.part(kFullShare, 1))) {
      chosen.push_back(region_of(candidates_[disc], radius_));
    }
    if (chosen.empty()) refuse_bound(bound.share, "no disc of the surface is so small");
    result.push_back(with_added(none, std::move(chosen), triangles_));
  }
  return result;
}

}  // namespace mimetra
