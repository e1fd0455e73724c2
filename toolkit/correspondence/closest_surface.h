#pragma once

#include <memory>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// A place on a surface.
struct SurfacePoint {
  int triangle = -1;  ///< -1 where no triangle faces the right way
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double squared_distance = 0;
  /// On an edge of one triangle only, or at a vertex of such an edge.
  bool on_border = false;
};

/// The side of a surface that a ray meets.
enum class Seen { nothing, front, back };

/// A surface that is asked for its nearest part that faces the same way. Queries are const and may
/// run from several threads. Of equally near triangles the lowest counts.
class ClosestSurface {
 public:
  /// Triangles without area are never found. `triangles` M x 3, with vertices that are one point of
  /// the surface welded.
  ClosestSurface(const Positions& positions, const Triangles& triangles);
  ~ClosestSurface();
  ClosestSurface(const ClosestSurface&) = delete;
  ClosestSurface& operator=(const ClosestSurface&) = delete;

  /// The nearest point of the triangles whose normal is less than 90 degrees from `normal`.
  SurfacePoint closest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  /// The same of their centroids.
  SurfacePoint nearest_centroid(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  /// The nearest point of the border edges whose triangle faces so, and that lead less than 90
  /// degrees from `direction` (with the triangle to their left): the upper lip's do not lead as the
  /// lower lip's.
  SurfacePoint closest_on_border(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                 const Eigen::Vector3d& direction) const;
  /// Distance to the surface, whichever way it faces; +infinity if it has no triangles.
  double distance(const Eigen::Vector3d& point) const;
  /// What a ray from `point` meets first.
  Seen seen_from(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// An edge of one triangle only.
struct BorderEdge {
  int triangle;
  int corner;  ///< from this corner to the next
};
/// All of a mesh of so many vertices, as EdgeSides. Throws as it.
std::vector<BorderEdge> border_edges(int vertices, const Triangles& triangles);

/// Centroid of each triangle (M x 3).
Positions centroids(const Eigen::Ref<const Positions>& positions, const Triangles& triangles);

}  // namespace mimetra
