#include "toolkit/correspondence/markers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string_view>
#include <utility>

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/rounding.h"
#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Points are coplanar if their smallest extent is this share of their largest.
constexpr double kFlat = 1e-3;

/// Fewer markers predict too little. With more, the matrix inverse takes seconds.
constexpr std::size_t kFewestChecked = 8, kMostChecked = 1000;

/// An affine map fits any four markers exactly, and needs more for a meaningful residual.
constexpr std::size_t kFewestForAffine = 6;

/// Largest share of the residual that correct vertex numbers leave. Sound markers of other faces
/// leave at most a third of the residual with numbers off by one.
constexpr double kFitsBetter = 0.5;

/// Largest share of the squared errors that remains after an exchange. The least for sound pairs,
/// on whole sets of faces and parts of them, is 0.42.
constexpr double kExchangedShare = 0.2;

/// An error of this multiple of the median is doubtful. The largest of sound markers is 6.
constexpr double kDoubtfulTimes = 12;

/// Smaller errors, as a share of the markers' size, are harmless, such as at lips that touch.
constexpr double kHarmless = 0.02;

/// Coplanar markers predict nothing outside their plane; smaller numbers are rounding.
constexpr double kUnpredicted = 1e-9;

/// A mirror image fits better if it leaves less than this share of the source's residual. The
/// largest on mirrored faces of other people is 0.29, the least on upright ones 3.
constexpr double kMirroredFit = 0.5;

/// Mean cosine between normals at markers. On pairs of faces it is at least 0.8.
constexpr double kFacingAlike = 0.4;

