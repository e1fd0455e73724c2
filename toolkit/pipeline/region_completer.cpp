#include "toolkit/pipeline/region_completer.h"

#include <algorithm>
#include <utility>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Radius of added discs, as a share of that of the regions.
constexpr double kAddedRadius = 0.5;

/// Makes the distances when they are asked for.
DistanceFunction distances_when_needed(const Positions& rest, const Triangles& triangles,
                                       const DistanceOptions& options) {
  return [=, made = std::make_shared<std::optional<SurfaceDistances>>()](
             std::span<const VertexIndex> sources) {
    if (!*made) *made = distances_along(rest, triangles, options);
    return (**made).once(sources);
  };
}

/// What each disc was added for, once.
std::vector<std::string> reasons(const CompletedRegions& completed) {
  std::vector<std::string> names;
  for (const Region& region : std::span(completed.regions.regions).last(completed.added)) {
    if (std::ranges::find(names, region.added_for) == names.end()) {
      names.push_back(region.added_for);
    }
  }
  return names;
}

}  // namespace

RegionCompleter::RegionCompleter(Positions rest, Triangles triangles,
                                 const RegionChoiceOptions& options,
                                 const AnalysisOptions& analysis)
    : rest_(std::move(rest)),
      triangles_(std::move(triangles)),
      options_(options),
      inside_(analysis.inside) {
  DistanceOptions distances = analysis.distances;
  distances.threads = analysis.threads;
  distances.notes = analysis.notes;
  distances_ = distances_when_needed(rest_, triangles_, distances);
}

RegionCompleter::RegionCompleter(const Analysis& analysis, const RegionChoiceOptions& options)
    : rest_(analysis.components.rest),
      triangles_(analysis.components.triangles),
      options_(options),
      inside_(analysis.inside),
      distances_([distances = analysis.distances](std::span<const VertexIndex> sources) {
        return distances.once(sources);
      }) {}

Regions RegionCompleter::operator()(const Regions& regions, const Target& target,
                                    const SolveOptions& options) {
  if (options.per_region || solves_for_vertices(target.model, options.space)) return regions;
  if (!search_) {
    search_.emplace(rest_, triangles_, distances_,
                    kAddedRadius * options_.radius.in(diameter(rest_)), inside_);
  }
  CompletionOptions of_completion = options_.completion;
  of_completion.edges = options.edges;
  of_completion.pairing = target.pairing;
  CompletedRegions completed = mimetra::completed(regions, target.model, *search_, of_completion);
  if (completed.added > 0) {
    const double share = completed.regions.triangle_share() - regions.triangle_share();
    note(options_.notes,
         target.name + ": " + std::to_string(completed.added) + " discs, " + percent(share) +
             " of the triangles, were added to the regions, which hardly see " +
             listed(reasons(completed)),
         Topic::completed_regions);
  }
  if (completed.limited) {
    note(options_.notes,
         target.name + ": no more than " + percent(of_completion.limit) +
             " of the triangles are added to the regions, which leaves expressions that are "
             "hardly seen",
         Topic::completion_limit);
  }
  return std::move(completed.regions);
}

}  // namespace mimetra
