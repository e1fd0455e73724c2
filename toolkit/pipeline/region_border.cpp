#include "toolkit/pipeline/region_border.h"

#include <algorithm>
#include <stdexcept>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/pipeline/moving_parts.h"
#include "toolkit/regions/falloff.h"
#include "toolkit/transfer/following_parts.h"

namespace mimetra {

namespace {

/// Of a target vertex with carriers. Where they agree it is theirs, bit by bit.
double weight_between(std::span<const Pairing::Carrier> carriers, const Eigen::VectorXd& weights) {
  const double first = weights[carriers.front().vertex];
  double weight = first;
  for (const auto& [vertex, share] : carriers) weight += share * (weights[vertex] - first);
  return std::clamp(weight, 0.0, 1.0);
}

/// Places that triangles connect.
std::vector<std::vector<VertexIndex>> neighbors_of(const Triangles& triangles, Eigen::Index count) {
  std::vector<std::vector<VertexIndex>> neighbors(count);
  for (const auto& corners : triangles.rowwise()) {
    for (int c = 0; c < 3; ++c) {
      const VertexIndex a = corners[c], b = corners[(c + 1) % 3];
      if (a == b) continue;
      neighbors[a].push_back(b);
      neighbors[b].push_back(a);
    }
  }
  for (std::vector<VertexIndex>& list : neighbors) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbors;
}

/// The number of each unknown place that is connected with a known one, in the order in which they
/// are reached; -1 for others.
std::vector<int> reached_places(const std::vector<std::vector<VertexIndex>>& neighbors,
                                const std::vector<bool>& known) {
  std::vector<int> number(neighbors.size(), -1);
  std::vector<VertexIndex> reached;
  const auto reach_around = [&](VertexIndex place) {
    for (const VertexIndex next : neighbors[place]) {
      if (known[next] || number[next] >= 0) continue;
      number[next] = static_cast<int>(reached.size());
      reached.push_back(next);
    }
  };
  for (std::size_t place = 0; place < known.size(); ++place) {
    if (known[place]) reach_around(static_cast<VertexIndex>(place));
  }
  std::size_t seen = 0;
  while (seen < reached.size()) reach_around(reached[seen++]);
  return number;
}

/// Gives the unknown places the mean of their neighbours, all at once.
void fill_gaps(Eigen::VectorXd& of_places, const std::vector<bool>& known,
               const Triangles& triangles) {
  const auto neighbors = neighbors_of(triangles, of_places.size());
  const std::vector<int> number = reached_places(neighbors, known);
  const int unknowns = *std::ranges::max_element(number) + 1;
  if (unknowns == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd from_known = Eigen::VectorXd::Zero(unknowns);
  for (std::size_t place = 0; place < number.size(); ++place) {
    const int row = number[place];
    if (row < 0) continue;
    entries.emplace_back(row, row, static_cast<double>(neighbors[place].size()));
    for (const VertexIndex next : neighbors[place]) {
      if (known[next]) {
        from_known[row] += of_places[next];
      } else {
        entries.emplace_back(row, number[next], -1.0);
      }
    }
  }
  Eigen::SparseMatrix<double> system(unknowns, unknowns);
  system.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(system);
  if (factor.info() != Eigen::Success) {
    throw std::runtime_error("the weights of vertices without partner cannot be solved for");
  }
  const Eigen::VectorXd solved = factor.solve(from_known);
  // Where only 0, or only 1, is around, rounding of long ways through a gap must not make it less.
  constexpr double kRounding = 1e-9;
  for (std::size_t place = 0; place < number.size(); ++place) {
    if (number[place] < 0) continue;
    const double weight = solved[number[place]];
    of_places[static_cast<Eigen::Index>(place)] = weight < kRounding       ? 0
                                                  : weight > 1 - kRounding ? 1
                                                                           : weight;
  }
}

/// Throws where there is nothing around which something could fade out.
void check_full_weight(const std::string& name, const Eigen::VectorXd& weights) {
  if ((weights.array() == 1).any()) return;
  throw OptionError(Topic::no_full_weight,
                    name +
                        ": no vertex has the weight 1, around which a region could fade out; the "
                        "largest is " +
                        readable(weights.maxCoeff()));
}

/// What the falloff on a target is a share of.
double size_of_border(const Target& target, const Eigen::VectorXd& weights,
                      const std::vector<VertexIndex>& moving) {
  const BlendshapeModel& model = target.model;
  if (!target.pairing && !moving.empty()) {
    return moving_parts(moving, model.neutral(), model.triangles()).diameter;
  }
  std::vector<VertexIndex> inside;
  for (VertexIndex v = 0; v < weights.size(); ++v) {
    if (weights[v] > 0) inside.push_back(v);
  }
  return diameter_of_parts(model.neutral(), model.triangles(), inside);
}

}  // namespace

void check_border(const GivenRegions* given, const Target& target, const SolveOptions& options) {
  const bool is_painted = given && given->regions.weights.size() > 0;
  if (options.per_region && is_painted) {
    throw std::invalid_argument("per_region: " + given->name +
                                " says how much of the motion each vertex takes; with weights of "
                                "each region it takes all of it");
  }
  if (options.per_region || (!is_painted && !options.falloff)) return;
  check_soft_border(target, options);
  if (is_painted && options.falloff) check_full_weight(given->name, given->regions.weights);
}

Eigen::VectorXd carried_weights(const Eigen::VectorXd& weights, const Pairing& pairing,
                                const Weld& weld, const Triangles& triangles) {
  const Eigen::Index count = pairing.target_vertices();
  Eigen::VectorXd carried = Eigen::VectorXd::Zero(count);
  std::vector<bool> known(count, false);
  for (VertexIndex v = 0; v < count; ++v) {
    if (pairing.carriers(v).empty()) continue;
    carried[v] = weight_between(pairing.carriers(v), weights);
    known[weld.representative[v]] = true;
  }
  Eigen::VectorXd of_places = joined_weights(carried, weld);
  fill_gaps(of_places, known, weld.welded(triangles));
  for (VertexIndex v = 0; v < count; ++v) {
    if (pairing.carriers(v).empty()) carried[v] = of_places[weld.representative[v]];
  }
  return carried;
}

Selection bordered_selection(const Regions& regions, const Target& target,
                             const SolveOptions& options, const std::vector<VertexIndex>& moving,
                             const Context& context) {
  Selection selection = selection_of(regions, target);
  const bool fades = options.falloff && !options.per_region;
  if (regions.weights.size() == 0 && !fades) return selection;
  const BlendshapeModel& model = target.model;
  const DistanceOptions of_distances = options.distances.value_or(DistanceOptions());
  const Weld weld = weld_of(model.neutral(), of_distances.welding);
  Eigen::VectorXd weights = regions.weights;
  if (weights.size() == 0) {
    weights = Eigen::VectorXd::Zero(model.vertices());
    for (Eigen::Index v = 0; v < weights.size(); ++v) weights[v] = selection.inside[v] ? 1 : 0;
  } else if (target.pairing) {
    weights = carried_weights(weights, *target.pairing, weld, model.triangles());
  }
  weights = joined_weights(weights, weld);
  if (!(weights.array() > 0).any()) {
    throw MismatchError(target.name +
                        ": none of its vertices lies over those of the regions; choose others");
  }
  if (fades) {
    check_option(options, SolveOptions::kFalloff);
    check_full_weight(target.name, weights);
    const SurfaceDistances distances =
        distances_along(model.neutral(), model.triangles(), of_distances, context.quiet());
    weights = fading_out(weights, model.triangles(), weld,
                         options.falloff->in(size_of_border(target, weights, moving)),
                         [&distances](std::span<const VertexIndex> sources) {
                           return distances.from_nearest(sources);
                         });
  }
  if (target.pairing) {
    weights = FollowingParts(model.neutral(), model.triangles(), weld, *target.pairing)
                  .with_surface(std::move(weights));
  } else if (fades) {
    const FollowingParts following(model.neutral(), model.triangles(), weld, weights);
    weights = following.with_surface(std::move(weights));
  }
  selection.triangles = triangles_in(weights, model.triangles());
  for (Eigen::Index v = 0; v < weights.size(); ++v) selection.inside[v] = weights[v] > 0;
  selection.weights = std::move(weights);
  return selection;
}

Regions with_border(Regions regions, const Selection& selection, const Target& target) {
  if (selection.weights.size() == 0 || target.pairing) return regions;
  return with_weights(std::move(regions), selection.weights, target.model.get().triangles());
}

}  // namespace mimetra
