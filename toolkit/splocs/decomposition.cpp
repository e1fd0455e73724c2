#include "toolkit/splocs/decomposition.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/splocs/decomposition_plan.h"
#include "toolkit/splocs/motion.h"
#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/start.h"
#include "toolkit/splocs/time_basis.h"
#include "toolkit/splocs/updates.h"

namespace mimetra {
namespace {

// The start takes about as long as this number of iterations. Used for progress.
constexpr double kStartIterations = 5;

// Small changes of the energy in a row that mean convergence. One alone is not enough: on a face
// with K = 40 it came at iteration 65, and the energy fell again when support maps moved.
constexpr int kSmallChanges = 3;

void require(bool condition, const std::string& message) {
  if (!condition) throw std::invalid_argument(message);
}

void require_valid(const DecompositionOptions& options) {
  check_options(options);
  require(options.basis_tolerance == 0 || options.basis_tolerance >= kLeastBasisTolerance,
          "basis_tolerance must be 0, or from 1e-6 to 0.5");
}

void require_valid(double d_min, double d_max) {
  require(0 <= d_min && d_min < d_max && std::isfinite(d_max),
          "d_min is " + std::to_string(d_min) + " and d_max " + std::to_string(d_max) +
              "; 0 <= d_min < d_max is needed");
}

void require_valid(const PartWeights& parts, int vertices) {
  if (parts.empty()) return;
  require(static_cast<int>(parts.of_vertex.size()) == vertices,
          "parts: " + std::to_string(parts.of_vertex.size()) + " vertices, expected " +
              std::to_string(vertices));
  const auto count = static_cast<int>(parts.weights.size());
  require(std::ranges::all_of(parts.of_vertex, [&](int p) { return 0 <= p && p < count; }),
          "parts: each vertex must be on one of " + std::to_string(count));
  require(std::ranges::all_of(parts.weights, [](double w) { return 0 <= w && w <= 1; }),
          "parts: weights must be from 0 to 1");
}

/// Sizes given to each rank: one column per rank.
enum GivenRow { kVertices, kFrames, kCoordinates, kFiniteRest, kGivenRows };

/// Collects the sizes of all ranks, on all ranks. Each rank is asked in turn, because they cannot
/// join anything before they agree on the number of vertices, and some may own none.
Eigen::MatrixXd given_to_ranks(const SequencePart& sequence, const Reduction& reduction) {
  Eigen::MatrixXd given(kGivenRows, reduction.part().ranks());
  for (int rank = 0; rank < reduction.part().ranks(); ++rank) {
    given.col(rank) = reduction.on(rank, [&sequence] {
      return Eigen::Vector4d(static_cast<double>(sequence.rest.rows()),
                             static_cast<double>(sequence.frames.frames()),
                             3.0 * sequence.frames.vertices(), sequence.rest.allFinite() ? 1 : 0);
    });
  }
  return given;
}

/// Throws the same error on all ranks, whichever rank received the wrong input.
void require_decomposable(const SequencePart& sequence, int count, const Reduction& reduction) {
  const auto given = given_to_ranks(sequence, reduction).cast<Eigen::Index>().eval();
  const Eigen::Index vertices = given(kVertices, 0), frames = given(kFrames, 0);
  for (int rank = 0; rank < given.cols(); ++rank) {
    const auto of_rank = given.col(rank);
    const auto require_of_rank = [rank](Eigen::Index found, Eigen::Index expected,
                                        const std::string& of_what) {
      require(found == expected, "rank " + std::to_string(rank) + " has " + std::to_string(found) +
                                     of_what + ", expected " + std::to_string(expected));
    };
    require_of_rank(of_rank[kVertices], vertices, " vertices in its mesh");
    require_of_rank(of_rank[kFrames], frames, " frames");
    require_of_rank(of_rank[kCoordinates],
                    3 * VertexPart(vertices, rank, static_cast<int>(given.cols())).vertices(),
                    " coordinates a frame");
  }
  if (count > 3 * vertices) {
    throw MismatchError(std::to_string(count) + " components of a mesh of " +
                        std::to_string(vertices) + " vertices; at most " +
                        std::to_string(3 * vertices));
  }
  if (frames < 2) {
    throw MismatchError("the sequence has one frame; a decomposition needs at least two");
  }
  require((given.row(kFiniteRest).array() == 1).all(),
          "the rest pose has a coordinate that is not a finite number");
}

/// ||X - W C||^2 + penalty without the residual, from P = X C^T (F x K), H = C C^T and W^T W. The
/// terms cancel down to the rounding of the data, 1e-16 of ||X||^2. An exact fit leaves that with
/// either sign.
double energy(double X_norm2, const Eigen::MatrixXd& W, const Eigen::MatrixXd& gram,
              const Eigen::MatrixXd& P, const Eigen::MatrixXd& H, double penalty) {
  const double mixed = W.cwiseProduct(P).sum();
  const double square = gram.cwiseProduct(H).sum();
  return std::max(0.0, X_norm2 - 2 * mixed + square) + penalty;
}

bool has_converged(const std::vector<double>& energies, double tolerance) {
  const auto count = static_cast<int>(energies.size());
  if (count <= kSmallChanges) return false;
  for (int i = count - kSmallChanges; i < count; ++i) {
    if (std::abs(energies[i - 1] - energies[i]) > tolerance * energies[i - 1]) return false;
  }
  return true;
}

/// Index of the least energy; ties go to the first.
int best_of(const std::vector<double>& energies) {
  int best = 0;
  for (int i = 1; i < static_cast<int>(energies.size()); ++i) {
    if (energies[i] < (1 - kNearTie) * energies[best]) best = i;
  }
  return best;
}

/// Result of an iteration.
template <typename Scalar>
struct Iterate {
  Eigen::MatrixXd W;  ///< on the first rank
  VertexBlocks<Scalar> C;
  Frames maps;
};

/// Alternates between weights and components. Fills in displacements, weights and support of the
/// returned iterate, the energies and the convergence. `X` is the motion's frames, or their
/// coordinates in `basis` if there is one. Only the first rank computes weights.
template <typename Scalar>
void alternate(Components& result, double X_norm2, const BlockSource<Scalar>& X,
               const std::optional<TimeBasis>& basis, Start start, SupportMaps support,
               const Context& context) {
  const Reduction reduction(X.part().mesh_vertices(), context);
  const DecompositionOptions& options = result.options;
  const AdmmOptions admm{options.sparsity, options.rho, options.admm_iterations};
  const auto over_frames = [&basis](const Eigen::MatrixXd& P) -> Eigen::MatrixXd {
    return basis ? Eigen::MatrixXd(basis->Q * P) : P;
  };
  Eigen::MatrixXd W = std::move(start.weights), P;
  ComponentUpdate<Scalar> components =
      initial_components(X, std::move(start.components).template cast<Scalar>(), reduction);
  if (reduction.is_first()) P = over_frames(components.P);
  std::vector<double>& energies = result.energies;
  Iterate<Scalar> best;
  for (int iteration = 0; iteration < *options.iterations; ++iteration) {
    context.report(static_cast<double>(iteration) / *options.iterations);
    // Save the best iterate so far before the next iteration overwrites it.
    if (options.returned == ReturnedIterate::best && iteration > 0 &&
        best_of(energies) == iteration - 1) {
      // Assign one by one, to reuse the memory of the last copy.
      best.W = W;
      best.C = components.C;
      best.maps = support.maps();
    }
    UpdateWeights weights;
    if (reduction.is_first()) {
      W = updated_weights(std::move(W), P, components.H, options.nonnegative);
      weights = {basis ? Eigen::MatrixXd(basis->Q.transpose() * W) : W, W.transpose() * W};
    }
    support.follow(components.C, reduction);
    components =
        updated_components(X, weights, support.maps(), std::move(components), admm, reduction);
    const Eigen::MatrixXd found = reduction.on_first([&] {
      P = over_frames(components.P);
      return Eigen::MatrixXd::Constant(
          1, 1, energy(X_norm2, W, weights.gram, P, components.H, components.penalty));
    });
    energies.push_back(found(0));
    if (options.tolerance > 0 && has_converged(energies, options.tolerance)) break;
  }
  result.converged = has_converged(
      energies, options.tolerance > 0 ? options.tolerance : DecompositionOptions::kUsualTolerance);
  const auto last = static_cast<int>(energies.size()) - 1;
  const int returned = options.returned == ReturnedIterate::best ? best_of(energies) : last;
  result.iteration = returned + 1;
  if (returned == last) best = {std::move(W), std::move(components.C), support.maps()};
  result.displacements = best.C.frames();
  result.weights = reduction.everywhere(std::move(best.W));
  result.support = std::move(best.maps);
}

/// Motion in single precision; each block is released once it is converted.
std::unique_ptr<BlockSource<float>> in_single_precision(KeptBlocks<double>& X, MotionPlace place) {
  auto result = kept_blocks<float>(place, X.rows(), X.part());
  for (int b = 0; b < X.count(); ++b) {
    result->put(b, X.block(b)->cast<float>());
    X.release(b);
  }
  return result;
}

/// Number of poses that the first rank planned, so that all ranks search the same basis.
Eigen::Index poses_for_all(const DecompositionPlan& plan, const Reduction& reduction) {
  const Eigen::MatrixXd poses = reduction.everywhere(
      Eigen::MatrixXd(Eigen::MatrixXd::Constant(1, 1, static_cast<double>(plan.poses))));
  return static_cast<Eigen::Index>(poses(0));
}

/// Runs the iterations from `start` in the precision and the basis of the options.
void iterate(Components& result, Motion motion, Start start, SupportMaps support,
             const DecompositionPlan& plan, const Context& context) {
  const DecompositionOptions& options = result.options;
  // Share of the progress.
  const double basis_share = options.basis_tolerance > 0 ? 0.3 : 0;
  std::optional<TimeBasis> basis;
  if (options.basis_tolerance > 0) {
    const Eigen::Index most =
        poses_for_all(plan, Reduction(motion.X->part().mesh_vertices(), context));
    basis = time_basis(*motion.X, motion.norm2, options.basis_tolerance, most,
                       context.part(0, basis_share));
    if (!basis && most < motion.X->rows() / 2) {
      throw MismatchError(
          "option 'basis-tolerance': the motion needs a basis of many poses, of which option "
          "'memory' holds " +
          std::to_string(most) +
          "; allow more memory or a larger tolerance, or take all frames: tolerance 0");
    }
  }
  const Context of_iterations = context.part(basis_share, 1);
  MotionPlace place = plan.place;
  if (basis) {
    // Release the motion, the largest array of all.
    auto B = std::make_unique<VertexBlocks<double>>(std::move(basis->B));
    motion.kept = B.get();
    motion.X = std::move(B);
    place = MotionPlace::memory;
  }
  if (options.precision == IterationPrecision::single_precision) {
    const auto X = in_single_precision(*motion.kept, place);
    motion.X.reset();
    alternate(result, motion.norm2, *X, basis, std::move(start), std::move(support), of_iterations);
  } else {
    alternate(result, motion.norm2, *motion.X, basis, std::move(start), std::move(support),
              of_iterations);
  }
}

/// Finds each component's centre. A component needs both weights and displacements: if one is zero,
/// both are cleared.
void finish(Components& result, const Reduction& reduction) {
  const VertexPart& part = reduction.part();
  const Eigen::VectorXd weights = result.options.parts.of_vertices();
  result.centers = reduction.argmax(result.count(), [&](int b) {
    const Eigen::Index first = part.first_of(b), size = part.size_of(b);
    Eigen::MatrixXd energies(result.count(), size);
    for (int k = 0; k < result.count(); ++k) {
      energies.row(k) = vertex_energies(result.displacements.row(k).segment(3 * first, 3 * size));
    }
    if (weights.size() > 0) energies *= weights.segment(part.first() + first, size).asDiagonal();
    return energies;
  });
  for (int k = 0; k < result.count(); ++k) {
    if (result.weights.col(k).isZero(0)) result.centers[k] = -1;
    if (result.centers[k] >= 0) continue;
    result.weights.col(k).setZero();
    result.displacements.row(k).setZero();
  }
  result.displacements *= result.scale;
}

/// Distributes sources to the ranks by vertex, so that each rank computes and keeps its own.
DistanceFunction dealt(DistanceFunction distances, const Reduction& reduction) {
  return [distances = std::move(distances), &reduction](std::span<const VertexIndex> sources) {
    const int ranks = reduction.part().ranks();
    Eigen::MatrixXd all(reduction.part().mesh_vertices(), sources.size());
    for (int rank = 0; rank < ranks; ++rank) {
      std::vector<VertexIndex> share;
      std::vector<int> columns;
      for (std::size_t s = 0; s < sources.size(); ++s) {
        if (sources[s] % ranks != rank) continue;
        share.push_back(sources[s]);
        columns.push_back(static_cast<int>(s));
      }
      if (share.empty()) continue;
      all(Eigen::all, columns) = reduction.on(rank, [&] { return distances(share); });
    }
    return all;
  };
}

/// Columns of all ranks side by side, on all ranks. Every vertex has `width` columns.
Eigen::MatrixXd gathered(const Eigen::MatrixXd& own, int width, const Reduction& reduction) {
  const VertexPart& part = reduction.part();
  Eigen::MatrixXd all(own.rows(), width * part.mesh_vertices());
  for (int rank = 0; rank < part.ranks(); ++rank) {
    const VertexPart of_rank(part.mesh_vertices(), rank, part.ranks());
    all.middleCols(width * of_rank.first(), width * of_rank.vertices()) =
        reduction.on(rank, [&own] { return own; });
  }
  return all;
}

}  // namespace

Eigen::VectorXd PartWeights::of_vertices() const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(of_vertex.size()));
  for (Eigen::Index v = 0; v < result.size(); ++v) result[v] = weights[of_vertex[v]];
  return result;
}

