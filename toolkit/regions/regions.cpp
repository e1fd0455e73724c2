#include "toolkit/regions/regions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/mesh/simplification.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

// Share of its component's energy in a region of RegionShape::support.
constexpr double kSupportShare = 0.95;

// Rounding of a sum of shares that should be 1, for millions of vertices.
constexpr double kSumRounding = 1e-9;

void require_valid(const RegionOptions& options) {
  if (options.radius && !(*options.radius > 0 && std::isfinite(*options.radius))) {
    throw std::invalid_argument("radius is " + std::to_string(*options.radius) +
                                "; it must be above 0");
  }
  check_options(options);
}

/// Throws unless there is one value per vertex, or none.
void require_size(const std::string& name, const std::vector<bool>& values, int vertices) {
  if (values.empty() || static_cast<int>(values.size()) == vertices) return;
  throw std::invalid_argument(name + ": " + std::to_string(values.size()) + " vertices, expected " +
                              std::to_string(vertices));
}

/// Components that move the same vertex most, strongest first, and the distances from that vertex.
struct Site {
  std::vector<int> components;
  VertexIndex center;
  double energy;
  Eigen::VectorXd distances;
};

/// Components that did not die, from the strongest to the weakest.
std::vector<int> living_components(const Components& components, const Eigen::VectorXd& energies) {
  std::vector<int> order;
  for (int k = 0; k < components.count(); ++k) {
    if (components.centers[k] >= 0) order.push_back(k);
  }
  std::ranges::stable_sort(order, [&](int a, int b) { return energies[a] > energies[b]; });
  return order;
}

/// One site per centre, strongest first. A centre at distance zero is the same point of the
/// surface, across a seam.
std::vector<Site> sites_of(const Components& components, const DistanceFunction& distances) {
  const Eigen::VectorXd energies = motion_energy(components);
  const std::vector<int> living = living_components(components, energies);
  std::vector<VertexIndex> centers;
  centers.reserve(living.size());
  for (const int k : living) centers.push_back(components.centers[k]);
  const Eigen::MatrixXd from_centers = distances(centers);
  std::vector<Site> sites;
  for (std::size_t i = 0; i < living.size(); ++i) {
    const int k = living[i];
    const auto same = std::ranges::find_if(sites, [center = centers[i]](const Site& site) {
      return site.center == center || site.distances[center] == 0;
    });
    if (same == sites.end()) {
      sites.push_back({{k}, centers[i], energies[k], from_centers.col(static_cast<int>(i))});
    } else {
      same->components.push_back(k);
      same->energy += energies[k];
    }
  }
  std::ranges::stable_sort(sites, [](const Site& a, const Site& b) { return a.energy > b.energy; });
  return sites;
}

std::vector<std::string> notes_on(const Components& components, const std::vector<Site>& sites) {
  std::vector<std::string> notes;
  std::vector<int> dead;
  for (int k = 0; k < components.count(); ++k) {
    if (components.centers[k] < 0) dead.push_back(k);
  }
  constexpr std::size_t kNamed = 8;
  if (!dead.empty()) {
    notes.push_back((dead.size() > 1 ? "components " : "component ") +
                    (dead.size() > kNamed ? listed(words_of(dead), kNamed)
                                          : joined(words_of(dead), ", ", " and ")) +
                    " died in the decomposition: no region");
  }
  std::string merged;
  for (const Site& site : sites) {
    if (site.components.size() == 1) continue;
    merged += (merged.empty() ? "" : "; ") + joined(words_of(site.components), ", ", " and ");
  }
  if (!merged.empty()) notes.push_back("components with the same centre share a region: " + merged);
  return notes;
}

