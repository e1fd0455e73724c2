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

/// Different centres that a component has over the iterations, measured with K = 40. Their
/// distances are kept as far as SurfaceDistances does.
constexpr double kCentersPerComponent = 8;

/// A thread holds the block that it reads; in measurements the C library kept as much freed memory.
constexpr double kBlocksPerThread = 2;

/// Copies of a run's sums (P, H and penalties) that a thread holds: in the loop's precision, in
/// double, and joined with another run.
constexpr double kSumsPerThread = 3;

/// Levels of the tree that joins 64 runs; each may hold one matrix.
constexpr double kLevels = 6;

/// Matrices of frames x components: weights, the best iterate, their coordinates in a basis, P
/// twice, and temporaries of a step.
constexpr double kWeightMatrices = 6;

/// Poses that a basis of a face's motion may have. If less memory is left beside the motion, the
/// motion is kept elsewhere.
constexpr double kPosesBesideMotion = 256;

/// Matrices of frames x poses during the orthonormalisation of a sketch.
constexpr double kOrthonormalized = 4;

/// Costs relative to a pass over the motion in a file: a pass that reads the sequence again, and
/// writing and scaling the file once. Measured on 20 000 frames of 6706 vertices.
constexpr double kReadAgain = 1.8, kWriteOnce = 6.5;

struct Sizes {
  double frames, vertices, mesh_vertices, count;

  double motion() const { return kNumber * frames * 3 * vertices; }
  double block() const {
    return kNumber * frames * 3 * std::min<double>(VertexPart::kBlock, vertices);
  }
  double sums() const { return kNumber * (frames + count + 1) * count; }
  /// Bytes that do not depend on the number of threads.
  double fixed() const {
    // C, the best iterate, the dual variable, and the result.
    const double components = 4 * count * 3 * vertices;
    // The rank's maps, and maps of the whole mesh while they are computed from distances.
    const double maps = 2 * count * vertices + 2 * count * mesh_vertices;
    const double distances = std::min(kNumber * kCentersPerComponent * count * mesh_vertices,
                                      double{SurfaceDistances::kKeptBytes});
    // The last block is smaller than the others and cannot reuse their memory.
    return kFactorsPerVertex * mesh_vertices +
           kNumber * (components + maps + kWeightMatrices * frames * count) + distances +
           kLevels * sums() + block();
  }
  /// Bytes for each pose of a basis search. They cover the sketch, its sums on each thread and tree
  /// level, and random signs of a block. Afterwards they cover two bases and the motion in both.
  double of_pose(int threads) const {
    const double signs = 3 * std::min<double>(VertexPart::kBlock, vertices);
    const double sketch = (threads + kLevels + kOrthonormalized) * frames + threads * signs;
    // A basis also has at most half as many directions as frames.
    return kNumber * std::max(sketch, 3 * frames + 6 * vertices);
  }
  double per_thread() const { return kBlocksPerThread * block() + kSumsPerThread * sums(); }
};

/// Passes over the motion: energies, each component of the start, the first products, and each
/// iteration.
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
  // Single precision rounds the motion once, so it must be kept.
  if (!frames.reads_vertices() || options.precision == IterationPrecision::single_precision) {
    return MotionPlace::scratch;
  }
  const double again = kReadAgain * passes(options), kept = kWriteOnce + passes(options);
  return again < kept || !disk_has_room(bytes) ? MotionPlace::sequence : MotionPlace::scratch;
}

/// Rounds up, so that the requested memory is enough.
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
  // Search among as many poses as are useful and fit.
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
