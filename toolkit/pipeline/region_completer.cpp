#include "toolkit/pipeline/region_completer.h"

#include <algorithm>
#include <utility>

#include "toolkit/mesh/near_tie.h"
#include "toolkit/mesh/text.h"
#include "toolkit/pipeline/moving_parts.h"

namespace mimetra {

namespace {

/// Radius of added discs, as a share of that of the regions.
constexpr double kAddedRadius = 0.5;

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

RegionCompleter::RegionCompleter(const Source& source, const RegionChoiceOptions& options,
                                 const AnalysisOptions& analysis)
    : rest_(source.sequence->rest()),
      triangles_(source.sequence->triangles()),
      options_(options),
      radius_(kAddedRadius *
              options.radius.in(moving_parts(source.moving, rest_, triangles_).diameter)),
      inside_(analysis.inside),
      of_distances_(analysis.distances) {}

RegionCompleter::RegionCompleter(const Analysis& analysis, const RegionChoiceOptions& options)
    : rest_(analysis.components.rest),
      triangles_(analysis.components.triangles),
      options_(options),
      radius_(kAddedRadius * options.radius.in(analysis.size)),
      inside_(analysis.inside),
      distances_([distances = analysis.distances](std::span<const VertexIndex> sources) {
        return distances.once(sources);
      }) {}

CompletedRegions RegionCompleter::completed_within(double bound, const Regions& regions,
                                                   const Target& target,
                                                   const CompletionOptions& options) {
  const auto with = [&](int count, const CompletionOptions& of_completion) {
    return completed(strongest(regions, count, triangles_), target.model, *search_, of_completion);
  };
  const auto fits = [bound](const CompletedRegions& made) {
    return made.regions.triangle_share() <= (1 + kNearTie) * bound;
  };
  for (auto count = static_cast<int>(regions.regions.size()); count > 0; --count) {
    CompletedRegions made = with(count, options);
    if (fits(made)) return made;
  }
  // The strongest region, and as many discs as fit beside it.
  CompletionOptions what_fits = options;
  what_fits.limit = std::max(0.0, bound - strongest(regions, 1, triangles_).triangle_share());
  CompletedRegions made = with(1, what_fits);
  if (fits(made)) return made;
  // Discs that are counted on the target may hold more of the source.
  what_fits.share = 0;
  made = with(1, what_fits);
  made.limited = true;
  return made;
}

Regions RegionCompleter::operator()(const Regions& regions, const Target& target,
                                    const SolveOptions& options, const Context& context) {
  const bool is_soft = regions.weights.size() > 0;
  if (is_soft || options.per_region || solves_for_vertices(target.model, options.space))
    return regions;
  if (!search_) {
    if (!distances_) {
      distances_ =
          [rest = rest_, triangles = triangles_, how = of_distances_, context,
           made = std::optional<SurfaceDistances>()](std::span<const VertexIndex> sources) mutable {
            if (!made) made = distances_along(rest, triangles, how, context);
            return made->once(sources);
          };
    }
    search_.emplace(rest_, triangles_, distances_, radius_, inside_);
  }
  const CompletionOptions of_completion{.share = options_.complete,
                                        .limit = options_.complete_limit,
                                        .edges = options.edges.value_or(EdgeSum::all),
                                        .pairing = target.pairing};
  const CompletedRegions completed =
      options_.triangles ? completed_within(*options_.triangles, regions, target, of_completion)
                         : mimetra::completed(regions, target.model, *search_, of_completion);
  if (completed.added > 0) {
    const std::size_t kept = completed.regions.regions.size() - completed.added;
    const Regions before = strongest(regions, static_cast<int>(kept), triangles_);
    const double share = completed.regions.triangle_share() - before.triangle_share();
    const std::size_t left_out = regions.regions.size() - kept;
    context.note(
        target.name + ": " + std::to_string(completed.added) +
            (completed.added == 1 ? " disc was" : " discs were") + " added to the regions (" +
            percent(share) + " of the triangles), which hardly see " + listed(reasons(completed)) +
            (left_out > 0 ? "; the " + std::to_string(left_out) + " weakest regions made room"
                          : ""),
        Topic::completed_regions);
  }
  if (completed.limited) {
    context.note(
        target.name + ": no more than " + percent(of_completion.limit) +
            " of the triangles are added to the regions" +
            (options_.triangles ? ", and no more than " + percent(*options_.triangles) + " taken"
                                : "") +
            ", which leaves expressions that are hardly seen",
        options_.triangles ? Topic::discs_beyond_bound : Topic::completion_limit);
  }
  return completed.regions;
}

}  // namespace mimetra
