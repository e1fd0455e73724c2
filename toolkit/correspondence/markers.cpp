#include "toolkit/correspondence/markers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/product_blocking.h"

namespace mimetra {
namespace {

/// Points are in one plane where their smallest extent is this share of their largest.
constexpr double kFlat = 1e-3;

Positions places(const std::vector<Marker>& markers, VertexIndex Marker::*vertex,
                 const Positions& positions) {
  Positions result(static_cast<Eigen::Index>(markers.size()), 3);
  for (std::size_t i = 0; i < markers.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = positions.row(markers[i].*vertex);
  }
  return result;
}

Positions centred(const Positions& positions) {
  return positions.rowwise() - positions.colwise().mean();
}

void check_vertices(const std::vector<Marker>& markers, VertexIndex Marker::*vertex,
                    const Positions& positions, std::string_view mesh) {
  std::map<VertexIndex, std::size_t> earlier;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const VertexIndex v = markers[i].*vertex;
    const std::string what = "marker " + std::to_string(i + 1) + ": vertex " + std::to_string(v) +
                             " of the " + std::string(mesh);
    if (v < 0 || v >= positions.rows()) {
      throw MismatchError(what + ", which has vertices 0 to " +
                          std::to_string(positions.rows() - 1));
    }
    const auto [entry, added] = earlier.try_emplace(v, i);
    if (!added) {
      throw MismatchError(what + " is in marker " + std::to_string(entry->second + 1) + " too");
    }
  }
}

void check_not_flat(const Positions& markers, std::string_view mesh) {
  const Eigen::VectorXd sizes = Eigen::JacobiSVD<Positions>(centred(markers)).singularValues();
  if (sizes[2] > kFlat * sizes[0]) return;
  throw MismatchError("the markers lie in one plane of the " + std::string(mesh) +
                      "; add one that does not, such as the tip of the nose");
}

}  // namespace

void check_markers(const std::vector<Marker>& markers, const Positions& source,
                   const Positions& target) {
  check_vertices(markers, &Marker::source, source, "source");
  check_vertices(markers, &Marker::target, target, "target");
  if (markers.size() < kFewestMarkers) {
    throw MismatchError(std::to_string(markers.size()) + " markers, expected at least " +
                        std::to_string(kFewestMarkers));
  }
  check_not_flat(places(markers, &Marker::source, source), "source");
  check_not_flat(places(markers, &Marker::target, target), "target");
}

double affine_residual(const std::vector<Marker>& markers, const Positions& source,
                       const Positions& target) {
  fix_product_blocking();
  const Eigen::MatrixXd from = centred(places(markers, &Marker::source, source));
  const Eigen::MatrixXd to = centred(places(markers, &Marker::target, target));
  const Eigen::MatrixXd map = from.colPivHouseholderQr().solve(to);
  const double size = to.norm();
  return size > 0 ? (from * map - to).norm() / size : 0;
}

}  // namespace mimetra
