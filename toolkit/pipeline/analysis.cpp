#include "toolkit/pipeline/analysis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/splocs/reduction.h"

namespace mimetra {

namespace {

int almost_welded_at(const Positions& rest, const Triangles& triangles,
                     const DistanceOptions& options) {
  return options.welding == Welding::exact ? almost_welded_vertices(rest, triangles) : 0;
}

/// Aligns a rest pose for frames with head motion to the source, if that motion was taken out.
Positions aligned(const Positions& rest, const Source& source) {
  if (source.motion.empty()) return rest;
  return rigid_fit(rest, source.sequence->rest()).apply(rest);
}

Positions first_pose(const FrameSource& sequence) {
  return FrameBlock(sequence, 0, 1).frame(0);
}

/// Parts with a vertex inside; `inside` may be empty for all.
std::vector<bool> parts_with(const std::vector<bool>& inside, const SurfaceParts& parts) {
  std::vector<bool> with(parts.areas.size(), inside.empty());
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (inside[v]) with[static_cast<std::size_t>(parts.of_vertex[v])] = true;
  }
  return with;
}

}  // namespace

Weld weld_of(const Positions& positions, Welding welding) {
  switch (welding) {
    case Welding::exact:
      return Weld::exact(positions);
    case Welding::none:
      break;
  }
  return Weld::none(static_cast<int>(positions.rows()));
}

SurfaceDistances distances_along(const Positions& rest, const Triangles& triangles,
                                 const DistanceOptions& options, const Context& context) {
  check_options(options);
  SurfaceDistances distances(rest, triangles, weld_of(rest, options.welding), options.method,
                             context);
  if (const int places = almost_welded_at(rest, triangles, options)) {
    context.note(described_almost_welded(places));
  }
  if (distances.degenerate_triangles() > 0) {
    context.note(std::to_string(distances.degenerate_triangles()) +
                 " triangles without area were left out of the geodesic distances");
  }
  if (!distances.vertices_without_face().empty()) {
    context.note(std::to_string(distances.vertices_without_face().size()) +
                 " vertices belong to no triangle with area, the first is vertex " +
                 std::to_string(distances.vertices_without_face().front()) +
                 "; they are in no region, and their motion counts nowhere");
  }
  return distances;
}

double distance_bytes(GeodesicMethod method, Eigen::Index vertices, int sources,
                      const Context& context) {
  const int threads = std::min(context.thread_count(), sources);
  const auto count = static_cast<double>(vertices);
  // CGAL's sequence trees: measured on faces of 7 to 105 thousand vertices.
  constexpr double kOfTree = 210;
  if (method == GeodesicMethod::exact) return threads * kOfTree * std::pow(count, 1.5);
  if (method == GeodesicMethod::cgal) return threads * kHeatBytesPerVertex * count;
  return 0;
}

Context beside_distances(GeodesicMethod method, Eigen::Index vertices, int sources,
                         const Context& context) {
  const double bytes = distance_bytes(method, vertices, sources, context);
  const std::optional<double> memory = context.memory();
  if (!memory || bytes == 0) return context;
  if (bytes > *memory) {
    throw MismatchError("option 'memory': these distances along " + std::to_string(vertices) +
                        " vertices take " + fixed(std::ceil(bytes / 1e6), 0) +
                        " MB on all threads; allow more, take fewer threads, or distances by heat");
  }
  return context.with_memory(*memory - bytes);
}

SupportRange support_range(const Length& d_min, const Length& d_max, double diameter) {
  const SupportRange range = {d_min.in(diameter), d_max.in(diameter)};
  if (range.d_min < range.d_max) return range;
  throw OptionError(Topic::support_range, "d_min: expected less than d_max, found " +
                                              readable(range.d_min) + " and " +
                                              readable(range.d_max));
}

