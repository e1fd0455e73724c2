#pragma once

#include <memory>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

struct SurfacePoint {
  int triangle = -1;  ///< -1 if no triangle faces the right way
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double squared_distance = 0;
  /// True on an edge of only one triangle, and at a vertex of such an edge.
  bool on_border = false;
};

/// Side of a surface that a ray meets.
enum class Seen { nothing, front, back };

/// Nearest points of a surface among triangles that face a given way. Of equally near triangles,
/// closest() and nearest_centroid() return the lowest. Queries are const and may run from several
/// threads.
class ClosestSurface {
 public:
  /// `triangles` (M x 3) are on welded vertices. Queries with a normal never return a triangle
  /// without area.
  ClosestSurface(const Positions& positions, const Triangles& triangles);
  ~ClosestSurface();
  ClosestSurface(const ClosestSurface&) = delete;
  ClosestSurface& operator=(const ClosestSurface&) = delete;

  /// Nearest point among triangles whose normal is less than 90 degrees from `normal`.
  SurfacePoint closest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  /// Nearest centroid among the same triangles.
  SurfacePoint nearest_centroid(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) const;
  /// Nearest point among border edges whose triangle faces the same way. Edges, with the triangle
  /// to their left, must also lead less than 90 degrees from `direction`. This separates the upper
  /// lip's border from the lower lip's.
  SurfacePoint closest_on_border(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                 const Eigen::Vector3d& direction) const;
  /// Distance to the surface, whichever way it faces. +infinity if it has no triangles.
  double distance(const Eigen::Vector3d& point) const;
  /// First side of the surface that a ray from `point` meets.
  Seen seen_from(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Edge that belongs to only one triangle.
struct BorderEdge {
  int triangle;
  int corner;  ///< the edge leads from this corner to the next
};
/// All border edges of a mesh of `vertices` vertices, in the order of EdgeSides. Throws as
/// EdgeSides does.
std::vector<BorderEdge> border_edges(int vertices, const Triangles& triangles);

/// Centroid of each triangle (M x 3).
Positions centroids(const Eigen::Ref<const Positions>& positions, const Triangles& triangles);

}  // namespace mimetra
