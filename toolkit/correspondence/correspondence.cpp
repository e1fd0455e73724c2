#include "toolkit/correspondence/correspondence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "toolkit/correspondence/closest_surface.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

/// Partners may be this share of the target's size apart, even if their edges are shorter.
constexpr double kPairReach = 0.02;

constexpr int kTrianglesAtATime = 256;

/// Limits of the verdict, as shares of the target's size and of triangles. With residuals of 1 %,
/// wrinkles appear in other places. Folds reverse deformations.
constexpr double kGoodResidual = 0.005, kUsableResidual = 0.01;
constexpr double kGoodFolds = 0.001, kUsableFolds = 0.01;
/// A mask shows half of a head. If more is without a partner, the meshes are probably not both
/// faces.
constexpr double kMostWithoutPartner = 0.9;

/// Triangles of the parts that a marker reaches.
struct ReachedTriangles {
  ReachedTriangles(const Positions& positions, const Triangles& all,
                   const std::vector<bool>& reached) {
    for (int t = 0; t < all.rows(); ++t) {
      if (reached[all(t, 0)]) numbers.push_back(t);
    }
    triangles = Weld::exact(positions).welded(all(numbers, Eigen::all));
  }

  std::vector<int> numbers;
  Triangles triangles;  ///< on welded vertices
};

/// A surface and the properties of its triangles that pairing needs.
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

template <typename Work>
void for_each_triangle(int count, const Work& work, const Context& context) {
  const auto work_on_block = [&](int block) {
    const int last = std::min(count, (block + 1) * kTrianglesAtATime);
    for (int t = block * kTrianglesAtATime; t < last; ++t) work(t);
  };
  parallel_for((count + kTrianglesAtATime - 1) / kTrianglesAtATime, work_on_block, context);
}

