#include "toolkit/pipeline/analysis.h"

#include <algorithm>

#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

Weld weld_of(const Positions& positions, Welding welding) {
  switch (welding) {
    case Welding::exact:
      return Weld::exact(positions);
    case Welding::none:
      break;
  }
  return Weld::none(static_cast<int>(positions.rows()));
}

/// The rest pose that was made for frames with head motion, where that was taken out.
Positions aligned(const Positions& rest, const Source& source) {
  if (source.motion.empty()) return rest;
  return rigid_fit(rest, source.sequence->rest()).apply(rest);
}

/// The source in memory, with the rest pose of the decomposition.
MeshSequence work_of(const Source& source, const AnalysisOptions& options) {
  const MeshSequence sequence(*source.sequence, {.threads = options.threads});
  const bool reference = options.compatibility == Compatibility::splocs2013;
  if (!options.rest) {
    return reference && !source.rest_is_given ? sequence.with_rest(sequence.frame(0)) : sequence;
  }
  if (const auto* given = std::get_if<Positions>(&*options.rest)) {
    return sequence.with_rest(given->rows() == sequence.vertices() ? aligned(*given, source)
                                                                   : *given);
  }
  switch (std::get<RestPose>(*options.rest)) {
    case RestPose::first:
      return sequence.with_rest(sequence.frame(0));
    case RestPose::mean:
      break;
  }
  return sequence.with_rest(mean_pose(sequence));
}

/// Longest side that any single frame's bounding box has: the reference's unit of length.
double largest_frame_extent(const FrameSource& sequence) {
  double largest = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    largest = std::max(largest, extent(FrameBlock(sequence, f, 1).frame(0)));
  }
  return largest;
}

/// Vertices that were welded at rest and part by more than this share of the longest side are
/// reported: well above float32 rounding, well below what one sees.
constexpr double kPartingShare = 1e-4;

void note_parting(const MeshSequence& sequence, const AnalysisOptions& options) {
  if (options.distances.welding == Welding::none) return;
  const auto parting =
      parting_vertices(sequence, Weld::exact(sequence.rest()), kPartingShare * sequence.extent(),
                       {.threads = options.threads});
  if (parting.empty()) return;
  note(options.notes,
       std::to_string(parting.size()) +
           " vertices coincide at rest and part later (the first is vertex " +
           std::to_string(parting.front()) + "); distances pass from one to the other",
       Topic::parting_vertices);
}

DistanceOptions distance_options(const AnalysisOptions& options) {
  DistanceOptions distances = options.distances;
  distances.threads = options.threads;
  distances.notes = options.notes;
  return distances;
}

}  // namespace

SurfaceDistances distances_along(const Positions& rest, const Triangles& triangles,
                                 const DistanceOptions& options) {
  check_options(options);
  SurfaceDistances distances(rest, triangles, weld_of(rest, options.welding), options.method,
                             options.threads);
  if (distances.degenerate_triangles() > 0) {
    note(options.notes, std::to_string(distances.degenerate_triangles()) +
                            " triangles without area were left out of the geodesic distances");
  }
  if (!distances.vertices_without_face().empty()) {
    note(options.notes, std::to_string(distances.vertices_without_face().size()) +
                            " vertices belong to no triangle with area, the first is vertex " +
                            std::to_string(distances.vertices_without_face().front()) +
                            "; they are in no region");
  }
  return distances;
}

SupportRange support_range(const Length& d_min, const Length& d_max, double longest_side) {
  const SupportRange range = {d_min.in(longest_side), d_max.in(longest_side)};
  if (range.d_min < range.d_max) return range;
  throw OptionError(Topic::support_range, "d_min: expected less than d_max, found " +
                                              readable(range.d_min) + " and " +
                                              readable(range.d_max));
}

Analysis analyse(const Source& source, const AnalysisOptions& options) {
  const Stopwatch stopwatch;
  check_options(options);
  const MeshSequence work = work_of(source, options);
  DecompositionOptions decomposition = options.decomposition;
  if (decomposition.count > work.vertices()) {
    throw OptionError(Topic::component_count, std::to_string(decomposition.count) +
                                                  " components asked for, the mesh has " +
                                                  std::to_string(work.vertices()) + " vertices");
  }
  note_parting(work, options);
  SurfaceDistances distances =
      distances_along(work.rest(), work.triangles(), distance_options(options));
  const bool reference = options.compatibility == Compatibility::splocs2013;
  const double unit = reference ? largest_frame_extent(*source.given) : work.extent();
  const SupportRange range = support_range(options.d_min, options.d_max, unit);
  decomposition.d_min = range.d_min;
  decomposition.d_max = range.d_max;
  if (reference) {
    decomposition.iterations =
        decomposition.iterations.value_or(DecompositionOptions::kReferenceIterations);
    decomposition.tolerance = 0;
    decomposition.sign_rule = SignRule::literal;
    decomposition.returned = ReturnedIterate::last;
  }
  decomposition.distances = distances;
  decomposition.threads = options.threads;
  decomposition.progress = options.progress;
  Components components = decompose(work, decomposition);
  return {std::move(components), std::move(distances), stopwatch.seconds()};
}

Analysis analysis_of(const GivenComponents& given, const FrameSource& sequence,
                     const AnalysisOptions& options) {
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
  SurfaceDistances distances =
      distances_along(components.rest, components.triangles, distance_options(options));
  return {components, std::move(distances), 0};
}

}  // namespace mimetra
