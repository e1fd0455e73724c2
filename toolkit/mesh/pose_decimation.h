#pragma once

#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/surface.h"

/// Half-edge collapses that consider several poses of a surface. Internal to simplification.h.
namespace mimetra {

/// Poses of a surface that decide the cost of collapses and whether they are allowed.
struct DecimationPoses {
  /// One row per vertex of the surface, in units of about the mesh's size. Pose 0 is the rest pose.
  /// The first `planes` poses contribute to the cost; all are checked for folds.
  std::vector<Positions> positions, normals;
  int planes = 0;

  void add(Positions pose, const Triangles& triangles);
};

/// Cosine between a triangle's normal and the sum of the surface's normals at its corners. Negative
/// if the triangle is turned over; -1 if it has no area.
double agreement(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& normals);

/// Surface after collapses.
struct CollapsedSurface {
  std::vector<bool> kept;      ///< whether each vertex of the surface remains
  std::vector<int> triangles;  ///< numbers of the remaining triangles, ascending
  Triangles corners;           ///< their corners, as vertices of the surface
};

/// Performs up to `collapses` collapses, or fewer if no more are allowed. `locked` vertices stay.
/// All arguments refer to vertices of the surface's half-edges. Throws Cancelled.
CollapsedSurface collapsed(const Surface& surface, const DecimationPoses& poses,
                           const std::vector<bool>& locked, std::size_t collapses,
                           const Context& context);

}  // namespace mimetra
