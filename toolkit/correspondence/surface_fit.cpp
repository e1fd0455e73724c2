#include "toolkit/correspondence/surface_fit.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>

#include "toolkit/correspondence/closest_surface.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/similarity.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

using Entry = Eigen::Triplet<double>;

/// Matrix that maps one coordinate of vertices and fourth vertices to the matching row of each T_i.
/// T = [v2 - v1, v3 - v1, v4 - v1] V^-1.
Eigen::SparseMatrix<double> gradients(const Positions& rest, const Triangles& triangles) {
  const auto vertices = static_cast<int>(rest.rows());
  std::vector<Entry> entries;
  entries.reserve(12 * triangles.rows());
  for (int t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d v1 = rest.row(triangles(t, 0));
    Eigen::Matrix3d V;
    V.col(0) = rest.row(triangles(t, 1)).transpose() - v1;
    V.col(1) = rest.row(triangles(t, 2)).transpose() - v1;
    const Eigen::Vector3d normal = V.col(0).cross(V.col(1));
    V.col(2) = normal / std::sqrt(normal.norm());
    const Eigen::Matrix3d inverse = V.inverse();
    for (int row = 0; row < 3; ++row) {
      const int at = 3 * t + row;
      entries.emplace_back(at, triangles(t, 0), -inverse.col(row).sum());
      entries.emplace_back(at, triangles(t, 1), inverse(0, row));
      entries.emplace_back(at, triangles(t, 2), inverse(1, row));
      entries.emplace_back(at, vertices + t, inverse(2, row));
    }
  }
  Eigen::SparseMatrix<double> matrix(3 * triangles.rows(), vertices + triangles.rows());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Quadratic form of the T_i's rows: identity |T_i|^2 plus smoothness |T_i - T_j|^2 for each i and
/// each neighbour j. A pair therefore counts twice.
Eigen::SparseMatrix<double> couplings(int vertices, const Triangles& triangles, double smoothness,
                                      double identity) {
  std::vector<Entry> entries;
  const auto rows = static_cast<int>(3 * triangles.rows());
  entries.reserve(static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row) entries.emplace_back(row, row, identity);
  const auto couple = [&](int i, int j) {
    for (int row = 0; row < 3; ++row) {
      entries.emplace_back(3 * i + row, 3 * i + row, 2 * smoothness);
      entries.emplace_back(3 * j + row, 3 * j + row, 2 * smoothness);
      entries.emplace_back(3 * i + row, 3 * j + row, -2 * smoothness);
      entries.emplace_back(3 * j + row, 3 * i + row, -2 * smoothness);
    }
  };
  EdgeSides(vertices, triangles).for_each_edge([&couple](std::span<const int> sides) {
    for (std::size_t one = 0; one < sides.size(); ++one) {
      for (std::size_t other = one + 1; other < sides.size(); ++other) {
        couple(sides[one] / 3, sides[other] / 3);
      }
    }
  });
  Eigen::SparseMatrix<double> matrix(rows, rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Positions of vertices and fourth vertices that keep the triangles' deformations smooth and
/// small. Some vertices are held, and others are drawn to places. All solves have the same
/// unknowns, so that one analysis serves them.
class DeformationSystem {
 public:
  /// `rest` is N x 3. Vertices that are not `free` stay at the places given to solve(). \pre each
  /// triangle has an area, each free vertex a triangle, and each connected part a held vertex
  DeformationSystem(const Positions& rest, const Triangles& triangles,
                    const std::vector<bool>& free, double smoothness, double identity);

  /// Positions (N x 3). Each free vertex v is drawn to row v of `drawn_to` with weight weights[v],
  /// or not at all if that is 0. The other vertices are held at their rows of `held`. Throws
  /// std::runtime_error if the system has no solution.
  Positions solve(const Positions& held, const Positions& drawn_to, const Eigen::VectorXd& weights);

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  std::vector<VertexIndex> free_;  ///< vertex of each free row
  std::vector<VertexIndex> held_;  ///< vertex of each held column
  Matrix free_products_, held_products_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> identity_side_;
  Eigen::SimplicialLDLT<Matrix> factor_;
  bool is_analysed_ = false;
};

DeformationSystem::DeformationSystem(const Positions& rest, const Triangles& triangles,
                                     const std::vector<bool>& free, double smoothness,
                                     double identity) {
  const Matrix G = gradients(rest, triangles);
  const Matrix K = couplings(static_cast<int>(rest.rows()), triangles, smoothness, identity);
  const Matrix products = G.transpose() * K * G;

  // Free vertices come first, then fourth vertices; held vertices have columns of their own.
  const auto vertices = static_cast<int>(rest.rows());
  std::vector<int> row(products.rows(), -1), held_column(vertices, -1);
  for (VertexIndex v = 0; v < vertices; ++v) {
    (free[v] ? row[v] : held_column[v]) = static_cast<int>((free[v] ? free_ : held_).size());
    (free[v] ? free_ : held_).push_back(v);
  }
  const auto free_vertices = static_cast<int>(free_.size());
  for (int t = 0; t < triangles.rows(); ++t) row[vertices + t] = free_vertices + t;
  const Eigen::Index size = free_vertices + triangles.rows();

  std::vector<Entry> among_free, with_held;
  for (Eigen::Index column = 0; column < products.outerSize(); ++column) {
    for (Matrix::InnerIterator entry(products, column); entry; ++entry) {
      const int i = row[entry.row()];
      if (i < 0) continue;
      if (row[column] >= 0) {
        among_free.emplace_back(i, row[column], entry.value());
      } else {
        with_held.emplace_back(i, held_column[column], entry.value());
      }
    }
  }
  free_products_.resize(size, size);
  free_products_.setFromTriplets(among_free.begin(), among_free.end());
  held_products_.resize(size, static_cast<Eigen::Index>(held_.size()));
  held_products_.setFromTriplets(with_held.begin(), with_held.end());

  Eigen::MatrixXd identities(3 * triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    identities.middleRows<3>(3 * t) = identity * Eigen::Matrix3d::Identity();
  }
  const Eigen::MatrixXd side = G.transpose() * identities;
  identity_side_.resize(size, 3);
  for (Eigen::Index i = 0; i < side.rows(); ++i) {
    if (row[i] >= 0) identity_side_.row(row[i]) = side.row(i);
  }
}

Positions DeformationSystem::solve(const Positions& held, const Positions& drawn_to,
                                   const Eigen::VectorXd& weights) {
  Matrix matrix = free_products_;
  const Eigen::MatrixXd known = held(held_, Eigen::all);
  Eigen::MatrixXd right = identity_side_ - held_products_ * known;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const VertexIndex v = free_[i];
    const auto row = static_cast<Eigen::Index>(i);
    if (weights[v] <= 0) continue;
    matrix.coeffRef(row, row) += weights[v];
    right.row(row) += weights[v] * drawn_to.row(v);
  }
  if (!is_analysed_) factor_.analyzePattern(matrix);
  is_analysed_ = true;
  factor_.factorize(matrix);
  if (factor_.info() != Eigen::Success) {
    throw std::runtime_error("the deformation of the source has no unique solution");
  }
  const Eigen::MatrixXd solution = factor_.solve(right);
  Positions result = held;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    result.row(free_[i]) = solution.row(static_cast<Eigen::Index>(i));
  }
  return result;
}

/// Largest distance between matched borders, as a share of the target's size.
constexpr double kBorderReach = 0.02;

/// Largest distance of a closest point, as a share of the target's size. The back of a head has no
/// place on a mask.
constexpr double kClosestReach = 0.1;

/// Vertices per block of a thread.
constexpr int kVerticesAtATime = 256;

void check_mesh(const TriMesh& mesh, const char* name) {
  if (mesh.positions.rows() == mesh.connectivity.vertices && mesh.positions.allFinite()) return;
  throw std::invalid_argument(std::string("the ") + name +
                              ": expected a finite position for each vertex");
}

/// x -> (x - place) / size scales the target's box to a diagonal of 1, around the origin.
struct Normalisation {
  explicit Normalisation(const SubjectBox& target) : place(target.center), size(target.diagonal) {}

  Positions apply(const Positions& positions) const { return (positions.rowwise() - place) / size; }
  Positions undo(const Positions& positions) const { return (size * positions).rowwise() + place; }

  Eigen::RowVector3d place;
  double size;
};

/// Returns true for vertices whose connected part has a marker (N).
std::vector<bool> reached_parts(const SurfaceParts& parts,
                                const std::vector<VertexIndex>& markers) {
  std::vector<bool> part_reached(parts.count(), false);
  for (const VertexIndex v : markers) part_reached[parts.of_vertex[v]] = true;
  std::vector<bool> reached;
  for (const int part : parts.of_vertex) reached.push_back(part_reached[part]);
  return reached;
}

/// Throws MismatchError if two of the target's markers are one point of its surface.
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

/// Welded surface of the source.
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
    borders = border_edges(static_cast<int>(target_of.size()), triangles);
    on_border.assign(target_of.size(), false);
    for (const BorderEdge& edge : borders) {
      on_border[triangles(edge.triangle, edge.corner)] = true;
      on_border[triangles(edge.triangle, (edge.corner + 1) % 3)] = true;
    }
  }

  /// Sets the direction of the border at each of its vertices.
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
  Triangles triangles;                 ///< on welded vertices
  std::vector<VertexIndex> target_of;  ///< of each welded vertex; -1 without a marker
  Positions along_border;
  std::vector<bool> reached, free;
  std::vector<BorderEdge> borders;
  std::vector<bool> on_border;
};

/// Places to which free vertices are drawn.
struct ClosestPoints {
  Positions places;
  Eigen::VectorXd counts;  ///< 1 if the vertex has a place, or 0
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

/// Weight of the closest points in a step; the first step is 0.
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

  // The preparation and each solve have equal shares of the progress.
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
