#include "toolkit/pipeline/region_choice.h"

#include <set>

#include "toolkit/mesh/rims.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Vertices where no region is made: those near rims, unless no component moves another vertex
/// most.
std::vector<bool> rims_to_avoid(const Analysis& analysis, const RegionChoiceOptions& options,
                                const Context& context) {
  if (!options.drop_rims) return {};
  const Components& components = analysis.components;
  std::vector<bool> near =
      near_rims(components.rest, components.triangles, weld_of(components.rest, analysis.welding));
  int there = 0, elsewhere = 0;
  for (const VertexIndex center : components.centers) {
    if (center >= 0) ++(near[center] ? there : elsewhere);
  }
  if (there == 0) return {};
  if (elsewhere == 0) {
    context.note("every component moves the rim of the surface most: its regions are kept");
    return {};
  }
  context.note(std::to_string(there) + (there == 1 ? " component moves" : " components move") +
               " the rim of the surface most and " + (there == 1 ? "gives" : "give") +
               " no region");
  return near;
}

/// Notes regions on parts of less than kSmallPart of the surface, also in the regions' own notes.
void note_small_parts(Regions& regions, const Context& context) {
  int count = 0;
  std::set<int> parts;
  for (const Region& region : regions.regions) {
    if (region.surface_part < 0 || region.surface_share >= kSmallPart) continue;
    ++count;
    parts.insert(region.surface_part);
  }
  if (count == 0) return;
  const bool one = count == 1;
  regions.notes.push_back(std::to_string(count) + " of " + std::to_string(regions.regions.size()) +
                          (one ? " regions lies" : " regions lie") +
                          " on connected parts of less than " + readable(100 * kSmallPart) +
                          " % of the surface: component " +
                          joined(words_of({parts.begin(), parts.end()}), ", ", " and "));
  context.note(regions.notes.back(), Topic::small_parts);
}

}  // namespace

void note_large_regions(const Regions& regions, const RegionChoiceOptions& options, double size,
                        const Triangles& triangles, const Context& context) {
  constexpr double kMost = 0.5;
  if (options.radius.absolute || options.shape != RegionShape::disc) return;
  const auto most = static_cast<std::size_t>(
      kMost * static_cast<double>(used_vertices(triangles, regions.vertices).size()));
  const auto is_large = [most](const Region& region) { return region.vertices.size() > most; };
  const auto count = std::ranges::count_if(regions.regions, is_large);
  if (count == 0) return;
  context.note(std::to_string(count) + " of " + std::to_string(regions.regions.size()) +
                   " regions hold more than half of the mesh each: their radius is " +
                   readable(options.radius.in(size)) + ", " + percent(options.radius.value) +
                   " of the diameter of what moves, " + readable(size),
               Topic::large_regions);
}

bool has_own_regions(const RegionChoiceOptions& options) {
  return options.select == Selector::transfer || (options.triangles && options.complete > 0);
}

void refuse_bound(double share, const std::string& reason) {
  throw OptionError(Topic::triangle_bound, percent(share) + " of the triangles: " + reason +
                                               "; allow more, or take "
                                               "smaller regions");
}

Regions choose_regions(const Analysis& analysis, const RegionChoiceOptions& options,
                       const Context& context) {
  check_options(options);
  Regions regions = find_regions(analysis.components,
                                 {.shape = options.shape,
                                  .radius = options.radius.in(analysis.size),
                                  .coverage = options.coverage,
                                  .inside = analysis.inside,
                                  .no_centers = rims_to_avoid(analysis, options, context),
                                  .distances = analysis.distances},
                                 context);
  if (regions.triangles.empty()) {
    throw MismatchError("no region is left: no component moves anything where regions may lie" +
                        std::string(analysis.inside.empty()
                                        ? ""
                                        : "; let them lie elsewhere (option 'only', option "
                                          "'without'), or decompose there"));
  }
  if (options.triangles) {
    const Triangles& triangles = analysis.components.triangles;
    const int count = regions_within(regions, *options.triangles, triangles);
    if (count == 0) refuse_bound(*options.triangles, "the strongest region holds more");
    regions = strongest(regions, count, triangles);
  }
  for (const std::string& text : regions.notes) context.note(text);
  note_small_parts(regions, context);
  note_large_regions(regions, options, analysis.size, analysis.components.triangles, context);
  return regions;
}

void check_regions(const GivenRegions& given, const FrameSource& sequence) {
  const Regions& regions = given.regions;
  const auto triangles = static_cast<int>(sequence.triangles().rows());
  if (regions.vertices != sequence.vertices() || regions.all_triangles != triangles) {
    throw MismatchError(given.name + ": regions of a mesh with " +
                        std::to_string(regions.vertices) + " vertices and " +
                        std::to_string(regions.all_triangles) + " triangles, expected " +
                        std::to_string(sequence.vertices()) + " and " + std::to_string(triangles) +
                        " as in the source");
  }
  if (regions.triangles.empty()) {
    throw MismatchError(given.name + ": its regions hold no triangle of the mesh; choose others");
  }
}

Selection selection_of(const Regions& regions) {
  Selection selection{regions.triangles, regions.inside};
  for (const Region& region : regions.regions) selection.regions.push_back(region.vertices);
  return selection;
}

Selection whole(const FrameSource& sequence) {
  return {all_triangles(sequence.triangles()), {}};
}

}  // namespace mimetra
