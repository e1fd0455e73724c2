#include <mimetra/splocs/support_maps.h>

#include <stdexcept>
#include <string>
#include <utility>

#include <mimetra/geodesic/support_map.h>

namespace mimetra {

VertexIndex strongest_vertex(const Eigen::Ref<const Eigen::VectorXd>& energies) {
  VertexIndex strongest = -1;
  double largest = 0;
  for (VertexIndex v = 0; v < energies.size(); ++v) {
    if (energies[v] > largest) {
      largest = energies[v];
      strongest = v;
    }
  }
  return strongest;
}

Eigen::VectorXd vertex_energies(const Eigen::Ref<const Eigen::RowVectorXd>& component) {
  return PositionsView(component.data(), component.size() / 3, 3).rowwise().squaredNorm();
}

SupportFunction support_function(DistanceFunction distances, int vertices, double d_min,
                                 double d_max) {
  return [distances = std::move(distances), vertices, d_min, d_max](VertexIndex center) {
    const Eigen::VectorXd from_center = distances(center);
    if (from_center.size() != vertices) {
      throw std::invalid_argument("distances from vertex " + std::to_string(center) + ": " +
                                  std::to_string(from_center.size()) + " values for " +
                                  std::to_string(vertices) + " vertices");
    }
    return geodesic::support_map(from_center, d_min, d_max);
  };
}

SupportMaps::SupportMaps(SupportFunction support, int components, int vertices)
    : support_(std::move(support)),
      centers_(components, -1),
      maps_(Eigen::MatrixXd::Ones(components, vertices)) {}

void SupportMaps::follow(const Frames& components) {
  for (Eigen::Index k = 0; k < components.rows(); ++k) {
    const VertexIndex center = strongest_vertex(vertex_energies(components.row(k)));
    if (center < 0 || center == centers_[k]) continue;
    centers_[k] = center;
    maps_.row(k) = support_(center);
  }
}

}  // namespace mimetra