std::shared_ptr<const FrameSource> work_of(const Source& source, const AnalysisOptions& options) {
  const std::shared_ptr<const FrameSource>& sequence = source.sequence;
  const bool reference = options.compatibility != Compatibility::none;
  if (!options.rest) {
    return reference && !source.rest_is_given ? with_rest(sequence, first_pose(*sequence))
                                              : sequence;
  }
  if (const auto* given = std::get_if<Positions>(&*options.rest)) {
    return with_rest(sequence,
                     given->rows() == sequence->vertices() ? aligned(*given, source) : *given);
  }
  switch (std::get<RestPose>(*options.rest)) {
    case RestPose::first:
      return with_rest(sequence, first_pose(*sequence));
    case RestPose::mean:
      break;
  }
  return with_rest(sequence, mean_pose(*sequence));
}

Eigen::VectorXd motion_on_vertices(const FrameSource& sequence, const std::vector<bool>& inside,
                                   const Context& context) {
  // The number of parts does not depend on the threads, so the sums are the same bytes.
  constexpr int kParts = 8;
  const int frames = sequence.frames();
  std::vector<Eigen::VectorXd> sums(kParts, Eigen::VectorXd::Zero(sequence.vertices()));
  const auto add_part = [&](int part) {
    const int first = frames * part / kParts, end = frames * (part + 1) / kParts;
    for (int f = first; f < end; ++f) {
      const FrameBlock block(sequence, f, 1);
      sums[part] += (block.frame(0) - sequence.rest()).rowwise().squaredNorm();
    }
  };
  parallel_for(kParts, add_part, context);
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(sequence.vertices());
  for (const Eigen::VectorXd& sum : sums) motion += sum;
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (!inside[v]) motion[static_cast<Eigen::Index>(v)] = 0;
  }
  const double all = motion.sum();
  if (all > 0) motion /= all;
  return motion;
}

PartWeights part_weights(const Positions& rest, const Triangles& triangles,
                         const std::vector<bool>& inside, Welding welding) {
  const SurfaceParts parts = surface_parts(rest, triangles, weld_of(rest, welding));
  const Eigen::VectorXd areas = vertex_areas(rest, triangles);
  std::vector<double> of_parts(parts.count(), 0);
  for (VertexIndex v = 0; v < areas.size(); ++v) {
    if (inside.empty() || inside[v]) of_parts[parts.of_vertex[v]] += areas[v];
  }
  const double largest = std::ranges::max(of_parts);
  if (parts.count() == 1 || !(largest > 0)) return {};
  for (double& area : of_parts) area /= largest;
  return {parts.of_vertex, of_parts};
}

DecompositionOptions decomposition_options(const AnalysisOptions& options) {
  DecompositionOptions decomposition{.count = options.count,
                                     .sparsity = options.sparsity,
                                     .rho = options.rho,
                                     .iterations = options.iterations,
                                     .admm_iterations = options.admm_iterations,
                                     .tolerance = options.tolerance,
                                     .nonnegative = options.nonnegative,
                                     .basis_tolerance = options.basis_tolerance,
                                     .precision = options.precision};
  if (options.compatibility == Compatibility::none) return decomposition;
  decomposition.iterations =
      options.iterations.value_or(DecompositionOptions::kReferenceIterations);
  decomposition.tolerance = 0;
  decomposition.sign_rule = SignRule::literal;
  decomposition.scale = MotionScale::standard_deviation;
  decomposition.returned = ReturnedIterate::last;
  return decomposition;
}

int component_count(const FrameSource& sequence, double size, const AnalysisOptions& options) {
  const int asked = options.count;
  if (options.compatibility != Compatibility::none) return asked;
  const double reach = options.d_min.in(size);
  const double disc = std::numbers::pi * reach * reach;
  const SurfaceParts parts = surface_parts(sequence.rest(), sequence.triangles());
  double discs = 0;
  const std::vector<bool> counts = parts_with(options.inside, parts);
  for (int p = 0; p < parts.count(); ++p) {
    if (counts[p]) discs += std::max(1.0, std::ceil(parts.areas[p] / disc));
  }
  double most = std::min(discs * sequence.frames(), 3.0 * sequence.vertices());
  if (!options.inside.empty()) {
    most = std::min(most, static_cast<double>(std::ranges::count(options.inside, true)));
  }
  return most < asked ? std::max(1, static_cast<int>(most)) : asked;
}

