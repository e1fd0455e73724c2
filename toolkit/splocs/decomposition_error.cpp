#include "toolkit/splocs/decomposition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/splocs/motion.h"
#include "toolkit/splocs/reduction.h"

namespace mimetra {
namespace {

void require_same_size(const SequencePart& sequence, const Components& components,
                       Eigen::Index vertices) {
  if (components.vertices() != vertices) {
    throw MismatchError("components of " + std::to_string(components.vertices()) +
                        " vertices for a sequence of " + std::to_string(vertices));
  }
  if (components.weights.rows() != sequence.frames.frames()) {
    throw MismatchError("components with weights of " + std::to_string(components.weights.rows()) +
                        " frames for a sequence of " + std::to_string(sequence.frames.frames()));
  }
}

/// Frames whose residual is held at once.
constexpr Eigen::Index kErrorRows = 512;

/// Sums over vertices.
struct ErrorSums {
  double residual2 = 0;   ///< ||X - W C||^2
  double variation2 = 0;  ///< ||X - mean over frames||^2
  double zeros = 0;       ///< displacements in C that are exactly zero
};

/// Components at the vertices of block b, in the layout of X's blocks (K x 3m).
VertexBlocks<double>::Block block_of(const Frames& C, const BlockSource<double>& X, int b) {
  VertexBlocks<double>::Block block(C.rows(), 3 * X.size(b));
  for (Eigen::Index k = 0; k < C.rows(); ++k) {
    VertexBlocks<double>::by_vertex(block, k) =
        PositionsView(C.row(k).data() + 3 * X.first(b), X.size(b), 3);
  }
  return block;
}

/// Sums the residual itself, block by block, because its value matters even when it is only
/// rounding.
ErrorSums error_sums(const BlockSource<double>& X, const Components& components,
                     const Reduction& reduction) {
  const auto add_block = [&](int b, Eigen::MatrixXd& sums) {
    const auto C = block_of(components.displacements, X, b);
    const auto motion = X.block(b);
    const Eigen::RowVectorXd mean = motion->colwise().mean();
    VertexBlocks<double>::Block rows;
    for (Eigen::Index first = 0; first < X.rows(); first += kErrorRows) {
      const Eigen::Index count = std::min(kErrorRows, X.rows() - first);
      rows = motion->middleRows(first, count);
      rows.noalias() -= components.weights.middleRows(first, count) * C;
      sums(0) += rows.squaredNorm();
      sums(1) += (motion->middleRows(first, count).rowwise() - mean).squaredNorm();
    }
    for (Eigen::Index k = 0; k < C.rows(); ++k) {
      const auto lengths = VertexBlocks<double>::by_vertex(C, k).rowwise().squaredNorm();
      sums(2) += static_cast<double>((lengths.array() == 0).count());
    }
  };
  const Eigen::VectorXd sums =
      reduction.everywhere(reduction.sum(3, 1, [&](int run, Eigen::MatrixXd& of_run) {
        const IndexRange blocks = reduction.part().blocks_of(run);
        for (int b = blocks.first; b < blocks.end; ++b) add_block(b, of_run);
      }));
  return {sums[0], sums[1], sums[2]};
}

/// Motion for one pass: read from the sequence if it can read single vertices, otherwise kept.
std::unique_ptr<BlockSource<double>> motion_of(const SequencePart& sequence,
                                               const Components& components,
                                               const Reduction& reduction, MotionPlace place) {
  const SequencePart part{components.rest, sequence.triangles, sequence.frames};
  if (sequence.frames.reads_vertices()) {
    return read_displacements(part, reduction.part());
  }
  return kept_displacements(part, reduction.part(), place, reduction.context());
}

/// Distance within which `share` of the energy lies (both N); +infinity if the vertices that can be
/// reached contain less.
double radius_holding(double share, const Eigen::VectorXd& energies,
                      const Eigen::VectorXd& distances) {
  std::vector<int> order(energies.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return distances[a] < distances[b]; });
  // Add in the same order as below, so that a share of 1 is reached exactly.
  double total = 0;
  for (const int v : order) total += energies[v];
  double held = 0;
  for (const int v : order) {
    held += energies[v];
    if (held >= share * total) return distances[v];
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

DecompositionError decomposition_error(const FrameSource& sequence, const Components& components,
                                       const Context& context) {
  const Ranks& ranks = context.ranks();
  if (ranks.count() == 1) {
    const SequencePart whole{sequence.rest(), sequence.triangles(), sequence};
    return decomposition_error(whole, components, context);
  }
  const VertexPart part(sequence.vertices(), ranks.rank(), ranks.count());
  const auto own = own_vertices(sequence, part);
  Components of_part = components;
  of_part.displacements =
      components.displacements.middleCols(3 * part.first(), 3 * part.vertices());
  return decomposition_error(SequencePart{sequence.rest(), sequence.triangles(), *own}, of_part,
                             context);
}

DecompositionError decomposition_error(const SequencePart& sequence, const Components& components,
                                       const Context& context) {
  fix_product_blocking();
  const auto vertices = sequence.rest.rows();
  require_same_size(sequence, components, vertices);
  const VertexPart part = Reduction(vertices, context).part();
  const DecompositionPlan plan =
      planned_decomposition(sequence.frames, part, components.options, context);
  const Reduction reduction(vertices, context.with_threads(plan.threads));
  const auto X = motion_of(sequence, components, reduction, plan.place);
  const ErrorSums sums = error_sums(*X, components, reduction);
  const double residual = std::sqrt(sums.residual2), variation = std::sqrt(sums.variation2);
  const double diagonal = box_diagonal(components.rest);
  const auto displacements = static_cast<double>(vertices) * components.count();
  const double coordinates =
      std::sqrt(3 * static_cast<double>(vertices) * static_cast<double>(sequence.frames.frames()));
  DecompositionError error;
  error.rms = residual / coordinates;
  error.relative_rms = diagonal > 0 ? error.rms / diagonal : 0;
  // If all frames are the same, their variation is only rounding.
  constexpr double kRounding = 1e-12;
  const bool varies = variation > kRounding * coordinates * diagonal;
  error.kg = varies ? 100 * residual / variation : 0;
  error.sparsity = displacements > 0 ? sums.zeros / displacements : 0;
  return error;
}

Eigen::VectorXd energy_radius(const Components& components, const DistanceFunction& distances,
                              double share) {
  if (!(share > 0 && share <= 1)) {
    throw std::invalid_argument("share is " + std::to_string(share) + "; it must be in (0, 1]");
  }
  std::vector<int> alive;
  std::vector<VertexIndex> centers;
  for (int k = 0; k < components.count(); ++k) {
    if (components.centers[k] < 0) continue;
    alive.push_back(k);
    centers.push_back(components.centers[k]);
  }
  const Eigen::MatrixXd from_centers = distances(centers);
  Eigen::VectorXd radius = Eigen::VectorXd::Zero(components.count());
  for (std::size_t i = 0; i < alive.size(); ++i) {
    radius[alive[i]] =
        radius_holding(share, vertex_energies(components.displacements.row(alive[i])),
                       from_centers.col(static_cast<Eigen::Index>(i)));
  }
  return radius;
}

}  // namespace mimetra
