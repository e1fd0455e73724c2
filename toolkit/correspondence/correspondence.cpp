#include "toolkit/correspondence/correspondence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "toolkit/correspondence/closest_surface.h"
#include "toolkit/correspondence/reached_triangles.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Triangles whose edges are shorter may still be this share of the target's size apart.
constexpr double kPairReach = 0.02;

constexpr int kTrianglesAtATime = 256;

/// Limits of the verdict: shares of the target's size, and of triangles. A face that fits to 1
/// % shows the same wrinkles in other places; folds turn deformations around.
constexpr double kGoodResidual = 0.005, kUsableResidual = 0.01;
constexpr double kGoodFolds = 0.001, kUsableFolds = 0.01;
/// A mask shows half of a head; with less than this, other things than faces were paired.
constexpr double kMostWithoutPartner = 0.9;

/// A surface with what its triangles are asked for.
struct PairedSurface {
  PairedSurface(Positions own_positions, Triangles own_triangles)
      : positions(std::move(own_positions)),
        triangles(std::move(own_triangles)),
        normals(triangle_normals(positions, triangles)),
        middles(centroids(positions, triangles)),
        surface(positions, triangles) {
    for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
      double longest = 0;
      for (int c = 0; c < 3; ++c) {
        const Eigen::RowVector3d edge =
            positions.row(triangles(t, (c + 1) % 3)) - positions.row(triangles(t, c));
        longest = std::max(longest, edge.norm());
      }
      longest_edge.push_back(longest);
    }
  }

  Positions positions;
  Triangles triangles;
  Positions normals, middles;
  std::vector<double> longest_edge;
  ClosestSurface surface;
};

/// Calls `work(t)` for each triangle.
template <typename Work>
void for_each_triangle(int count, const Work& work, const Context& context) {
  const auto work_on_block = [&](int block) {
    const int last = std::min(count, (block + 1) * kTrianglesAtATime);
    for (int t = block * kTrianglesAtATime; t < last; ++t) work(t);
  };
  parallel_for((count + kTrianglesAtATime - 1) / kTrianglesAtATime, work_on_block, context);
}

/// What `side`'s triangles find on `other`.
struct Partners {
  std::vector<int> partner;   ///< -1 where there is none
  Eigen::VectorXd residuals;  ///< distances from its surface
};

Partners found_on(const PairedSurface& side, const PairedSurface& other, double reach,
                  const Context& context) {
  const auto count = static_cast<int>(side.triangles.rows());
  Partners found{std::vector<int>(count, -1),
                 Eigen::VectorXd::Constant(count, std::numeric_limits<double>::infinity())};
  const auto find = [&](int t) {
    const Eigen::Vector3d middle = side.middles.row(t), normal = side.normals.row(t);
    const SurfacePoint point = other.surface.closest(middle, normal);
    if (point.triangle < 0) return;
    found.residuals[t] = std::sqrt(point.squared_distance);
    if (point.on_border) return;
    const SurfacePoint nearest = other.surface.nearest_centroid(middle, normal);
    const double limit =
        std::max(reach, side.longest_edge[t] + other.longest_edge[nearest.triangle]);
    if (nearest.squared_distance <= limit * limit) found.partner[t] = nearest.triangle;
  };
  for_each_triangle(count, find, context);
  return found;
}

/// The partners of each triangle of `target`, ascending; rows of both surfaces.
std::vector<std::vector<int>> partners_of(const PairedSurface& target, const Partners& of_target,
                                          const Partners& of_source) {
  std::vector<std::vector<int>> partners(target.triangles.rows());
  for (std::size_t t = 0; t < partners.size(); ++t) {
    if (of_target.partner[t] >= 0) partners[t].push_back(of_target.partner[t]);
  }
  for (std::size_t s = 0; s < of_source.partner.size(); ++s) {
    const int t = of_source.partner[s];
    // Where the target finds nothing its triangle has no place inside the source's surface.
    if (t < 0 || of_target.partner[t] < 0 || of_target.partner[t] == static_cast<int>(s)) continue;
    partners[t].push_back(static_cast<int>(s));
  }
  for (std::vector<int>& of_triangle : partners) std::ranges::sort(of_triangle);
  return partners;
}