namespace {

/// Some vertices of another source.
class KeptVertices : public FrameSource {
 public:
  KeptVertices(std::shared_ptr<const FrameSource> whole, std::vector<VertexIndex> kept,
               Connectivity connectivity)
      : FrameSource(whole->header()), whole_(std::move(whole)), kept_(std::move(kept)) {
    header_.connectivity = std::make_shared<const Connectivity>(std::move(connectivity));
    header_.rest = Positions(whole_->rest()(kept_, Eigen::all));
    header_.rest_is_known = true;
  }

  bool is_quick() const override { return whole_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    const FrameBlock whole(*whole_, first, static_cast<int>(poses.rows()));
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      poses.middleCols(3 * i, 3) = whole.poses().middleCols(3 * kept_[i], 3);
    }
  }

  std::shared_ptr<const FrameSource> whole_;
  std::vector<VertexIndex> kept_;
};

/// Decomposes some vertices of a mesh as if there were no others. Distances still run along the
/// whole surface.
class Cutout {
 public:
  /// `inside` (N) marks the vertices to cut out. \pre at least one is true
  explicit Cutout(const std::vector<bool>& inside);

  int vertices() const { return static_cast<int>(kept_.size()); }
  /// Frames and rest pose of the kept vertices (n), and the triangles between kept vertices.
  std::shared_ptr<const FrameSource> of(std::shared_ptr<const FrameSource> whole) const;
  /// Distances between kept vertices, from `distances` between all vertices.
  DistanceFunction of(DistanceFunction distances) const;
  /// The kept entries (n) of one value per vertex (N).
  std::vector<int> of(const std::vector<int>& values) const;
  /// Turns components of the kept vertices into components of the whole mesh. Outside, they are
  /// zero and the support maps are 1.
  Components put_back(Components components, const FrameSource& whole) const;

 private:
  std::vector<VertexIndex> kept_;      ///< ascending (n)
  std::vector<VertexIndex> position_;  ///< index in kept_, -1 for the others (N)
};

Cutout::Cutout(const std::vector<bool>& inside) : position_(inside.size(), -1) {
  for (std::size_t v = 0; v < inside.size(); ++v) {
    if (!inside[v]) continue;
    position_[v] = vertices();
    kept_.push_back(static_cast<VertexIndex>(v));
  }
}

std::shared_ptr<const FrameSource> Cutout::of(std::shared_ptr<const FrameSource> whole) const {
  std::vector<int> triangles;
  for (int t = 0; t < whole->triangles().rows(); ++t) {
    const auto corners = whole->triangles().row(t);
    if (position_[corners[0]] >= 0 && position_[corners[1]] >= 0 && position_[corners[2]] >= 0) {
      triangles.push_back(t);
    }
  }
  const Triangles kept = whole->triangles()(triangles, Eigen::all).unaryExpr([this](VertexIndex v) {
    return position_[v];
  });
  return std::make_shared<const KeptVertices>(std::move(whole), kept_,
                                              Connectivity::from_triangles(vertices(), kept));
}

DistanceFunction Cutout::of(DistanceFunction distances) const {
  return [distances = std::move(distances), kept = kept_](std::span<const VertexIndex> sources) {
    std::vector<VertexIndex> in_whole;
    for (const VertexIndex source : sources) in_whole.push_back(kept[source]);
    return Eigen::MatrixXd(distances(in_whole)(kept, Eigen::all));
  };
}

std::vector<int> Cutout::of(const std::vector<int>& values) const {
  std::vector<int> kept;
  for (const VertexIndex v : kept_) kept.push_back(values[v]);
  return kept;
}

Components Cutout::put_back(Components components, const FrameSource& whole) const {
  const Frames displacements = std::exchange(components.displacements,
                                             Frames::Zero(components.count(), whole.rest().size()));
  const Eigen::MatrixXd support = std::exchange(
      components.support, Eigen::MatrixXd::Ones(components.count(), whole.vertices()));
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    components.displacements.middleCols(3 * kept_[i], 3) = displacements.middleCols(3 * i, 3);
    components.support.col(kept_[i]) = support.col(i);
  }
  for (VertexIndex& center : components.centers) {
    if (center >= 0) center = kept_[center];
  }
  components.rest = whole.rest();
  components.triangles = whole.triangles();
  components.options.parts = {};
  return components;
}

