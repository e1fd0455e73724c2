#include "toolkit/splocs/support_maps.h"

#include <stdexcept>
#include <string>
#include <utility>

#include "geodesic/support_map.h"
#include "toolkit/splocs/vertex_energies.h"

namespace mimetra {

SupportFunction support_function(DistanceFunction distances, int vertices, double d_min,
                                 double d_max) {
  return [distances = std::move(distances), vertices, d_min,
          d_max](std::span<const VertexIndex> centers) {
    Eigen::MatrixXd maps = distances(centers);
    if (maps.rows() != vertices || maps.cols() != static_cast<Eigen::Index>(centers.size())) {
      throw std::invalid_argument(
          "distances from " + std::to_string(centers.size()) + " of " + std::to_string(vertices) +
          " vertices: " + std::to_string(maps.rows()) + " x " + std::to_string(maps.cols()) +
          " values, expected one row a vertex and one column a source");
    }
    for (auto map : maps.colwise()) map = geodesic::support_map(map, d_min, d_max);
    return maps;
  };
}

SupportMaps::SupportMaps(SupportFunction support, int components, int vertices,
                         Eigen::VectorXd center_weights)
    : support_(std::move(support)),
      center_weights_(std::move(center_weights)),
      centers_(components, -1),
      maps_(Frames::Ones(components, vertices)) {}

template <typename Scalar>
void SupportMaps::follow(const VertexBlocks<Scalar>& components) {
  Eigen::VectorXd energies(components.vertices());
  std::vector<Eigen::Index> moved;
  std::vector<VertexIndex> moved_to;
  for (Eigen::Index k = 0; k < components.rows(); ++k) {
    for (int b = 0; b < components.count(); ++b) {
      energies.segment(components.first(b), components.size(b)) =
          components.by_vertex(components[b], k).rowwise().squaredNorm().template cast<double>();
    }
    const VertexIndex center = strongest_vertex(energies, center_weights_);
    if (center < 0 || center == centers_[k]) continue;
    centers_[k] = center;
    moved.push_back(k);
    moved_to.push_back(center);
  }
  if (moved.empty()) return;
  const Eigen::MatrixXd maps = support_(moved_to);
  for (std::size_t i = 0; i < moved.size(); ++i) maps_.row(moved[i]) = maps.col(i);
}

template void SupportMaps::follow(const VertexBlocks<double>&);
template void SupportMaps::follow(const VertexBlocks<float>&);

}  // namespace mimetra