Components decompose(const FrameSource& sequence, const DecompositionOptions& options,
                     const Context& context) {
  if (context.ranks().count() == 1) {
    return decompose_part({sequence.rest(), sequence.triangles(), sequence}, options, context);
  }
  const Reduction reduction(sequence.vertices(), context);
  const auto own = own_vertices(sequence, reduction.part());
  DecompositionOptions shared = options;
  if (shared.distances) shared.distances = dealt(shared.distances, reduction);
  Components components =
      decompose_part({sequence.rest(), sequence.triangles(), *own}, shared, context);
  components.displacements = gathered(components.displacements, 3, reduction);
  components.support = gathered(components.support, 1, reduction);
  return components;
}

Components decompose_part(const SequencePart& sequence, const DecompositionOptions& options,
                          const Context& context) {
  require_valid(options);
  const auto vertices = static_cast<int>(sequence.rest.rows());
  Reduction reduction(vertices, context);
  require_decomposable(sequence, options.count, reduction);
  const VertexPart part = reduction.part();
  const DecompositionPlan plan = planned_decomposition(sequence.frames, part, options, context);
  const Context planned = context.with_threads(plan.threads);
  reduction = Reduction(vertices, planned);
  require_valid(options.parts, vertices);
  fix_product_blocking();
  Components result;
  result.rest = sequence.rest;
  result.triangles = sequence.triangles;
  const double size = diameter(sequence.rest, sequence.triangles);
  result.d_min = options.d_min.value_or(DecompositionOptions::kMinimumShare * size);
  result.d_max = options.d_max.value_or(DecompositionOptions::kMaximumShare * size);
  require_valid(result.d_min, result.d_max);
  result.options = options;
  result.options.iterations = options.iterations.value_or(DecompositionOptions::kUsualIterations);
  result.options.distances = nullptr;

  Motion motion = scaled_motion(sequence, options.scale, reduction, plan.place);
  result.scale = motion.scale;
  const DistanceFunction distances =
      options.distances ? options.distances
                        : SurfaceDistances(result.rest, result.triangles, Weld::exact(result.rest),
                                           GeodesicMethod::heat, context);
  const SupportFunction support = support_function(distances, vertices, result.d_min, result.d_max);
  const double start_share = kStartIterations / (kStartIterations + *result.options.iterations);
  Start start = greedy_start(*motion.X, support, options, planned.part(0, start_share));
  iterate(result, std::move(motion), std::move(start),
          SupportMaps(support, options.count, part, options.parts.of_vertices()), plan,
          planned.part(start_share, 1));
  finish(result, reduction);
  context.report(1);
  return result;
}

}  // namespace mimetra