/// Motion energy on each vertex of the sum of some components: sum over frames of |sum over k of
/// w_k c_k^(i)|^2 (N).
Eigen::VectorXd energy_on_vertices(const Components& components, const std::vector<int>& some) {
  fix_product_blocking();
  const Eigen::MatrixXd weights = components.weights(Eigen::all, some);
  const Eigen::MatrixXd gram = weights.transpose() * weights;
  Eigen::VectorXd energy(components.vertices());
  // Works in blocks to avoid a second copy of all components.
  constexpr Eigen::Index kBlock = 4096;
  for (Eigen::Index first = 0; first < energy.size(); first += kBlock) {
    const Eigen::Index count = std::min(kBlock, energy.size() - first);
    const Eigen::MatrixXd c = components.displacements(some, Eigen::seqN(3 * first, 3 * count));
    const Eigen::RowVectorXd each = (gram * c).cwiseProduct(c).colwise().sum();
    energy.segment(first, count) = each.reshaped(3, count).colwise().sum().transpose();
  }
  return energy.cwiseMax(0);
}

std::vector<VertexIndex> disc(const Site& site, double radius) {
  std::vector<VertexIndex> vertices;
  for (VertexIndex v = 0; v < site.distances.size(); ++v) {
    // A centre without triangles has no distances, not even to itself.
    if (site.distances[v] <= (1 + kNearTie) * radius || v == site.center) vertices.push_back(v);
  }
  return vertices;
}

/// Fewest vertices that carry kSupportShare of the energy, among vertices with a path to the
/// centre.
std::vector<VertexIndex> energetic_vertices(const Site& site, const Eigen::VectorXd& energy) {
  std::vector<VertexIndex> order;
  for (VertexIndex v = 0; v < energy.size(); ++v) {
    if (energy[v] > 0 && (std::isfinite(site.distances[v]) || v == site.center)) order.push_back(v);
  }
  std::ranges::stable_sort(order, [&](int a, int b) { return energy[a] > energy[b]; });
  double total = 0;
  for (const VertexIndex v : order) total += energy[v];
  double held = 0;
  std::size_t count = 0;
  while (count < order.size() && held < kSupportShare * total) held += energy[order[count++]];
  order.resize(count);
  std::ranges::sort(order);
  return order;
}

double farthest(const Site& site, const std::vector<VertexIndex>& vertices) {
  double radius = 0;
  for (const VertexIndex v : vertices) {
    if (v != site.center) radius = std::max(radius, site.distances[v]);
  }
  return radius;
}

/// Region of a site, without its share of the energy.
Region region_around(const Site& site, const Components& components, RegionShape shape,
                     double radius) {
  Region region;
  region.component = site.components.front();
  region.center = site.center;
  region.energy = site.energy;
  switch (shape) {
    case RegionShape::disc:
      region.radius = radius;
      region.vertices = disc(site, radius);
      return region;
    case RegionShape::support:
      break;
  }
  region.vertices = energetic_vertices(site, energy_on_vertices(components, site.components));
  region.radius = farthest(site, region.vertices);
  return region;
}

/// Triangles with a vertex that is `inside`, ascending.
std::vector<int> triangles_touching(const std::vector<bool>& inside, const Triangles& triangles) {
  std::vector<int> touching;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (inside[triangles(t, 0)] || inside[triangles(t, 1)] || inside[triangles(t, 2)]) {
      touching.push_back(t);
    }
  }
  return touching;
}

double energy_inside(const Eigen::VectorXd& vertex_energy, const std::vector<bool>& inside) {
  double sum = 0;
  for (Eigen::Index v = 0; v < vertex_energy.size(); ++v) {
    if (inside[v]) sum += vertex_energy[v];
  }
  return sum;
}

std::vector<bool> above_zero(const Eigen::VectorXd& weights) {
  std::vector<bool> above(weights.size());
  for (Eigen::Index v = 0; v < weights.size(); ++v) above[v] = weights[v] > 0;
  return above;
}

/// Fills in the union, L and the shares from the vertices of the regions and their weights.
void complete(Regions& regions, const Triangles& triangles) {
  const bool hard = regions.weights.size() == 0;
  regions.inside = hard ? std::vector<bool>(regions.vertices, false) : above_zero(regions.weights);
  const bool known = regions.vertex_energy.size() > 0;
  for (Region& region : regions.regions) {
    for (const VertexIndex v : region.vertices) {
      if (hard) regions.inside[v] = true;
    }
    if (known) region.energy_share = regions.vertex_energy(region.vertices).sum();
  }
  regions.energy_share = known ? energy_inside(regions.vertex_energy, regions.inside) : 0;
  regions.triangles = triangles_touching(regions.inside, triangles);
  regions.all_triangles = static_cast<int>(triangles.rows());
}

