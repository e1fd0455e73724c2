#include "toolkit/pipeline/region_choice.h"

#include <algorithm>
#include <set>
#include <span>
#include <stdexcept>
#include <utility>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "toolkit/correspondence/renumbering.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/regions/discs.h"
#include "toolkit/regions/falloff.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/following_parts.h"
#include "toolkit/transfer/soft_border.h"

namespace mimetra {

namespace {

/// Vertices near rims, where no region is made. Empty if every component moves a rim most.
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

/// Share of the surface below which a connected part is small, such as a single tooth or lashes.
/// Regions of a face are hardly meant for such parts.
constexpr double kSmallPart = 0.02;

/// Notes regions on small parts, also in the regions' own notes.
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

/// Notes discs with more than half of the vertices (Topic::large_regions), which distinguish
/// nothing. Radii that are absolute lengths are not checked. `size` is the diameter of relative
/// radii.
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

/// Explains why no region fits into a share of the triangles.
[[noreturn]] void refuse_bound(double share, const std::string& reason) {
  throw OptionError(Topic::triangle_bound, percent(share) + " of the triangles: " + reason +
                                               "; allow more, or take "
                                               "smaller regions");
}

}  // namespace

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

bool has_own_regions(const RegionChoiceOptions& options) {
  return options.select == Selector::transfer || (options.triangles && options.complete > 0);
}

namespace {

/// Progress at which the simplification ends, and at which the analysis ends.
constexpr double kSimplifying = 0.3, kAnalysed = 0.9;

/// Restricts the options to the kept vertices.
AnalysisOptions of_kept(AnalysisOptions options, const std::vector<VertexIndex>& kept) {
  if (!options.inside.empty()) {
    std::vector<bool> inside;
    inside.reserve(kept.size());
    for (const VertexIndex v : kept) inside.push_back(options.inside[static_cast<std::size_t>(v)]);
    options.inside = std::move(inside);
  }
  if (options.rest) {
    if (auto* pose = std::get_if<Positions>(&*options.rest)) {
      *pose = Positions((*pose)(kept, Eigen::all));
    }
  }
  return options;
}

}  // namespace

SimplifiedRegions regions_by_simplified(const Source& source, const SimplifyOptions& simplifying,
                                        const AnalysisOptions& analysis,
                                        const RegionChoiceOptions& choice, const Context& context) {
  check_options(choice);
  const Stopwatch stopwatch;
  if (choice.shape != RegionShape::disc) {
    throw std::invalid_argument(
        "shape: regions that are found on fewer vertices are discs; those that hold most of a "
        "component's energy need all vertices");
  }
  SimplifiedRegions result;
  result.mesh =
      simplify(*source.sequence, simplifying, context.part(0, kSimplifying).without_ranks());
  const std::vector<VertexIndex>& kept = result.mesh.vertices;
  Source on_kept = source;
  on_kept.sequence = renumbered(source.sequence, result.mesh.connectivity, kept);
  on_kept.given = renumbered(source.given, result.mesh.connectivity, kept);
  on_kept.moving = moving_vertices(on_kept.motion.empty() ? *on_kept.sequence : *on_kept.given);
  const FrameSource& whole = *source.sequence;
  RegionChoiceOptions of_choice = choice;
  const double size = moving_parts(source.moving, whole.rest(), whole.triangles()).diameter;
  of_choice.radius = Length::of(choice.radius.in(size));
  of_choice.coverage.reset();  // needs the energy on all vertices
  const Analysis of_few =
      analyse(on_kept, of_kept(analysis, kept), context.part(kSimplifying, kAnalysed));
  const Regions found = choose_regions(of_few, of_choice, context);
  Eigen::VectorXd energy =
      motion_on_vertices(*work_of(source, analysis), analysis.inside, context.part(kAnalysed, 1));
  result.regions =
      carried_regions(found, result.mesh, std::move(energy), whole.triangles(),
                      distances_along(whole.rest(), whole.triangles(), analysis.distances, context),
                      analysis.inside);
  if (choice.coverage) {
    const std::size_t said = result.regions.notes.size();
    result.regions =
        covering(std::move(result.regions), *choice.coverage, whole.rest(), whole.triangles());
    for (std::size_t i = said; i < result.regions.notes.size(); ++i) {
      context.note(result.regions.notes[i]);
    }
  }
  note_large_regions(result.regions, choice, size, whole.triangles(), context);
  result.seconds = stopwatch.seconds();
  return result;
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

namespace {

/// Radius of added discs, as a share of the regions' radius.
constexpr double kAddedRadius = 0.5;

/// Names of the expressions that discs were added for, each once.
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
  // The limit counts triangles of the target, so the discs may exceed it on the source.
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

SelectionBound selection_bound(const RegionChoiceOptions& options) {
  const double usual = options.discs ? 1 : RegionChoiceOptions::kUsualShare;
  return {options.triangles.value_or(usual), options.discs};
}

void check_selection(const Target& target, const RegionChoiceOptions& regions, Space space) {
  if (regions.select != Selector::transfer || !solves_for_vertices(target.model, space)) return;
  throw OptionError(Topic::no_selection,
                    target.name +
                        ": is solved for vertices, and regions are chosen for a "
                        "transfer by what they tell of expressions");
}

namespace {

/// Share of the progress for the solve by all triangles.
constexpr double kFullShare = 0.2;

/// RegionSelectionOptions::noise for regions that also serve other identities. Measured with
/// regions chosen on one identity at a fifth of the triangles. Five others lose 0.4 to 1.2 % with
/// 30, 0.4 to 1.9 % with 10, and 0.3 to 2.2 % with 100.
constexpr double kNoise = 30;

/// Shortage of triangles that is worth a note; one disc usually has more.
constexpr double kMissedTriangles = 0.02;

Region region_of(const Disc& disc, double radius) {
  Region region;
  region.center = disc.center;
  region.radius = radius;
  region.vertices = disc.vertices;
  return region;
}

}  // namespace

RegionSelector::RegionSelector(const Source& source, const RegionChoiceOptions& options,
                               const AnalysisOptions& analysis)
    : rest_(source.sequence->rest()),
      triangles_(source.sequence->triangles()),
      options_(options),
      of_distances_(analysis.distances) {
  check_options(options);
  options_.select = Selector::transfer;
  const MovingParts moving = moving_parts(source.moving, rest_, triangles_);
  radius_ = kDiscRadius * options.radius.in(moving.diameter);
  inside_ = analysis.inside;
  if (inside_.empty()) inside_ = moving.vertices;
}

const std::vector<Disc>& RegionSelector::candidates(const Context& context) {
  if (!candidates_.empty()) return candidates_;
  const SurfaceDistances distances = distances_along(rest_, triangles_, of_distances_, context);
  candidates_ =
      farthest_discs(rest_, triangles_,
                     [&](std::span<const VertexIndex> sources) { return distances.once(sources); },
                     {.radius = radius_, .count = kCandidates, .inside = inside_});
  return candidates_;
}

Regions RegionSelector::operator()(const Source& source, const Target& target,
                                   const SolveOptions& options, const Context& context) {
  const SelectionBound bound = selection_bound(options_);
  Regions regions = std::move(within({&bound, 1}, source, target, options, context).front());
  const bool is_capped = bound.count && static_cast<int>(regions.regions.size()) == *bound.count;
  if (!is_capped && regions.triangle_share() < bound.share - kMissedTriangles) {
    context.note(target.name + ": the " + std::to_string(regions.regions.size()) +
                     " regions that serve the transfer hold " + percent(regions.triangle_share()) +
                     " of the triangles, " + percent(bound.share) + " were allowed",
                 Topic::few_discs);
  }
  return regions;
}

std::vector<Regions> RegionSelector::within(std::span<const SelectionBound> bounds,
                                            const Source& source, const Target& target,
                                            const SolveOptions& options, const Context& context) {
  check_selection(target, options_, options.space);
  const MeshSequence frames = spread_frames(source.sequence, kMostFrames, context.part(0, 0));
  const RegionSelection selection(
      frames, target.model,
      {.noise = kNoise, .edges = options.edges.value_or(EdgeSum::all), .pairing = target.pairing},
      context.part(0, kFullShare));
  Regions none;
  none.vertices = static_cast<int>(rest_.rows());
  none.all_triangles = static_cast<int>(triangles_.rows());
  none.vertex_energy = motion_on_vertices(frames, {}, context.part(kFullShare, kFullShare));
  std::vector<Regions> result;
  for (const SelectionBound& bound : bounds) {
    std::vector<Region> chosen;
    for (const int disc :
         selection.choose(candidates(context), bound, context.part(kFullShare, 1))) {
      chosen.push_back(region_of(candidates_[disc], radius_));
    }
    if (chosen.empty()) refuse_bound(bound.share, "no disc of the surface is so small");
    result.push_back(with_added(none, std::move(chosen), triangles_));
  }
  return result;
}

namespace {

/// Weight of a target vertex from its carriers. Equal weights stay the same bits.
double weight_between(std::span<const Pairing::Carrier> carriers, const Eigen::VectorXd& weights) {
  const double first = weights[carriers.front().vertex];
  double weight = first;
  for (const auto& [vertex, share] : carriers) weight += share * (weights[vertex] - first);
  return std::clamp(weight, 0.0, 1.0);
}

/// Places that share an edge with each place.
std::vector<std::vector<VertexIndex>> neighbors_of(const Triangles& triangles, Eigen::Index count) {
  std::vector<std::vector<VertexIndex>> neighbors(count);
  EdgeSides(static_cast<int>(count), triangles, Collapsed::kept)
      .for_each_edge([&](std::span<const int> sides) {
        const int triangle = sides[0] / 3, corner = sides[0] % 3;
        const VertexIndex a = triangles(triangle, corner),
                          b = triangles(triangle, (corner + 1) % 3);
        neighbors[a].push_back(b);
        neighbors[b].push_back(a);
      });
  for (std::vector<VertexIndex>& list : neighbors) std::ranges::sort(list);
  return neighbors;
}

/// Numbers the unknown places that are connected with a known place, in the order of a
/// breadth-first search; -1 for others.
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

/// Gives each unknown place the mean of its neighbours, by one linear system.
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
  // Between equal weights of 0 or 1, rounding across a large gap must not change the weight.
  constexpr double kRounding = 1e-9;
  for (std::size_t place = 0; place < number.size(); ++place) {
    if (number[place] < 0) continue;
    const double weight = solved[number[place]];
    of_places[static_cast<Eigen::Index>(place)] = weight < kRounding       ? 0
                                                  : weight > 1 - kRounding ? 1
                                                                           : weight;
  }
}

/// Throws OptionError (Topic::no_full_weight) if no vertex has the weight 1.
void check_full_weight(const std::string& name, const Eigen::VectorXd& weights) {
  if ((weights.array() == 1).any()) return;
  throw OptionError(Topic::no_full_weight,
                    name +
                        ": no vertex has the weight 1, around which a region could fade out; the "
                        "largest is " +
                        readable(weights.maxCoeff()));
}

/// Size that a relative falloff on a target is a share of.
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
