#include "toolkit/regions/carried_regions.h"

#include <stdexcept>
#include <string>
#include <utility>

namespace mimetra {

Regions carried_regions(const Regions& regions, const Simplification& simplified,
                        Eigen::VectorXd vertex_energy, const Triangles& triangles,
                        const DistanceFunction& distances, const std::vector<bool>& inside) {
  if (regions.vertices != static_cast<int>(simplified.vertices.size())) {
    throw std::invalid_argument("regions of " + std::to_string(regions.vertices) +
                                " vertices, expected " +
                                std::to_string(simplified.vertices.size()) + " that were kept");
  }
  const auto vertices = static_cast<VertexIndex>(vertex_energy.size());
  std::vector<Region> carried = regions.regions;
  for (Region& region : carried) {
    if (region.center < 0) throw std::invalid_argument("a region has no centre to carry it by");
    region.center = simplified.vertices[static_cast<std::size_t>(region.center)];
    const Eigen::MatrixXd away = distances(std::span(&region.center, 1));
    region.vertices.clear();
    for (VertexIndex v = 0; v < vertices; ++v) {
      const bool may_be_in = inside.empty() || inside[static_cast<std::size_t>(v)];
      if (may_be_in && away(v, 0) <= region.radius) region.vertices.push_back(v);
    }
  }
  Regions empty;
  empty.vertices = vertices;
  empty.vertex_energy = std::move(vertex_energy);
  empty.notes = regions.notes;
  return with_added(empty, std::move(carried), triangles);
}

}  // namespace mimetra
