#include "toolkit/pipeline/memory.h"

#include <thread>

namespace mimetra {

namespace {

constexpr double kNumber = sizeof(double);

/// The factors of a mesh's sparse systems and its adjacency: measured on faces of 3 to 7 thousand
/// vertices, where fill-in grows little.
constexpr double kFactorsPerVertex = 2000;

/// A transfer's constant vectors, and for each thread three rows of sixteen frames a vertex.
constexpr double kPullPerTriangle = 72;
constexpr double kLanesPerVertex = 3 * 3 * 16 * kNumber;

/// Components have so many different centres on their way that their distances are kept.
constexpr double kCentersPerComponent = 4;

double numbers_of(const MeshSequence& sequence) {
  return static_cast<double>(sequence.positions().size());
}

}  // namespace

double alignment_bytes(const MeshSequence& sequence, const SourceOptions& options) {
  return takes_out_motion(sequence, options) ? kNumber * numbers_of(sequence) : 0;
}

double analysis_bytes(const MeshSequence& sequence, int count) {
  const double vertices = sequence.vertices();
  const double displacements = numbers_of(sequence);
  const double components = 2 * count * 3 * vertices;  // C and the dual variable
  const double maps = (1 + kCentersPerComponent) * count * vertices;
  return kFactorsPerVertex * vertices + kNumber * (displacements + components + maps);
}

double solution_bytes(const MeshSequence& sequence, const BlendshapeModel& target,
                      const SolveOptions& options) {
  const double result = kNumber * numbers_of(sequence);
  const auto expressions = static_cast<double>(target.expressions().size());
  const double vertices = target.vertices(),
               triangles = static_cast<double>(target.triangles().rows());
  const double set_up = solves_for_vertices(target, options.space)
                            ? kFactorsPerVertex * vertices
                            : kNumber * expressions * 3 * vertices;
  const double threads =
      options.threads > 0 ? options.threads : std::thread::hardware_concurrency();
  return result + set_up + kPullPerTriangle * triangles + threads * kLanesPerVertex * vertices;
}

}  // namespace mimetra