/// Triangles with their shares of the areas. \pre `rows` of the surface, whose numbers they are
std::vector<Correspondence::Part> by_area(const std::vector<int>& rows,
                                          const std::vector<int>& numbers,
                                          const PairedSurface& surface) {
  if (rows.size() == 1) return {{numbers[rows.front()], 1}};
  double area = 0;
  for (const int row : rows) area += surface.normals.row(row).norm();
  std::vector<Correspondence::Part> parts;
  parts.reserve(rows.size());
  for (const int row : rows) {
    parts.push_back({numbers[row], surface.normals.row(row).norm() / area});
  }
  return parts;
}

}  // namespace

Correspondence Correspondence::identity(int triangles) {
  Correspondence result;
  result.source_triangles = triangles;
  for (int t = 0; t < triangles; ++t) {
    result.parts.push_back({t, 1});
    result.offsets.push_back(t + 1);
  }
  result.residuals = Eigen::VectorXd::Zero(triangles);
  return result;
}

CorrespondenceQuality quality_of(const Correspondence& pairs, double size) {
  CorrespondenceQuality quality;
  int with_partner = 0;
  for (int t = 0; t < pairs.target_triangles(); ++t) {
    if (!pairs.has_partner(t)) continue;
    ++with_partner;
    const double residual = pairs.residuals[t] / size;
    quality.mean_residual += residual;
    quality.largest_residual = std::max(quality.largest_residual, residual);
  }
  if (with_partner > 0) quality.mean_residual /= with_partner;
  quality.without_partner =
      1 - static_cast<double>(with_partner) / std::max(1, pairs.target_triangles());
  return quality;
}

std::string CorrespondenceQuality::verdict() const {
  const double folds = static_cast<double>(folded) / std::max(1, partners);
  std::vector<std::string> poor;
  if (without_partner > kMostWithoutPartner) {
    poor.push_back(percent(without_partner) + " of the target has no partner");
  }
  if (mean_residual > kUsableResidual) {
    poor.push_back("the deformed source is " + percent(mean_residual) +
                   " of its size from the target");
  }
  if (folds > kUsableFolds) {
    poor.push_back(std::to_string(folded) + " triangles of the deformed source are folded");
  }
  if (!poor.empty()) return "poor: " + joined(poor, ", ", " and ") + "; add markers there";
  return mean_residual <= kGoodResidual && folds <= kGoodFolds ? "good" : "usable";
}

Correspondence pair_triangles(const SurfaceFit& fitted, const Triangles& source,
                              const TriMesh& target, const Context& context) {
  const ReachedTriangles of_source(fitted.positions, source, fitted.reached);
  const ReachedTriangles of_target(target.positions, target.connectivity.triangles,
                                   fitted.target_reached);
  const PairedSurface from(fitted.positions, of_source.triangles);
  const PairedSurface to(target.positions, of_target.triangles);
  const double reach = kPairReach * fitted.target_box.diagonal;
  const Partners of_to = found_on(to, from, reach, context.part(0, 0.5));
  const Partners of_from = found_on(from, to, reach, context.part(0.5, 1));
  const auto partners = partners_of(to, of_to, of_from);

  Correspondence result;
  result.source_triangles = static_cast<int>(source.rows());
  const Eigen::Index triangles = target.connectivity.triangles.rows();
  result.residuals.setConstant(triangles, std::numeric_limits<double>::infinity());
  result.residuals(of_target.numbers) = of_to.residuals;
  std::size_t next = 0;
  for (int t = 0; t < triangles; ++t) {
    if (next < partners.size() && of_target.numbers[next] == t) {
      const auto parts = by_area(partners[next++], of_source.numbers, from);
      result.parts.insert(result.parts.end(), parts.begin(), parts.end());
    }
    result.offsets.push_back(static_cast<int>(result.parts.size()));
  }
  return result;
}

}  // namespace mimetra
