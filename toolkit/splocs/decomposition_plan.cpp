#include "toolkit/splocs/decomposition_plan.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {
namespace {

constexpr double kNumber = sizeof(double);

/// Components have so many different centres on their way, whose distances are kept as far as
/// SurfaceDistances does: measured with K = 40.
constexpr double kCentersPerComponent = 8;

/// A thread holds the block that it reads; measured, the C library keeps as much of what was freed.
constexpr double kBlocksPerThread = 2;

/// Sums of a run that a thread holds (P, H and penalties): in the precision of the loop, in double,
/// and what they are joined with.
constexpr double kSumsPerThread = 3;

/// Levels of the tree along which 64 runs are joined: each may hold one matrix.
constexpr double kLevels = 6;

/// Matrices of frames x components: weights, the best so far, those in a basis, P twice, and what a
/// step makes of them.
constexpr double kWeightMatrices = 6;

/// Poses that a basis of a face's motion may have; where the memory left holds fewer besides the
/// motion, that is kept elsewhere.
constexpr double kPosesBesideMotion = 256;

/// Matrices of frames x poses while the sketch of a basis is made orthonormal.
constexpr double kOrthonormalized = 4;

/// Working on the motion read once more from a sequence, and writing it into a file and scaling it
/// there, in times of working on it read from that file: measured on 20 000 frames of 6706
/// vertices.
constexpr double kReadAgain = 1.8, kWriteOnce = 6.5;

struct Sizes {
  double frames, vertices, mesh_vertices, count;

  double motion() const { return kNumber * frames * 3 * vertices; }
  double block() const {
    return kNumber * frames * 3 * std::min<double>(VertexPart::kBlock, vertices);
  }
  double sums() const { return kNumber * (frames + count + 1) * count; }
  /// What does not depend on the number of threads.
  double fixed() const {
    // C, the best so far, the dual variable, and what is returned.
    const double components = 4 * count * 3 * vertices;
    // Of all vertices while they are made of distances.
    const double maps = 2 * count * vertices + 2 * count * mesh_vertices;
    const double distances = std::min(kNumber * kCentersPerComponent * count * mesh_vertices,
                                      double{SurfaceDistances::kKeptBytes});
    // Memory of the last block, which is smaller, serves no other.
    return kFactorsPerVertex * mesh_vertices +
           kNumber * (components + maps + kWeightMatrices * frames * count) + distances +
           kLevels * sums() + block();
  }
  /// Each pose that a basis in time is looked for among: of the sketch, its sums on each thread and
  /// level of the tree, and random signs of a block; then two bases, and the motion in both.
  double of_pose(int threads) const {
    const double signs = 3 * std::min<double>(VertexPart::kBlock, vertices);
    const double sketch = (threads + kLevels + kOrthonormalized) * frames + threads * signs;
    // The directions, too, are no more than half the frames.
    return kNumber * std::max(sketch, 3 * frames + 6 * vertices);
  }
  double per_thread() const { return kBlocksPerThread * block() + kSumsPerThread * sums(); }
};

/// Passes over the motion: energies, one for each component of the start, the first products, and
/// one for each iteration.
double passes(const DecompositionOptions& options) {
  const int iterations = options.iterations.value_or(DecompositionOptions::kUsualIterations);
  return 2 + options.count + (options.basis_tolerance > 0 ? 4 : iterations);
}

bool disk_has_room(double bytes) {
  std::error_code error;
  const auto folder = std::filesystem::temp_directory_path(error);
  if (error) return false;
  const auto space = std::filesystem::space(folder, error);
  return !error && static_cast<double>(space.available) > bytes;
}

MotionPlace place_outside_memory(const FrameSource& frames, double bytes,
                                 const DecompositionOptions& options) {
  // In single precision the motion is rounded once.
  if (!frames.reads_vertices() || options.precision == IterationPrecision::single_precision) {
    return MotionPlace::scratch;
  }
  const double again = kReadAgain * passes(options), kept = kWriteOnce + passes(options);
  return again < kept || !disk_has_room(bytes) ? MotionPlace::sequence : MotionPlace::scratch;
}

/// Rounded up, so that what is asked for is enough.
std::string megabytes(double bytes) {
  return fixed(std::ceil(bytes / 1e6), 0) + " MB";
}

}  // namespace

DecompositionPlan planned_decomposition(const FrameSource& frames, const VertexPart& part,
                                        const DecompositionOptions& options,
                                        const Context& context) {
  const Sizes sizes{static_cast<double>(frames.frames()), static_cast<double>(part.vertices()),
                    static_cast<double>(part.mesh_vertices()), static_cast<double>(options.count)};
  const int threads = context.thread_count();
  const std::optional<double> memory = context.memory();
  const bool wants_basis = options.basis_tolerance > 0;
  const double worth = wants_basis ? frames.frames() / 2 : 0;
  // As many poses as are worth it and fit.
  const auto with_poses = [&](DecompositionPlan plan, int working) {
    const double of_pose = sizes.of_pose(working);
    const double fitting = memory ? std::max(0.0, (*memory - plan.bytes) / of_pose) : worth;
    plan.poses = static_cast<Eigen::Index>(std::min(worth, fitting));
    plan.bytes += static_cast<double>(plan.poses) * of_pose;
    return plan;
  };
  DecompositionPlan plan;
  plan.threads = context.threads();
  plan.bytes = sizes.fixed() + sizes.motion() + threads * sizes.per_thread();
  const double beside = std::min(worth, kPosesBesideMotion) * sizes.of_pose(threads);
  if (!memory || plan.bytes + beside <= *memory) return with_poses(plan, threads);

  const double free = *memory - sizes.fixed();
  if (free < sizes.per_thread()) {
    throw MismatchError(
        "option 'memory': what is left of it, " + megabytes(std::max(0.0, *memory)) +
        ", does not hold a decomposition of " + std::to_string(frames.frames()) + " frames into " +
        std::to_string(options.count) + " components; allow at least " +
        megabytes(sizes.per_thread() - free) + " more, or take fewer components or frames");
  }
  plan.threads = std::min(threads, static_cast<int>(free / sizes.per_thread()));
  plan.bytes = sizes.fixed() + plan.threads * sizes.per_thread();
  plan.place = place_outside_memory(frames, sizes.motion(), options);
  if (plan.place == MotionPlace::scratch) plan.scratch_bytes = sizes.motion();
  return with_poses(plan, plan.threads);
}

}  // namespace mimetra
