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

SupportMaps::SupportMaps(SupportFunction support, int components, const VertexPart& part,
                         Eigen::VectorXd center_weights)
    : support_(std::move(support)),
      center_weights_(std::move(center_weights)),
      centers_(components, -1),
      maps_(Frames::Ones(components, part.vertices())) {}

template <typename Scalar>
void SupportMaps::follow(const VertexBlocks<Scalar>& components, const Reduction& reduction) {
  const VertexPart& part = reduction.part();
  const auto weighted_energies = [&](int b) {
    Eigen::MatrixXd energies(components.rows(), components.size(b));
    for (Eigen::Index k = 0; k < components.rows(); ++k) {
      energies.row(k) = components.by_vertex(components[b], k)
                            .rowwise()
                            .squaredNorm()
                            .transpose()
                            .template cast<double>();
    }
    if (center_weights_.size() > 0) {
      const auto weights =
          center_weights_.segment(part.first() + components.first(b), components.size(b));
      energies *= weights.asDiagonal();
    }
    return energies;
  };
  const std::vector<VertexIndex> centers =
      reduction.argmax(static_cast<int>(components.rows()), weighted_energies);
  std::vector<Eigen::Index> moved;
  std::vector<VertexIndex> moved_to;
  for (std::size_t k = 0; k < centers.size(); ++k) {
    if (centers[k] < 0 || centers[k] == centers_[k]) continue;
    centers_[k] = centers[k];
    moved.push_back(static_cast<Eigen::Index>(k));
    moved_to.push_back(centers[k]);
  }
  if (moved.empty()) return;
  const Eigen::MatrixXd maps = support_(moved_to);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    maps_.row(moved[i]) =
        maps.col(static_cast<Eigen::Index>(i)).segment(part.first(), part.vertices());
  }
}

template void SupportMaps::follow(const VertexBlocks<double>&, const Reduction&);
template void SupportMaps::follow(const VertexBlocks<float>&, const Reduction&);

}  // namespace mimetra
