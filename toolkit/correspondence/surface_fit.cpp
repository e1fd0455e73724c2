#include "toolkit/correspondence/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/correspondence/closest_surface.h"
#include "toolkit/correspondence/deformation_system.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

/// Borders are matched to borders that are nearer than this share of the target's size.
constexpr double kBorderReach = 0.02;

/// Closest points that are farther than this share do not count: the back of a head has no place
/// on a mask.
constexpr double kClosestReach = 0.1;

/// Vertices that one call of a thread asks for.
constexpr int kVerticesAtATime = 256;

void check_mesh(const TriMesh& mesh, const char* name) {
  if (mesh.positions.rows() == mesh.connectivity.vertices && mesh.positions.allFinite()) return;
  throw std::invalid_argument(std::string("the ") + name +
                              ": expected a finite position for each vertex");
}

/// x -> (x - place) / size makes the target's box about as large as 1, around the origin.
struct Normalisation {
  explicit Normalisation(const SubjectBox& target) : place(target.center), size(target.diagonal) {}

  Positions apply(const Positions& positions) const { return (positions.rowwise() - place) / size; }
  Positions undo(const Positions& positions) const { return (size * positions).rowwise() + place; }

  Eigen::RowVector3d place;
  double size;
};

/// Whether a marker is on the connected part of each vertex (N).
std::vector<bool> reached_parts(const SurfaceParts& parts,
                                const std::vector<VertexIndex>& markers) {
  std::vector<bool> part_reached(parts.count(), false);
  for (const VertexIndex v : markers) part_reached[parts.of_vertex[v]] = true;
  std::vector<bool> reached;
  for (const int part : parts.of_vertex) reached.push_back(part_reached[part]);
  return reached;
}

/// Throws MismatchError where two of the target's markers are one point of its surface.
void check_places(const std::vector<VertexIndex>& markers, const Weld& weld) {
  std::vector<bool> taken(weld.representative.size(), false);
  for (const VertexIndex v : markers) {
    if (taken[weld.representative[v]]) {
      throw MismatchError("two markers are at the place of vertex " + std::to_string(v) +
                          " of the target");
    }
    taken[weld.representative[v]] = true;
  }
}

/// The source's surface with vertices at one place as one.
struct Source {
  Source(const TriMesh& mesh, const std::vector<Marker>& markers)
      : weld(Weld::exact(mesh.positions)),
        triangles(with_area(mesh.positions, weld.welded(mesh.connectivity.triangles))),
        target_of(mesh.positions.rows(), -1),
        along_border(Positions::Zero(mesh.positions.rows(), 3)) {
    for (const Marker& marker : markers) {
      VertexIndex& target = target_of[weld.representative[marker.source]];
      if (target >= 0) {
        throw MismatchError("two markers are at the place of vertex " +
                            std::to_string(marker.source) + " of the source");
      }
      target = marker.target;
    }
    std::vector<VertexIndex> marked;
    marked.reserve(markers.size());
    for (const Marker& marker : markers) marked.push_back(marker.source);
    reached = reached_parts(surface_parts(mesh.positions, triangles, weld), marked);
    std::vector<bool> in_triangle(target_of.size(), false);
    for (const VertexIndex v : triangles.reshaped()) in_triangle[v] = true;
    for (std::size_t v = 0; v < target_of.size(); ++v) {
      reached[v] = reached[v] && in_triangle[weld.representative[v]];
      free.push_back(reached[v] && in_triangle[v] && target_of[v] < 0);
    }
    borders = border_edges(triangles);
    on_border.assign(target_of.size(), false);
    for (const BorderEdge& edge : borders) {
      on_border[triangles(edge.triangle, edge.corner)] = true;
      on_border[triangles(edge.triangle, (edge.corner + 1) % 3)] = true;
    }
  }

  /// How the border leads at each vertex of it.
  void set_border_directions(const Positions& positions) {
    along_border.setZero();
    for (const BorderEdge& edge : borders) {
      const VertexIndex a = triangles(edge.triangle, edge.corner),
                        b = triangles(edge.triangle, (edge.corner + 1) % 3);
      const Eigen::RowVector3d way = positions.row(b) - positions.row(a);
      along_border.row(a) += way;
      along_border.row(b) += way;
    }
  }

  Weld weld;
  Triangles triangles;                 ///< on the lowest vertices of each place
  std::vector<VertexIndex> target_of;  ///< of the lowest vertex at a marker; -1
  Positions along_border;
  std::vector<bool> reached, free;
  std::vector<BorderEdge> borders;
  std::vector<bool> on_border;
};