/// Number of first regions whose union reaches the share `coverage`, or of all regions.
std::size_t regions_to_cover(const Regions& regions, double coverage) {
  std::vector<bool> inside(regions.vertices, false);
  double held = 0;
  std::size_t count = 0;
  while (count < regions.regions.size() && held < coverage - kSumRounding) {
    for (const VertexIndex v : regions.regions[count++].vertices) {
      if (!inside[v]) held += regions.vertex_energy[v];
      inside[v] = true;
    }
  }
  return count;
}

std::string whole_percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}

/// Share of the motion on connected parts of the mesh without any region.
double energy_on_parts_without_region(const Regions& regions, const SurfaceParts& parts) {
  std::vector<bool> reached(parts.count(), false);
  for (int v = 0; v < regions.vertices; ++v) {
    if (regions.inside[v]) reached[parts.of_vertex[v]] = true;
  }
  double energy = 0;
  for (int v = 0; v < regions.vertices; ++v) {
    if (!reached[parts.of_vertex[v]]) energy += regions.vertex_energy[v];
  }
  return energy;
}

void cover(Regions& regions, double coverage, const Triangles& triangles,
           const SurfaceParts& parts) {
  regions.regions.resize(regions_to_cover(regions, coverage));
  complete(regions, triangles);
  if (regions.energy_share >= coverage - kSumRounding) return;
  const std::size_t count = regions.regions.size();
  std::string note =
      (count == 1 ? "the one region holds " : "all " + std::to_string(count) + " regions hold ") +
      whole_percent(regions.energy_share) + " of the motion energy; " + whole_percent(coverage) +
      " were asked for";
  const double elsewhere = energy_on_parts_without_region(regions, parts);
  constexpr double kWorthSaying = 0.005;  // 1 % when rounded
  if (elsewhere >= kWorthSaying) {
    note += "; " + whole_percent(elsewhere) +
            " is on parts of the mesh that have no region: small ones, such as teeth, move with "
            "components of others";
  }
  regions.notes.push_back(note);
}

}  // namespace

int Regions::vertex_count() const {
  return static_cast<int>(std::ranges::count(inside, true));
}

Eigen::VectorXd motion_energy(const Components& components) {
  return components.weights.colwise().squaredNorm().transpose().cwiseProduct(
      components.displacements.rowwise().squaredNorm());
}

Regions find_regions(const Components& components, const RegionOptions& options,
                     const Context& context) {
  require_valid(options);
  require_size("inside", options.inside, components.vertices());
  require_size("no_centers", options.no_centers, components.vertices());
  const DistanceFunction distances =
      options.distances
          ? options.distances
          : SurfaceDistances(components.rest, components.triangles, Weld::exact(components.rest),
                             GeodesicMethod::heat, context);
  std::vector<Site> sites = sites_of(components, distances);
  if (!options.no_centers.empty()) {
    std::erase_if(sites, [&](const Site& site) { return options.no_centers[site.center]; });
  }
  Regions regions;
  regions.vertices = components.vertices();
  regions.notes = notes_on(components, sites);
  std::vector<int> all(components.count());
  std::iota(all.begin(), all.end(), 0);
  regions.vertex_energy = energy_on_vertices(components, all);
  const double total = regions.vertex_energy.sum();
  if (total > 0) regions.vertex_energy /= total;
  const SurfaceParts parts = surface_parts(components.rest, components.triangles);
  const double radius = options.radius ? *options.radius
                                       : RegionOptions::kRadiusShare *
                                             diameter(components.rest, components.triangles);
  for (const Site& site : sites) {
    Region region = region_around(site, components, options.shape, radius);
    if (!options.inside.empty()) {
      std::erase_if(region.vertices, [&](VertexIndex v) { return !options.inside[v]; });
    }
    region.surface_part = parts.of_vertex[site.center];
    region.surface_share = parts.share(region.surface_part);
    regions.regions.push_back(std::move(region));
  }
  complete(regions, components.triangles);
  if (options.coverage) cover(regions, *options.coverage, components.triangles, parts);
  return regions;
}