/// Longest side of any single frame's bounding box: the reference's unit of length.
double largest_frame_extent(const FrameSource& sequence) {
  double largest = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    largest = std::max(largest, extent(FrameBlock(sequence, f, 1).frame(0)));
  }
  return largest;
}

/// Share of the diameter from which a parting of welded vertices is reported: well above float32
/// rounding, well below visible gaps.
constexpr double kPartingShare = 1e-4;

void note_parting(const FrameSource& sequence, const AnalysisOptions& options,
                  const Context& context) {
  if (options.distances.welding == Welding::none) return;
  const auto parting =
      parting_vertices(sequence, Weld::exact(sequence.rest()), kPartingShare * sequence.diameter(),
                       context.without_ranks());
  if (parting.empty()) return;
  context.note(std::to_string(parting.size()) +
                   " vertices coincide at rest and part later (the first is vertex " +
                   std::to_string(parting.front()) + "); distances pass from one to the other",
               Topic::parting_vertices);
}

void check_inside(const std::vector<bool>& inside, int vertices) {
  if (inside.empty()) return;
  if (static_cast<int>(inside.size()) != vertices) {
    throw std::invalid_argument("inside: " + std::to_string(inside.size()) +
                                " vertices, expected " + std::to_string(vertices));
  }
  if (std::ranges::find(inside, true) == inside.end()) {
    throw OptionError(Topic::no_vertex_inside, "no vertex is left where regions may lie");
  }
}

Components decomposed_inside(const std::shared_ptr<const FrameSource>& work,
                             const std::vector<bool>& inside, DecompositionOptions options,
                             const Context& context) {
  if (inside.empty()) return decompose(*work, options, context);
  const Cutout cutout(inside);
  options.distances = cutout.of(options.distances);
  if (!options.parts.empty()) options.parts.of_vertex = cutout.of(options.parts.of_vertex);
  return cutout.put_back(decompose(*cutout.of(work), options, context), *work);
}

/// Vertices inside that belong to a triangle with area; empty for all.
std::vector<bool> on_surface(std::vector<bool> inside, const SurfaceDistances& distances,
                             int vertices) {
  const std::vector<VertexIndex>& loose = distances.vertices_without_face();
  if (loose.empty() || static_cast<int>(loose.size()) == vertices) return inside;
  if (inside.empty()) inside.assign(static_cast<std::size_t>(vertices), true);
  for (const VertexIndex v : loose) inside[static_cast<std::size_t>(v)] = false;
  return inside;
}

/// Vertices in both sets; an empty set contains all vertices.
std::vector<bool> both(std::vector<bool> inside, const std::vector<bool>& also) {
  if (inside.empty() || also.empty()) return inside.empty() ? also : inside;
  for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = inside[v] && also[v];
  return inside;
}

MovingParts noted_moving_parts(const std::vector<VertexIndex>& moving, const Positions& rest,
                               const Triangles& triangles, const Context& context) {
  MovingParts found = moving_parts(moving, rest, triangles);
  if (found.is_section) {
    context.note("a small section of a connected part moves; lengths are shares of " +
                 readable(found.diameter) + ", 1.5 times its diameter");
  }
  return found;
}

}  // namespace

