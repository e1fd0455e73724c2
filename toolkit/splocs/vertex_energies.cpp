#include "toolkit/splocs/vertex_energies.h"

#include "toolkit/splocs/reduction.h"

namespace mimetra {

VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights) {
  return strongest_vertex(energies, weights, Reduction(energies.size()));
}

VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights, const Reduction& reduction) {
  const auto of_block = [&](int b) -> Eigen::MatrixXd {
    const Eigen::Index first = reduction.part().first_of(b), n = reduction.part().size_of(b);
    if (weights.size() == 0) return energies.segment(first, n).transpose();
    return energies.segment(first, n).cwiseProduct(weights.segment(first, n)).transpose();
  };
  return reduction.argmax(1, of_block).front();
}

Eigen::VectorXd vertex_energies(const Eigen::Ref<const Eigen::RowVectorXd>& component) {
  return PositionsView(component.data(), component.size() / 3, 3).rowwise().squaredNorm();
}

}  // namespace mimetra
