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
  of_choice.coverage.reset();  // of the energy on all vertices
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

}  // namespace mimetra