/// Where free vertices are drawn to, and which.
struct ClosestPoints {
  Positions places;
  Eigen::VectorXd counts;  ///< 1 or 0
};

ClosestPoints closest_points(const Source& source, const Positions& positions,
                             const ClosestSurface& target, const Context& context) {
  const Positions normals = vertex_normals(positions, source.triangles);
  const auto vertices = static_cast<int>(positions.rows());
  ClosestPoints result{positions, Eigen::VectorXd::Zero(vertices)};
  const auto find = [&](VertexIndex v) {
    const Eigen::Vector3d point = positions.row(v), normal = normals.row(v);
    const bool border = source.on_border[v];
    const SurfacePoint found =
        border ? target.closest_on_border(point, normal, source.along_border.row(v))
               : target.closest(point, normal);
    if (found.triangle < 0 || found.on_border != border) return;
    const double reach = border ? kBorderReach : kClosestReach;
    if (found.squared_distance > reach * reach) return;
    result.places.row(v) = found.position;
    result.counts[v] = 1;
  };
  const auto find_block = [&](int block) {
    const int last = std::min(vertices, (block + 1) * kVerticesAtATime);
    for (int v = block * kVerticesAtATime; v < last; ++v) {
      if (source.free[v]) find(v);
    }
  };
  parallel_for((vertices + kVerticesAtATime - 1) / kVerticesAtATime, find_block, context);
  return result;
}

/// Weight of the closest points in a step, 0 the first one.
double closest_weight(const SurfaceFitOptions& options, int step) {
  if (options.steps < 2) return options.last_closest;
  const double share = static_cast<double>(step) / (options.steps - 1);
  return options.first_closest * std::pow(options.last_closest / options.first_closest, share);
}

}  // namespace

void check_fit(const TriMesh& source, const TriMesh& target, const std::vector<Marker>& markers) {
  check_mesh(source, "source");
  check_mesh(target, "target");
  check_markers(markers, source.positions, target.positions);
}

SurfaceFit fit_to_surface(const TriMesh& source_mesh, const TriMesh& target_mesh,
                          const std::vector<Marker>& markers, const SurfaceFitOptions& options,
                          const Context& context) {
  check_options(options);
  check_fit(source_mesh, target_mesh, markers);
  Source source(source_mesh, markers);

  std::vector<VertexIndex> from, to;
  for (const Marker& marker : markers) {
    from.push_back(marker.source);
    to.push_back(marker.target);
  }
  const Weld target_weld = Weld::exact(target_mesh.positions);
  check_places(to, target_weld);
  const Triangles target_triangles = target_weld.welded(target_mesh.connectivity.triangles);
  const SurfaceParts target_parts =
      surface_parts(target_mesh.positions, target_triangles, target_weld);
  const SubjectBox target_box = subject_box(target_mesh.positions, target_parts, to);
  const Normalisation normalisation(target_box);
  const Positions target = normalisation.apply(target_mesh.positions);
  const Similarity similarity = similarity_fit(source_mesh.positions(from, Eigen::all),
                                               target_mesh.positions(to, Eigen::all));
  const Positions start = normalisation.apply(similarity.apply(source_mesh.positions));
  Positions held = start;
  for (Eigen::Index v = 0; v < held.rows(); ++v) {
    if (source.target_of[v] >= 0) held.row(v) = target.row(source.target_of[v]);
  }

  // Each of the solves counts the same, and the preparation as one more.
  const double share = 1.0 / (options.steps + 2);
  DeformationSystem system(start, source.triangles, source.free, options.smoothness,
                           options.identity);
  const std::vector<bool> target_reached = reached_parts(target_parts, to);
  std::vector<int> rows;
  for (int t = 0; t < target_triangles.rows(); ++t) {
    if (target_reached[target_triangles(t, 0)]) rows.push_back(t);
  }
  const ClosestSurface surface(target, target_triangles(rows, Eigen::all));
  context.report(share);
  Positions positions = system.solve(held, start, Eigen::VectorXd::Zero(start.rows()));
  for (int step = 0; step < options.steps; ++step) {
    const double done = share * (step + 2);
    context.report(done);
    source.set_border_directions(positions);
    const ClosestPoints closest =
        closest_points(source, positions, surface, context.part(done, done));
    positions = system.solve(held, closest.places, closest_weight(options, step) * closest.counts);
  }
  context.report(1);
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    if (source.reached[v]) positions.row(v) = positions.row(source.weld.representative[v]);
  }
  return {normalisation.undo(positions), source.reached, target_reached, target_box};
}

}  // namespace mimetra