Analysis analyse(const Source& source, const AnalysisOptions& options, const Context& context) {
  const Stopwatch stopwatch;
  check_options(options);
  const bool reference = options.compatibility != Compatibility::none;
  if (reference && options.tolerance != 0 &&
      options.tolerance != DecompositionOptions::kUsualTolerance) {
    throw std::invalid_argument(
        "tolerance: with a compatibility all iterations run; leave the tolerance out");
  }
  const std::shared_ptr<const FrameSource> sequence = work_of(source, options);
  const FrameSource& work = *sequence;
  if (options.count > work.vertices()) {
    throw OptionError(Topic::component_count, std::to_string(options.count) +
                                                  " components asked for, the mesh has " +
                                                  std::to_string(work.vertices()) + " vertices");
  }
  check_inside(options.inside, work.vertices());
  SurfaceDistances distances =
      distances_along(work.rest(), work.triangles(), options.distances, context);
  const MovingParts moving =
      noted_moving_parts(source.moving, work.rest(), work.triangles(), context);
  const double size = moving.diameter;
  AnalysisOptions of_surface = options;
  if (!reference) {
    std::vector<bool> inside = both(options.inside, moving.vertices);
    if (!inside.empty() && std::ranges::find(inside, true) == inside.end()) {
      throw MismatchError("where regions may lie nothing moves");
    }
    of_surface.inside = on_surface(std::move(inside), distances, work.vertices());
  }
  check_inside(of_surface.inside, work.vertices());
  DecompositionOptions decomposition = decomposition_options(options);
  decomposition.count = component_count(work, size, of_surface);
  if (decomposition.count < options.count) {
    context.note("K = " + std::to_string(options.count) + ": " + std::to_string(work.frames()) +
                 " frames tell at most " + std::to_string(decomposition.count) +
                 " components of this surface apart; so many are taken");
  }
  note_parting(work, options, context.part(0, 0));
  const double unit = reference ? largest_frame_extent(*source.given) : size;
  const SupportRange range = support_range(options.d_min, options.d_max, unit);
  decomposition.d_min = range.d_min;
  decomposition.d_max = range.d_max;
  if (!reference) {
    decomposition.parts =
        part_weights(work.rest(), work.triangles(), of_surface.inside, options.distances.welding);
  }
  decomposition.distances = distances;
  Components components;
  try {
    components = decomposed_inside(
        sequence, of_surface.inside, decomposition,
        beside_distances(options.distances.method, work.vertices(), decomposition.count, context));
  } catch (const MismatchError& error) {
    // Other vertices may move.
    const std::string text = error.what();
    if (options.inside.empty() || !text.starts_with("nothing moves")) throw;
    throw MismatchError("where regions may lie " + text);
  }
  return {std::move(components), std::move(distances),      options.inside,
          stopwatch.seconds(),   options.distances.welding, size};
}

void check_components(const GivenComponents& given, const FrameSource& sequence) {
  const Components& components = given.components;
  if (components.weights.size() == 0) {
    throw MismatchError(given.name +
                        ": holds no weights W, without which regions have no motion energy; "
                        "decompose the sequence again");
  }
  if (components.vertices() != sequence.vertices() ||
      components.triangles.rows() != sequence.triangles().rows() ||
      components.triangles != sequence.triangles()) {
    throw MismatchError(given.name + ": components of " + std::to_string(components.vertices()) +
                        " vertices with other triangles than the sequence, which has " +
                        std::to_string(sequence.vertices()) + " vertices");
  }
  if (std::ranges::all_of(components.centers, [](VertexIndex center) { return center < 0; })) {
    throw MismatchError(given.name + ": no component moves a vertex, so that there is no region");
  }
}

namespace {

/// Moves centres outside to the strongest vertex inside; a component without motion there loses its
/// centre.
Components centered_inside(Components components, const std::vector<bool>& inside) {
  if (inside.empty()) return components;
  Eigen::VectorXd weights(components.vertices());
  for (VertexIndex v = 0; v < weights.size(); ++v) weights[v] = inside[v];
  for (int k = 0; k < components.count(); ++k) {
    VertexIndex& center = components.centers[k];
    if (center < 0 || inside[center]) continue;
    center = strongest_vertex(vertex_energies(components.displacements.row(k)), weights);
  }
  return components;
}

}  // namespace

Analysis analysis_of(const GivenComponents& given, const FrameSource& sequence,
                     const std::vector<VertexIndex>& moving, const AnalysisOptions& options,
                     const Context& context) {
  check_components(given, sequence);
  const Components& components = given.components;
  SurfaceDistances distances =
      distances_along(components.rest, components.triangles, options.distances, context);
  check_inside(options.inside, components.vertices());
  return {centered_inside(components, options.inside),
          std::move(distances),
          options.inside,
          0,
          options.distances.welding,
          noted_moving_parts(moving, components.rest, components.triangles, context).diameter};
}

}  // namespace mimetra