/// Results of a search for each triangle of one surface on the other.
struct Partners {
  std::vector<int> partner;   ///< -1 if there is none
  Eigen::VectorXd residuals;  ///< distances from the other surface
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

/// Partners of each triangle of `target`, ascending, as rows of both surfaces.
std::vector<std::vector<int>> partners_of(const PairedSurface& target, const Partners& of_target,
                                          const Partners& of_source) {
  std::vector<std::vector<int>> partners(target.triangles.rows());
  for (std::size_t t = 0; t < partners.size(); ++t) {
    if (of_target.partner[t] >= 0) partners[t].push_back(of_target.partner[t]);
  }
  for (std::size_t s = 0; s < of_source.partner.size(); ++s) {
    const int t = of_source.partner[s];
    // If the target's triangle found no partner, its centroid does not project into the source's
    // surface.
    if (t < 0 || of_target.partner[t] < 0 || of_target.partner[t] == static_cast<int>(s)) continue;
    partners[t].push_back(static_cast<int>(s));
  }
  for (std::vector<int>& of_triangle : partners) std::ranges::sort(of_triangle);
  return partners;
}

/// Triangles and their shares of the total area. \pre `rows` belong to the surface, and `numbers`
/// are its triangles' numbers
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
  for (std::size_t i = 0; i < partners.size(); ++i) {
    result.residuals[of_target.numbers[i]] = of_to.residuals[static_cast<Eigen::Index>(i)];
  }
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

namespace {

using Vertices = std::vector<VertexIndex>;

/// Vertices of each connected part with area that no marker reaches.
std::vector<Vertices> unreached_parts(const Positions& positions, const Triangles& triangles,
                                      const std::vector<bool>& reached) {
  const SurfaceParts parts = surface_parts(positions, triangles);
  std::map<int, Vertices> unreached;
  for (VertexIndex v = 0; v < positions.rows(); ++v) {
    const int part = parts.of_vertex[static_cast<std::size_t>(v)];
    const bool has_area = parts.areas[static_cast<std::size_t>(part)] > 0;
    if (has_area && !reached[static_cast<std::size_t>(v)]) unreached[part].push_back(v);
  }
  std::vector<Vertices> result;
  result.reserve(unreached.size());
  for (auto& [part, vertices] : unreached) result.push_back(std::move(vertices));
  return result;
}

/// The 200 vertices among some that are nearest to a place, ascending.
Vertices nearest_to(const Eigen::RowVector3d& place, const Positions& positions,
                    const Vertices& among) {
  constexpr std::size_t kAround = 200;
  std::vector<std::pair<double, VertexIndex>> distances;
  distances.reserve(among.size());
  for (const VertexIndex v : among) {
    distances.emplace_back((positions.row(v) - place).squaredNorm(), v);
  }
  if (distances.size() > kAround) {
    std::ranges::nth_element(distances, distances.begin() + kAround);
    distances.resize(kAround);
  }
  Vertices nearest;
  nearest.reserve(distances.size());
  for (const auto& [distance, v] : distances) nearest.push_back(v);
  std::ranges::sort(nearest);
  return nearest;
}

/// Fit in which unreached parts have moved with the surface around them.
Positions carried_parts(const SurfaceFit& fit, const TriMesh& source,
                        const std::vector<Vertices>& parts) {
  Vertices reached;
  for (VertexIndex v = 0; v < source.positions.rows(); ++v) {
    if (fit.reached[static_cast<std::size_t>(v)]) reached.push_back(v);
  }
  const auto fitted_to = [&](const Vertices& vertices, auto... handedness) {
    return similarity_fit(source.positions(vertices, Eigen::all),
                          fit.positions(vertices, Eigen::all), handedness...);
  };
  Positions carried = fit.positions;
  try {
    // A flat neighbourhood alone does not determine left and right.
    const Handedness handedness =
        fitted_to(reached).mirrors() ? Handedness::mirrored : Handedness::kept;
    for (const Vertices& part : parts) {
      const Positions at_rest = source.positions(part, Eigen::all);
      const Vertices around = nearest_to(at_rest.colwise().mean(), source.positions, reached);
      carried(part, Eigen::all) = fitted_to(around, handedness).apply(at_rest);
    }
  } catch (const MismatchError&) {
    return carried;  // collinear points determine no rotation; the markers' similarity remains
  }
  return carried;
}

/// Returns true if most of a part has partners nearby.
bool is_paired(const Correspondence& pairs, const std::vector<int>& triangles, double size) {
  constexpr double kMost = 0.75, kNear = 0.1;
  double residuals = 0;
  int paired = 0;
  for (const int t : triangles) {
    if (!pairs.has_partner(t)) continue;
    residuals += pairs.residuals[t];
    ++paired;
  }
  return paired > 0 && paired >= kMost * static_cast<double>(triangles.size()) &&
         residuals <= kNear * size * paired;
}

/// `pairs` plus the pairs of parts that no marker reaches.
Correspondence with_unmarked_parts(Correspondence pairs, const SurfaceFit& fit,
                                   const TriMesh& source, const TriMesh& target,
                                   const Context& context) {
  const Triangles& from = source.connectivity.triangles;
  const Triangles& to = target.connectivity.triangles;
  const auto of_source = unreached_parts(source.positions, from, fit.reached);
  const auto of_target = unreached_parts(target.positions, to, fit.target_reached);
  if (of_source.empty() || of_target.empty()) return pairs;

  SurfaceFit others{carried_parts(fit, source, of_source), fit.reached, fit.target_reached,
                    fit.target_box};
  others.reached.flip();
  others.target_reached.flip();
  const Correspondence found = pair_triangles(others, from, target, context);

  std::vector<int> part_of(static_cast<std::size_t>(target.positions.rows()), -1);
  for (std::size_t part = 0; part < of_target.size(); ++part) {
    for (const VertexIndex v : of_target[part]) part_of[std::size_t(v)] = static_cast<int>(part);
  }
  std::vector<std::vector<int>> triangles_of(of_target.size());
  for (int t = 0; t < to.rows(); ++t) {
    const int part = part_of[std::size_t(to(t, 0))];
    if (part >= 0) triangles_of[std::size_t(part)].push_back(t);
  }
  std::vector<bool> is_taken(static_cast<std::size_t>(to.rows()), false);
  for (std::size_t part = 0; part < of_target.size(); ++part) {
    const double size = box_diagonal(target.positions(of_target[part], Eigen::all));
    if (!is_paired(found, triangles_of[part], size)) continue;
    for (const int t : triangles_of[part]) is_taken[std::size_t(t)] = true;
  }

  Correspondence joined;
  joined.source_triangles = pairs.source_triangles;
  joined.residuals = pairs.residuals;
  for (int t = 0; t < to.rows(); ++t) {
    const Correspondence& taken = is_taken[std::size_t(t)] ? found : pairs;
    joined.parts.insert(joined.parts.end(), taken.parts.begin() + taken.offsets[t],
                        taken.parts.begin() + taken.offsets[t + 1]);
    joined.offsets.push_back(static_cast<int>(joined.parts.size()));
    joined.residuals[t] = taken.residuals[t];
  }
  return joined;
}

/// Number of folded triangles among those `counted`.
int folded_triangles(const Positions& positions, const Triangles& triangles,
                     const std::vector<bool>& counted) {
  const Positions at_vertices = vertex_normals(positions, triangles);
  const Positions normals = triangle_normals(positions, triangles);
  int folded = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    Eigen::RowVector3d around = Eigen::RowVector3d::Zero();
    for (const VertexIndex v : triangles.row(t)) around += at_vertices.row(v).normalized();
    if (counted[t] && normals.row(t).dot(around) < 0) ++folded;
  }
  return folded;
}

/// Mesh with the opposite orientation of triangles.
TriMesh turned_over(TriMesh mesh) {
  mesh.connectivity.triangles.col(1).swap(mesh.connectivity.triangles.col(2));
  return mesh;
}

}  // namespace

FoundCorrespondence find_correspondence(const TriMesh& source, const TriMesh& target,
                                        const std::vector<Marker>& markers,
                                        const SurfaceFitOptions& options, const Context& context) {
  check_fit(source, target, markers);
  FoundCorrespondence found;
  found.inside_out = is_inside_out(source, target, markers);
  const TriMesh facing = found.inside_out ? turned_over(target) : target;
  found.fit = fit_to_surface(source, facing, markers, options, context);
  const Triangles& triangles = source.connectivity.triangles;
  const Context at_end = context.part(1, 1);
  found.correspondence = with_unmarked_parts(pair_triangles(found.fit, triangles, facing, at_end),
                                             found.fit, source, facing, at_end);
  found.quality = quality_of(found.correspondence, found.fit.target_box.diagonal);
  const ReachedTriangles parts(found.fit.positions, triangles, found.fit.reached);
  std::vector<bool> is_partner(triangles.rows(), false);
  for (const Correspondence::Part& part : found.correspondence.parts) {
    is_partner[part.triangle] = true;
  }
  std::vector<bool> counted;
  for (const int number : parts.numbers) counted.push_back(is_partner[number]);
  found.quality.partners = static_cast<int>(std::ranges::count(is_partner, true));
  found.quality.folded = folded_triangles(found.fit.positions, parts.triangles, counted);
  return found;
}

}  // namespace mimetra