Regions covering(Regions regions, double coverage, const Positions& rest,
                 const Triangles& triangles) {
  cover(regions, coverage, triangles, surface_parts(rest, triangles));
  return regions;
}

Regions strongest(const Regions& regions, int count, const Triangles& triangles) {
  if (count < 1) {
    throw std::invalid_argument("count is " + std::to_string(count) + "; at least 1 region");
  }
  Regions first = regions;
  if (count < static_cast<int>(first.regions.size())) first.regions.resize(count);
  complete(first, triangles);
  return first;
}

int regions_within(const Regions& regions, double share, const Triangles& triangles) {
  const double room = share * static_cast<double>(triangles.rows()) * (1 + kSumRounding);
  std::vector<bool> inside(regions.vertices, false);
  int count = 0;
  for (const Region& region : regions.regions) {
    for (const VertexIndex v : region.vertices) inside[v] = true;
    if (static_cast<double>(triangles_touching(inside, triangles).size()) > room) break;
    ++count;
  }
  return count;
}

Regions with_added(const Regions& regions, std::vector<Region> added, const Triangles& triangles) {
  if (added.empty()) return regions;
  Regions result = regions;
  std::ranges::move(added, std::back_inserter(result.regions));
  complete(result, triangles);
  if (result.vertex_energy.size() == 0) result.energy_share = regions.energy_share;
  return result;
}

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

Regions regions_from_vertices(int vertices, const Triangles& triangles,
                              const std::vector<std::vector<VertexIndex>>& lists) {
  Regions regions;
  regions.vertices = vertices;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    Region& region = regions.regions.emplace_back();
    region.vertices = lists[i];
    for (const VertexIndex v : region.vertices) {
      if (v >= 0 && v < vertices) continue;
      throw MismatchError("region " + std::to_string(i) + " holds vertex " + std::to_string(v) +
                          "; the mesh has vertices 0 to " + std::to_string(vertices - 1));
    }
    std::ranges::sort(region.vertices);
    const auto unique_end = std::unique(region.vertices.begin(), region.vertices.end());
    region.vertices.erase(unique_end, region.vertices.end());
  }
  complete(regions, triangles);
  return regions;
}

void check_weights(const Eigen::VectorXd& weights, Eigen::Index vertices) {
  if (weights.size() != vertices) {
    throw std::invalid_argument("weights: expected one for each of " + std::to_string(vertices) +
                                " vertices, found " + std::to_string(weights.size()));
  }
  for (Eigen::Index v = 0; v < vertices; ++v) {
    if (weights[v] >= 0 && weights[v] <= 1) continue;
    throw std::invalid_argument("weights: that of vertex " + std::to_string(v) + " is " +
                                readable(weights[v]) + ", expected 0 to 1");
  }
}

Regions with_weights(Regions regions, const Eigen::VectorXd& weights, const Triangles& triangles) {
  check_weights(weights, regions.vertices);
  const double known_share = regions.energy_share;
  regions.weights = weights;
  complete(regions, triangles);
  if (regions.vertex_energy.size() == 0) regions.energy_share = known_share;
  return regions;
}

Regions painted_region(const Eigen::VectorXd& weights, const Triangles& triangles) {
  if (!(weights.array() > 0).any()) {
    throw std::invalid_argument("the weights of all vertices are 0; one must be above");
  }
  Regions regions;
  regions.vertices = static_cast<int>(weights.size());
  std::vector<VertexIndex>& painted = regions.regions.emplace_back().vertices;
  for (VertexIndex v = 0; v < regions.vertices; ++v) {
    if (weights[v] > 0) painted.push_back(v);
  }
  return with_weights(std::move(regions), weights, triangles);
}

std::vector<int> triangles_in(const Eigen::VectorXd& weights, const Triangles& triangles) {
  return triangles_touching(above_zero(weights), triangles);
}

std::vector<int> all_triangles(const Triangles& triangles) {
  std::vector<int> all(triangles.rows());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

}  // namespace mimetra
