#include "toolkit/pipeline/region_choice.h"

#include "toolkit/mesh/diameter.h"

namespace mimetra {

Regions choose_regions(const Analysis& analysis, const RegionChoiceOptions& options) {
  check_options(options);
  RegionOptions of_search = options.regions;
  of_search.radius = options.radius.in(diameter(analysis.components.rest));
  of_search.distances = analysis.distances;
  Regions regions = find_regions(analysis.components, of_search);
  for (const std::string& text : regions.notes) note(options.notes, text);
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
  return {regions.triangles, regions.inside};
}

Selection whole(const FrameSource& sequence) {
  return {all_triangles(sequence.triangles()), {}};
}

}  // namespace mimetra
