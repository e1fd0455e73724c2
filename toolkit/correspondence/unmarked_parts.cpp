#include "toolkit/correspondence/unmarked_parts.h"

#include <algorithm>
#include <map>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/surface_parts.h"

namespace mimetra {

namespace {

using Vertices = std::vector<VertexIndex>;

/// The vertices of each part that has triangles, all of whose vertices are not reached.
std::vector<Vertices> unreached_parts(const Positions& positions, const Triangles& triangles,
                                      const std::vector<bool>& reached) {
  const SurfaceParts parts = surface_parts(positions, triangles);
  std::map<int, Vertices> unreached;
  for (VertexIndex v = 0; v < positions.rows(); ++v) {
    const int part = parts.of_vertex[static_cast<std::size_t>(v)];
    const bool has_area = parts.areas[static_cast<std::size_t>(part)] > 0;
    if (has_area && !reached[static_cast<std::size_t>(v)]) unreached[part].push_back(v);
  }
  std::vector<Vertices> result;
  result.reserve(unreached.size());
  for (auto& [part, vertices] : unreached) result.push_back(std::move(vertices));
  return result;
}

/// Those of some vertices that are nearest to a place.
Vertices nearest_to(const Eigen::RowVector3d& place, const Positions& positions,
                    const Vertices& among) {
  constexpr std::size_t kAround = 200;
  std::vector<std::pair<double, VertexIndex>> distances;
  distances.reserve(among.size());
  for (const VertexIndex v : among) {
    distances.emplace_back((positions.row(v) - place).squaredNorm(), v);
  }
  if (distances.size() > kAround) {
    std::ranges::nth_element(distances, distances.begin() + kAround);
    distances.resize(kAround);
  }
  Vertices nearest;
  nearest.reserve(distances.size());
  for (const auto& [distance, v] : distances) nearest.push_back(v);
  std::ranges::sort(nearest);
  return nearest;
}

/// The fit with the parts that no marker reaches where the surface around them has gone.
Positions carried_parts(const SurfaceFit& fit, const TriMesh& source,
                        const std::vector<Vertices>& parts) {
  Vertices reached;
  for (VertexIndex v = 0; v < source.positions.rows(); ++v) {
    if (fit.reached[static_cast<std::size_t>(v)]) reached.push_back(v);
  }
  const auto fitted_to = [&](const Vertices& vertices, auto... handedness) {
    return similarity_fit(source.positions(vertices, Eigen::all),
                          fit.positions(vertices, Eigen::all), handedness...);
  };
  Positions carried = fit.positions;
  try {
    // A flat place alone does not tell left from right.
    const Handedness handedness =
        fitted_to(reached).mirrors() ? Handedness::mirrored : Handedness::kept;
    for (const Vertices& part : parts) {
      const Positions at_rest = source.positions(part, Eigen::all);
      const Vertices around = nearest_to(at_rest.colwise().mean(), source.positions, reached);
      carried(part, Eigen::all) = fitted_to(around, handedness).apply(at_rest);
    }
  } catch (const MismatchError&) {
    return carried;  // points on a line tell no rotation: the similarity of the markers stays
  }
  return carried;
}

/// Whether most of a part has partners near to it.
bool is_paired(const Correspondence& pairs, const std::vector<int>& triangles, double size) {
  constexpr double kMost = 0.75, kNear = 0.1;
  double residuals = 0;
  int paired = 0;
  for (const int t : triangles) {
    if (!pairs.has_partner(t)) continue;
    residuals += pairs.residuals[t];
    ++paired;
  }
  return paired > 0 && paired >= kMost * static_cast<double>(triangles.size()) &&
         residuals <= kNear * size * paired;
}

}  // namespace

Correspondence with_unmarked_parts(Correspondence pairs, const SurfaceFit& fit,
                                   const TriMesh& source, const TriMesh& target,
                                   const Context& context) {
  const Triangles& from = source.connectivity.triangles;
  const Triangles& to = target.connectivity.triangles;
  const auto of_source = unreached_parts(source.positions, from, fit.reached);
  const auto of_target = unreached_parts(target.positions, to, fit.target_reached);
  if (of_source.empty() || of_target.empty()) return pairs;

  SurfaceFit others{carried_parts(fit, source, of_source), fit.reached, fit.target_reached,
                    fit.target_box};
  others.reached.flip();
  others.target_reached.flip();
  const Correspondence found = pair_triangles(others, from, target, context);

  std::vector<int> part_of(static_cast<std::size_t>(target.positions.rows()), -1);
  for (std::size_t part = 0; part < of_target.size(); ++part) {
    for (const VertexIndex v : of_target[part]) part_of[std::size_t(v)] = static_cast<int>(part);
  }
  std::vector<std::vector<int>> triangles_of(of_target.size());
  for (int t = 0; t < to.rows(); ++t) {
    const int part = part_of[std::size_t(to(t, 0))];
    if (part >= 0) triangles_of[std::size_t(part)].push_back(t);
  }
  std::vector<bool> is_taken(static_cast<std::size_t>(to.rows()), false);
  for (std::size_t part = 0; part < of_target.size(); ++part) {
    const double size = box_diagonal(target.positions(of_target[part], Eigen::all));
    if (!is_paired(found, triangles_of[part], size)) continue;
    for (const int t : triangles_of[part]) is_taken[std::size_t(t)] = true;
  }

  Correspondence joined;
  joined.source_triangles = pairs.source_triangles;
  joined.residuals = pairs.residuals;
  for (int t = 0; t < to.rows(); ++t) {
    const Correspondence& taken = is_taken[std::size_t(t)] ? found : pairs;
    joined.parts.insert(joined.parts.end(), taken.parts.begin() + taken.offsets[t],
                        taken.parts.begin() + taken.offsets[t + 1]);
    joined.offsets.push_back(static_cast<int>(joined.parts.size()));
    joined.residuals[t] = taken.residuals[t];
  }
  return joined;
}

}  // namespace mimetra
