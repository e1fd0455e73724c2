#include "toolkit/splocs/decomposition.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"
#include "toolkit/splocs/vertex_energies.h"

namespace mimetra {
namespace {

void require_same_size(const MeshSequence& sequence, const Components& components) {
  if (components.vertices() != sequence.vertices()) {
    throw MismatchError("components of " + std::to_string(components.vertices()) +
                        " vertices for a sequence of " + std::to_string(sequence.vertices()));
  }
  if (components.weights.rows() != sequence.frames()) {
    throw MismatchError("components with weights of " + std::to_string(components.weights.rows()) +
                        " frames for a sequence of " + std::to_string(sequence.frames()));
  }
}

/// ||X - W C||^2 frame by frame: here the residual itself matters, also where it is rounding.
double residual_norm2(const MeshSequence& sequence, const Components& components) {
  const Eigen::Map<const Eigen::RowVectorXd> rest(components.rest.data(), components.rest.size());
  double sum = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    Eigen::RowVectorXd residual = sequence.positions().row(f) - rest;
    residual.noalias() -= components.weights.row(f) * components.displacements;
    sum += residual.squaredNorm();
  }
  return sum;
}

double sparsity(const Frames& displacements) {
  Eigen::Index zeros = 0;
  for (Eigen::Index k = 0; k < displacements.rows(); ++k) {
    zeros += (vertex_energies(displacements.row(k)).array() == 0).count();
  }
  const Eigen::Index all = displacements.size() / 3;
  return all ? static_cast<double>(zeros) / static_cast<double>(all) : 0;
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
  require_same_size(sequence, components);
  const double residual = std::sqrt(residual_norm2(sequence, components));
  const Frames& frames = sequence.positions();
  const Eigen::RowVectorXd mean = frames.colwise().mean();
  const double variation = (frames.rowwise() - mean).norm();
  const double diagonal = box_diagonal(components.rest);
  DecompositionError error;
  error.rms = residual / std::sqrt(static_cast<double>(frames.size()));
  error.relative_rms = diagonal > 0 ? error.rms / diagonal : 0;
  error.kg = variation > 0 ? 100 * residual / variation : 0;
  error.sparsity = sparsity(components.displacements);
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