Positions positions_at(const std::vector<Marker>& markers, VertexIndex Marker::*vertex,
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

double size_of(const Positions& places) {
  return std::sqrt((places.rowwise() - places.colwise().mean()).rowwise().squaredNorm().mean());
}

/// Predicts the value at each point from the other points, without a solve for each. With the
/// matrix K of the spline's equations, the error at i is (K^-1 b)_i / (K^-1)_ii. The errors at i
/// and j together follow from the 2 x 2 block of both [Rippa 1999].
class LeaveOut {
 public:
  explicit LeaveOut(const Positions& points) {
    const Eigen::Index count = points.rows();
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(count + 4, count + 4);
    for (Eigen::Index i = 0; i < count; ++i) {
      K.row(i).head(count) = -(points.rowwise() - points.row(i)).rowwise().norm().transpose();
    }
    K.diagonal().head(count).setConstant(-kMarkerLooseness * K.topLeftCorner(count, count).mean());
    K.col(count).head(count).setOnes();
    K.block(0, count + 1, count, 3) = points;
    K.bottomLeftCorner(4, count) = K.topRightCorner(count, 4).transpose();
    inverse_ = K.fullPivLu().inverse().topLeftCorner(count, count);
    least_ = kUnpredicted * inverse_.diagonal().maxCoeff();
  }

  Positions coefficients(const Positions& values) const { return inverse_ * values; }

  /// Error at i: value minus prediction. Zero if the others do not predict it.
  Eigen::RowVector3d missed(const Positions& coefficients, Eigen::Index i) const {
    if (inverse_(i, i) <= least_) return Eigen::RowVector3d::Zero();
    return coefficients.row(i) / inverse_(i, i);
  }
  /// Length of the error at i, relative to the error expected at its distance from the others.
  double significance(const Positions& coefficients, Eigen::Index i) const {
    if (inverse_(i, i) <= least_) return 0;
    return coefficients.row(i).norm() / std::sqrt(inverse_(i, i));
  }
  /// Errors at i and j, predicted from the other points. Zero if these do not predict them.
  Eigen::Matrix<double, 2, 3> missed(const Positions& coefficients, Eigen::Index i,
                                     Eigen::Index j) const {
    Eigen::Matrix2d block;
    block << inverse_(i, i), inverse_(i, j), inverse_(j, i), inverse_(j, j);
    if (block.determinant() <= least_ * least_) return Eigen::Matrix<double, 2, 3>::Zero();
    Eigen::Matrix<double, 2, 3> right;
    right << coefficients.row(i), coefficients.row(j);
    return block.inverse() * right;
  }

 private:
  Eigen::MatrixXd inverse_;
  double least_;
};

/// Pair whose exchange improves the predictions most, if any.
std::optional<std::pair<int, int>> best_exchange(const LeaveOut& others, const Positions& places,
                                                 double size) {
  const Positions coefficients = others.coefficients(places);
  std::optional<std::pair<int, int>> best;
  double least = kExchangedShare;
  for (int i = 0; i < places.rows(); ++i) {
    for (int j = i + 1; j < places.rows(); ++j) {
      const Eigen::RowVector3d way = places.row(j) - places.row(i);
      if (way.norm() <= kHarmless * size) continue;
      const Eigen::Matrix<double, 2, 3> missed = others.missed(coefficients, i, j);
      const double before = missed.squaredNorm();
      const double after =
          (missed.row(0) + way).squaredNorm() + (missed.row(1) - way).squaredNorm();
      if (after >= least * before) continue;
      least = after / before;
      best = {i, j};
    }
  }
  return best;
}

/// Most doubtful of some markers, by its index among them. Empty if all are sound.
std::optional<DoubtfulMarker> most_doubtful(const Positions& from, const Positions& to,
                                            double size) {
  const LeaveOut others(from);
  const Positions coefficients = others.coefficients(to);
  Eigen::VectorXd significance(to.rows());
  for (Eigen::Index i = 0; i < to.rows(); ++i) {
    significance[i] = others.significance(coefficients, i);
  }
  Eigen::Index worst = 0;
  const double most = significance.maxCoeff(&worst);
  const double usual = median({significance.begin(), significance.end()});
  const double off = others.missed(coefficients, worst).norm() / size;
  if (off <= kHarmless || most <= kDoubtfulTimes * usual) return {};
  return DoubtfulMarker{static_cast<std::size_t>(worst), {}, off};
}

bool are_there(const std::vector<Marker>& markers, const Positions& source,
               const Positions& target) {
  return std::ranges::all_of(markers, [&](const Marker& marker) {
    return marker.source >= 0 && marker.source < source.rows() && marker.target >= 0 &&
           marker.target < target.rows();
  });
}

Positions remaining(const Positions& positions, const std::vector<std::size_t>& rows) {
  return positions(rows, Eigen::all);
}

std::string name_of(std::size_t marker, const std::vector<Marker>& markers,
                    const std::vector<std::string>& names) {
  const std::string name =
      marker < names.size() ? names[marker] : "marker " + std::to_string(marker + 1);
  return name + " (vertices " + std::to_string(markers[marker].source) + " and " +
         std::to_string(markers[marker].target) + ")";
}

/// Mean cosine between the target's normals at markers and the mapped source's normals.
double mean_facing(const TriMesh& source, const TriMesh& target, const std::vector<Marker>& markers,
                   const Similarity& map) {
  const Positions from = vertex_normals(source.positions, source.connectivity.triangles),
                  to = vertex_normals(target.positions, target.connectivity.triangles);
  double sum = 0;
  for (const Marker& marker : markers) {
    const Eigen::Vector3d carried = map.rotation * from.row(marker.source).transpose();
    sum += carried.stableNormalized().dot(to.row(marker.target).stableNormalized());
  }
  // Faces keep the order of their corners in the mirror, and therefore flip.
  return (map.mirrors() ? -sum : sum) / static_cast<double>(markers.size());
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
  check_not_flat(positions_at(markers, &Marker::source, source), "source");
  check_not_flat(positions_at(markers, &Marker::target, target), "target");
}

double affine_residual(const std::vector<Marker>& markers, const Positions& source,
                       const Positions& target) {
  fix_product_blocking();
  const Eigen::MatrixXd from = centred(positions_at(markers, &Marker::source, source));
  const Eigen::MatrixXd to = centred(positions_at(markers, &Marker::target, target));
  const Eigen::MatrixXd map = from.colPivHouseholderQr().solve(to);
  const double size = to.norm();
  return size > 0 ? (from * map - to).norm() / size : 0;
}

std::vector<DoubtfulMarker> doubtful_markers(const std::vector<Marker>& markers,
                                             const Positions& source, const Positions& target) {
  if (markers.size() < kFewestChecked || markers.size() > kMostChecked) return {};
  fix_product_blocking();
  const Positions from = positions_at(markers, &Marker::source, source);
  Positions to = positions_at(markers, &Marker::target, target);
  const double size = size_of(to);
  const LeaveOut others(from);
  std::vector<DoubtfulMarker> doubtful;
  for (std::size_t found = 0; found < markers.size() / 2; ++found) {
    const auto pair = best_exchange(others, to, size);
    if (!pair) break;
    const auto first = static_cast<std::size_t>(pair->first),
               second = static_cast<std::size_t>(pair->second);
    const double off = (to.row(pair->first) - to.row(pair->second)).norm() / size;
    doubtful.push_back({first, second, off});
    doubtful.push_back({second, first, off});
    to.row(pair->first).swap(to.row(pair->second));
  }
  std::vector<std::size_t> left(markers.size());
  std::iota(left.begin(), left.end(), 0);
  while (left.size() >= kFewestChecked) {
    auto worst = most_doubtful(remaining(from, left), remaining(to, left), size);
    if (!worst) break;
    const std::size_t marker = std::exchange(worst->marker, left[worst->marker]);
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(marker));
    doubtful.push_back(*worst);
  }
  return doubtful;
}

