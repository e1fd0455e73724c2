#include "toolkit/splocs/decomposition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/product_blocking.h"
#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/vertex_energies.h"

namespace mimetra {
namespace {

void require_same_size(const SequencePart& sequence, const Components& components,
                       Eigen::Index vertices) {
  if (components.vertices() != vertices) {
    throw MismatchError("components of " + std::to_string(components.vertices()) +
                        " vertices for a sequence of " + std::to_string(vertices));
  }
  if (components.weights.rows() != sequence.frames.rows()) {
    throw MismatchError("components with weights of " + std::to_string(components.weights.rows()) +
                        " frames for a sequence of " + std::to_string(sequence.frames.rows()));
  }
}

/// Sums over vertices.
struct ErrorSums {
  double residual2 = 0;   ///< ||X - W C||^2
  double variation2 = 0;  ///< ||X - mean over frames||^2
  double zeros = 0;       ///< displacements in C that are exactly zero
};

/// The residual itself, block by block: here it matters also where it is rounding.
ErrorSums error_sums(const SequencePart& sequence, const Components& components,
                     const Reduction& reduction) {
  const VertexPart& part = reduction.part();
  const Eigen::Map<const Eigen::RowVectorXd> rest(components.rest.data(), components.rest.size());
  const auto add_block = [&](int b, Eigen::MatrixXd& sums) {
    const Eigen::Index first = 3 * part.first_of(b), size = 3 * part.size_of(b);
    const auto frames = sequence.frames.middleCols(first, size);
    const Frames C = components.displacements.middleCols(first, size);
    Frames rows = frames.rowwise() - rest.segment(3 * part.first() + first, size);
    rows.noalias() -= components.weights * C;
    sums(0) += rows.squaredNorm();
    const Eigen::RowVectorXd mean = frames.colwise().mean();
    rows = frames.rowwise() - mean;
    sums(1) += rows.squaredNorm();
    for (Eigen::Index k = 0; k < C.rows(); ++k) {
      sums(2) += static_cast<double>((vertex_energies(C.row(k)).array() == 0).count());
    }
  };
  const Eigen::VectorXd sums =
      reduction.everywhere(reduction.sum(3, 1, [&](int run, Eigen::MatrixXd& of_run) {
        const IndexRange blocks = part.blocks_of(run);
        for (int b = blocks.first; b < blocks.end; ++b) add_block(b, of_run);
      }));
  return {sums[0], sums[1], sums[2]};
}

/// Distance within which `share` of the energy lies (both N); +infinity where the reachable
/// vertices do not hold it.
double radius_holding(double share, const Eigen::VectorXd& energies,
                      const Eigen::VectorXd& distances) {
  std::vector<int> order(energies.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return distances[a] < distances[b]; });
  // The same sum in the same order below, so that a share of 1 is reached exactly.
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

DecompositionError decomposition_error(const MeshSequence& sequence, const Components& components) {
  return decomposition_error({sequence.rest(), sequence.triangles(), sequence.positions()},
                             components, Reduction(sequence.vertices()));
}

DecompositionError decomposition_error(const SequencePart& sequence, const Components& components,
                                       const Reduction& reduction) {
  fix_product_blocking();
  const auto vertices = reduction.part().mesh_vertices();
  require_same_size(sequence, components, vertices);
  const ErrorSums sums = error_sums(sequence, components, reduction);
  const double residual = std::sqrt(sums.residual2), variation = std::sqrt(sums.variation2);
  const double diagonal = box_diagonal(components.rest);
  const auto displacements = static_cast<double>(vertices) * components.count();
  DecompositionError error;
  error.rms = residual / std::sqrt(3 * static_cast<double>(vertices) *
                                   static_cast<double>(sequence.frames.rows()));
  error.relative_rms = diagonal > 0 ? error.rms / diagonal : 0;
  error.kg = variation > 0 ? 100 * residual / variation : 0;
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
