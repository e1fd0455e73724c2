#include "toolkit/pipeline/regional_solution.h"

#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/regions/partition.h"

namespace mimetra {

namespace {

/// How much each region counts at the target's vertices.
RegionShares shares_on(const BlendshapeModel& model,
                       const std::vector<std::vector<VertexIndex>>& regions,
                       const RegionalOptions& options, const Context& context) {
  const SurfaceDistances distances =
      distances_along(model.neutral(), model.triangles(), options.distances, context.quiet());
  std::vector<VertexIndex> inside;
  for (const std::vector<VertexIndex>& region : regions) {
    inside.insert(inside.end(), region.begin(), region.end());
  }
  return partition_of_unity(
      model.triangles(), distances.weld(), regions,
      options.falloff.in(diameter_of_parts(model.neutral(), model.triangles(), inside)),
      [&distances](std::span<const VertexIndex> sources) {
        return distances.from_nearest(sources);
      });
}

void note_empty_regions(const std::vector<std::vector<VertexIndex>>& regions,
                        const RegionalOptions& options, const Context& context) {
  std::vector<int> empty;
  for (std::size_t k = 0; k < regions.size(); ++k) {
    if (regions[k].empty()) empty.push_back(static_cast<int>(k));
  }
  if (empty.empty()) return;
  context.note(options.name + ": " + (empty.size() > 1 ? "regions " : "region ") +
               joined(words_of(empty), ", ", " and ") +
               " of the source lie on no vertex here; their weights are those of the "
               "whole face");
}

}  // namespace

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

RegionalSolution solve_regions(const FrameSource& performance, const BlendshapeModel& model,
                               const std::vector<std::vector<VertexIndex>>& regions,
                               const Eigen::MatrixXd& global, const RegionalOptions& options,
                               const Context& context) {
  note_empty_regions(regions, options, context);
  RegionShares shares = shares_on(model, regions, options, context);
  const LocalWeights local(performance.rest(), model, shares, all_triangles(model.triangles()),
                           options.local, context.part(0, 0));
  RegionalWeights found = local.weights(performance, global, context);
  return {std::make_shared<const RegionalAnimation>(std::make_shared<const BlendshapeModel>(model),
                                                    std::move(shares), std::move(found.beta),
                                                    performance.known_times()),
          found.violation};
}

}  // namespace mimetra
