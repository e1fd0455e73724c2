#include "toolkit/pipeline/regional_solution.h"

#include <algorithm>
#include <stdexcept>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/text.h"
#include "toolkit/regions/partition.h"

namespace mimetra {

namespace {

/// How much each region counts at the target's vertices.
RegionShares shares_on(const Target& target, const Selection& selection,
                       const SolveOptions& options) {
  const BlendshapeModel& model = target.model;
  DistanceOptions of_distances = options.distances;
  of_distances.threads = options.threads;
  const SurfaceDistances distances =
      distances_along(model.neutral(), model.triangles(), of_distances);
  return partition_of_unity(model.triangles(), distances.weld(), selection.regions,
                            options.falloff.in(diameter(model.neutral())),
                            [&distances](std::span<const VertexIndex> sources) {
                              return distances.from_nearest(sources);
                            });
}

void note_empty_regions(const Target& target, const Selection& selection, const Notes& notes) {
  std::vector<int> empty;
  for (std::size_t k = 0; k < selection.regions.size(); ++k) {
    if (selection.regions[k].empty()) empty.push_back(static_cast<int>(k));
  }
  if (empty.empty()) return;
  note(notes, target.name + ": " + (empty.size() > 1 ? "regions " : "region ") +
                  joined(words_of(empty), ", ", " and ") +
                  " of the source lie on no vertex here; their weights are those of the whole "
                  "face");
}

}  // namespace

void check_regional(const Target& target, const SolveOptions& options) {
  if (solves_for_vertices(target.model, options.space)) {
    throw std::invalid_argument("per_region: " + target.name +
                                " is solved for vertices, which have no weights");
  }
  if (options.blendshape.smoothness > 0) {
    throw std::invalid_argument(
        "smoothness: weights of each region are found frame by frame; it must be 0");
  }
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

void add_regional_weights(Solution& solution, const FrameSource& performance, const Target& target,
                          const Selection& selection, const Eigen::MatrixXd& global,
                          const SolveOptions& options) {
  note_empty_regions(target, selection, options.notes);
  const BlendshapeModel& model = target.model;
  LocalWeightsOptions of_local = options.local;
  of_local.edges = options.edges;
  of_local.pairing = target.pairing;
  of_local.threads = options.threads;
  of_local.progress = options.progress;
  RegionShares shares = shares_on(target, selection, options);
  const LocalWeights local(performance.rest(), model, shares, whole(target).triangles, of_local);
  RegionalWeights found = local.weights(performance, global);
  solution.violation = found.violation;
  solution.regional = std::make_shared<const RegionalAnimation>(
      std::make_shared<const BlendshapeModel>(model), std::move(shares), std::move(found.beta),
      performance.known_times());
  solution.sequence = solution.regional;
}

}  // namespace mimetra