std::vector<std::string> described(const std::vector<DoubtfulMarker>& doubtful,
                                   const std::vector<Marker>& markers,
                                   const std::vector<std::string>& names) {
  std::vector<std::string> lines;
  for (const auto& [marker, exchanged_with, off] : doubtful) {
    if (!exchanged_with) {
      lines.push_back(name_of(marker, markers, names) + " is " + percent(off) +
                      " of the markers' extent from where the others say; look at it");
    } else if (marker < *exchanged_with) {
      lines.push_back(name_of(marker, markers, names) + " and " +
                      name_of(*exchanged_with, markers, names) +
                      " are likely exchanged: each is where the others say that the other one is");
    }
  }
  return lines;
}

double left_out_residual(const std::vector<Marker>& markers, const Positions& source,
                         const Positions& target) {
  fix_product_blocking();
  const Positions to = positions_at(markers, &Marker::target, target);
  const LeaveOut others(positions_at(markers, &Marker::source, source));
  const Positions coefficients = others.coefficients(to);
  double sum = 0;
  for (Eigen::Index i = 0; i < to.rows(); ++i) sum += others.missed(coefficients, i).squaredNorm();
  return std::sqrt(sum / static_cast<double>(to.rows())) / size_of(to);
}

bool fit_better_shifted(const std::vector<Marker>& markers, int shift, const Positions& source,
                        const Positions& target) {
  if (markers.size() < kFewestForAffine) return false;
  std::vector<Marker> shifted = markers;
  for (Marker& marker : shifted) {
    marker.source -= shift;
    marker.target -= shift;
  }
  if (!are_there(shifted, source, target)) return false;
  if (!are_there(markers, source, target)) return true;
  const auto is_better = [&](const auto& residual) {
    return residual(shifted, source, target) < kFitsBetter * residual(markers, source, target);
  };
  // An exchanged pair leaves a large residual in either case. The residual of few markers says
  // little.
  if (!is_better(affine_residual)) return false;
  return markers.size() < kFewestChecked || markers.size() > kMostChecked ||
         is_better(left_out_residual);
}

bool is_inside_out(const TriMesh& source, const TriMesh& target,
                   const std::vector<Marker>& markers) {
  const Positions from = positions_at(markers, &Marker::source, source.positions);
  const Positions to = positions_at(markers, &Marker::target, target.positions);
  const Similarity straight = similarity_fit(from, to, Handedness::kept),
                   mirrored = similarity_fit(from, to, Handedness::mirrored);
  const auto left_by = [&](const Similarity& map) {
    return (map.apply(from) - to).norm() / (size_of(to) * std::sqrt(double(to.rows())));
  };
  if (left_by(mirrored) >= kMirroredFit * left_by(straight)) {
    return mean_facing(source, target, markers, straight) < -kFacingAlike;
  }
  const bool is_taken = similarity_fit(from, to).mirrors();
  if (is_taken && mean_facing(source, target, markers, mirrored) > kFacingAlike) return false;
  throw MismatchError("the markers fit a mirror image of the source (it leaves " +
                      percent(left_by(mirrored)) + " of their size, the source " +
                      percent(left_by(straight)) +
                      "): left and right are exchanged in them, or one of the meshes is mirrored; "
                      "exchange them, or mirror one mesh");
}

}  // namespace mimetra
