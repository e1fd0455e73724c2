#include "toolkit/pipeline/simplified_regions.h"

#include <stdexcept>
#include <utility>

#include "toolkit/correspondence/renumbered_frames.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/pipeline/moving_parts.h"
#include "toolkit/regions/carried_regions.h"

namespace mimetra {
namespace {

/// Of all the work, choosing the vertices, and until the motion of all is added up.
constexpr double kSimplifying = 0.3, kAnalysed = 0.9;

/// What is said of the vertices of the mesh, of those that are kept.
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
                                        const RegionChoiceOptions& choice) {
  const Stopwatch stopwatch;
  if (choice.regions.shape != RegionShape::disc) {
    throw std::invalid_argument(
        "shape: regions that are found on fewer vertices are discs; those that hold most of a "
        "component's energy need all vertices");
  }
  SimplifiedRegions result;
  SimplifyOptions of_mesh = simplifying;
  of_mesh.threads = analysis.threads;
  of_mesh.progress = part_of(analysis.progress, 0, kSimplifying);
  result.mesh = simplify(*source.sequence, of_mesh);
  const std::vector<VertexIndex>& kept = result.mesh.vertices;
  Source on_kept = source;
  on_kept.sequence = renumbered(source.sequence, result.mesh.connectivity, kept);
  on_kept.given = renumbered(source.given, result.mesh.connectivity, kept);
  on_kept.moving = moving_vertices(on_kept.motion.empty() ? *on_kept.sequence : *on_kept.given);
  AnalysisOptions of_kept_mesh = of_kept(analysis, kept);
  of_kept_mesh.progress = part_of(analysis.progress, kSimplifying, kAnalysed);
  const FrameSource& whole = *source.sequence;
  RegionChoiceOptions of_choice = choice;
  const double size = moving_parts(source.moving, whole.rest(), whole.triangles()).diameter;
  of_choice.radius = Length::of(choice.radius.in(size));
  of_choice.regions.coverage.reset();  // of the energy on all vertices
  const Regions found = choose_regions(analyse(on_kept, of_kept_mesh), of_choice);
  DistanceOptions of_distances = analysis.distances;
  of_distances.threads = analysis.threads;
  of_distances.notes = analysis.notes;
  Eigen::VectorXd energy = motion_on_vertices(
      *work_of(source, analysis), analysis.inside,
      {.threads = analysis.threads, .progress = part_of(analysis.progress, kAnalysed, 1)});
  result.regions = carried_regions(found, result.mesh, std::move(energy), whole.triangles(),
                                   distances_along(whole.rest(), whole.triangles(), of_distances),
                                   analysis.inside);
  if (choice.regions.coverage) {
    const std::size_t said = result.regions.notes.size();
    result.regions = covering(std::move(result.regions), *choice.regions.coverage, whole.rest(),
                              whole.triangles());
    for (std::size_t i = said; i < result.regions.notes.size(); ++i) {
      note(choice.notes, result.regions.notes[i]);
    }
  }
  note_large_regions(result.regions, choice, size, whole.triangles());
  result.seconds = stopwatch.seconds();
  return result;
}

}  // namespace mimetra
