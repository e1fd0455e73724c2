#include "toolkit/splocs/vertex_energies.h"

#include <algorithm>

#include "toolkit/mesh/near_tie.h"

namespace mimetra {

VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies,
                             const Eigen::VectorXd& weights) {
  const Eigen::VectorXd weighted =
      weights.size() > 0 ? energies.cwiseProduct(weights) : Eigen::VectorXd(energies);
  const double largest = weighted.size() > 0 ? weighted.maxCoeff() : 0;
  if (!(largest > 0)) return -1;
  const double as_large = (1 - kNearTie) * largest;
  return static_cast<VertexIndex>(
      std::ranges::find_if(weighted, [as_large](double x) { return x >= as_large; }) -
      weighted.begin());
}

Eigen::VectorXd vertex_energies(const Eigen::Ref<const Eigen::RowVectorXd>& component) {
  return PositionsView(component.data(), component.size() / 3, 3).rowwise().squaredNorm();
}

}  // namespace mimetra
