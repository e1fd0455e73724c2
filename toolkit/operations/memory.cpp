#include "toolkit/operations/memory.h"

#include <thread>

#include "toolkit/operations/analysis.h"
#include "toolkit/operations/solving.h"

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

double alignment_bytes(const Invocation& invocation, const SequenceRead& read) {
  return alignment_of(invocation, read) == HeadMotionSource(HeadMotion::none)
             ? 0
             : kNumber * numbers_of(read.sequence);
}

double analysis_bytes(const Invocation& invocation, const SequenceRead& read, int count) {
  if (invocation.find<Components>("components")) return 0;
  const double vertices = read.sequence.vertices();
  const double displacements = numbers_of(read.sequence);
  const double components = 2 * count * 3 * vertices;  // C and the dual variable
  const double maps = (1 + kCentersPerComponent) * count * vertices;
  return alignment_bytes(invocation, read) + kFactorsPerVertex * vertices +
         kNumber * (displacements + components + maps);
}

double solution_bytes(const Invocation& invocation, const SequenceRead& read,
                      const BlendshapeModel& target) {
  const double result = kNumber * numbers_of(read.sequence);
  const auto expressions = static_cast<double>(target.expressions().size());
  const double vertices = target.vertices(),
               triangles = static_cast<double>(target.triangles().rows());
  const bool by_vertices = solves_for_vertices(invocation.parameters, target);
  const double set_up =
      by_vertices ? kFactorsPerVertex * vertices : kNumber * expressions * 3 * vertices;
  const double threads =
      invocation.threads > 0 ? invocation.threads : std::thread::hardware_concurrency();
  return result + set_up + kPullPerTriangle * triangles + threads * kLanesPerVertex * vertices;
}

}  // namespace mimetra
