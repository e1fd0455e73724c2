#include "toolkit/pipeline/memory.h"

#include <algorithm>
#include <thread>

#include "toolkit/mesh/frame_store.h"
#include "toolkit/pipeline/distance_memory.h"
#include "toolkit/pipeline/region_selector.h"
#include "toolkit/splocs/reduction.h"

namespace mimetra {

namespace {

constexpr double kNumber = sizeof(double);

/// The factors of a mesh's sparse systems and its adjacency: measured on faces of 3 to 7 thousand
/// vertices, where fill-in grows little.
constexpr double kFactorsPerVertex = 2000;

/// A transfer's constant vectors, and for each thread sixteen frames: read, gathered, their sums,
/// what the sums are solved for, and the result.
constexpr double kPullPerTriangle = 72;
constexpr double kLanesPerVertex = 5 * 3 * 16 * kNumber;

double threads_of(const Context& context) {
  return context.threads() > 0 ? context.threads() : std::thread::hardware_concurrency();
}

/// What a FrameStore has in memory: more frames are in its file.
double kept_bytes(double all) {
  return all > static_cast<double>(FrameStore::kMemoryBytes) ? 0 : all;
}

}  // namespace

double frame_bytes(const FrameSource& sequence) {
  return kNumber * 3 * sequence.frames() * sequence.vertices();
}

double simplify_bytes(const FrameSource& sequence) {
  // Quadrics of six poses, positions and normals of 13, half-edges, and the decimater's heap.
  constexpr double kOfVertex = 2800;
  return kOfVertex * sequence.vertices();
}

double stored_bytes(const FrameSource& sequence) {
  return sequence.is_quick() ? 0 : kept_bytes(frame_bytes(sequence));
}

DecompositionPlan analysis_plan(const FrameSource& sequence, const AnalysisOptions& options,
                                const Context& context) {
  DecompositionOptions decomposition = decomposition_options(options);
  decomposition.count = component_count(sequence, sequence.diameter(), options);
  const GeodesicMethod method = options.distances.method;
  const int vertices = sequence.vertices(), sources = decomposition.count;
  DecompositionPlan plan =
      planned_decomposition(sequence, Reduction(vertices, context).part(), decomposition,
                            beside_distances(method, vertices, sources, context));
  plan.bytes += distance_bytes(method, vertices, sources, context);
  return plan;
}

double selection_bytes(const FrameSource& sequence, const BlendshapeModel& target) {
  const double frames = std::min(sequence.frames(), RegionSelector::kMostFrames);
  const auto triangles = static_cast<double>(target.triangles().rows());
  const auto expressions = static_cast<double>(target.expressions().size());
  // The frames, what each triangle lacks in them, and what each disc shows.
  return kNumber * (frames * (3.0 * sequence.vertices() + 6 * triangles) +
                    RegionSelector::kCandidates * expressions * (expressions + frames)) +
         kFactorsPerVertex * sequence.vertices();
}

double solution_bytes(const FrameSource& sequence, const BlendshapeModel& target,
                      const SolveOptions& options, const Context& context) {
  const auto expressions = static_cast<double>(target.expressions().size());
  const double vertices = target.vertices(),
               triangles = static_cast<double>(target.triangles().rows());
  // The displacement fields at the vertices that are looked at, those of the result, and its
  // weights; or factors, and the poses of a short result.
  const double poses = kNumber * 3 * vertices * sequence.frames();
  const bool has_vertices = solves_for_vertices(target, options.space);
  double space = has_vertices ? kFactorsPerVertex * vertices + kept_bytes(poses)
                              : kNumber * expressions * (6 * vertices + 2 * sequence.frames());
  // What is smoothed over time is there as a whole: poses, or a banded system of all weights.
  if (options.smoothness > 0) {
    space += has_vertices ? poses : kNumber * 4 * sequence.frames() * expressions * expressions;
  }
  const double threads = threads_of(context);
  return space + kPullPerTriangle * triangles + threads * kLanesPerVertex * vertices;
}

double regional_bytes(const FrameSource& sequence, const BlendshapeModel& target, int regions,
                      const Context& context) {
  const auto expressions = static_cast<double>(target.expressions().size());
  const double unknowns = (regions + 1) * expressions;
  const double threads = threads_of(context);
  // The Gram matrix, the system and for each thread its factor; each thread's fields of a region,
  // gathered and shared out; the shares, twice, and the weights.
  return kNumber *
         ((2 + 2 * threads) * unknowns * unknowns + threads * 6 * expressions * target.vertices() +
          2.0 * (regions + 1) * target.vertices() + 2 * unknowns * sequence.frames());
}

}  // namespace mimetra
