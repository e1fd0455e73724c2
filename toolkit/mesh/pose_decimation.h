#pragma once

#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/surface.h"

/// Half-edge collapses that look at several poses of a surface. Internal to simplification.h.
namespace mimetra {

/// What a collapse is weighed and refused by, on the vertices of a surface.
struct DecimationPoses {
  /// The first `planes` of them count, all are looked at for folds. The first is the rest pose.
  /// The mesh's size is about 1.
  std::vector<Positions> positions, normals;
  int planes = 0;

  void add(Positions pose, const Triangles& triangles);
};

/// How far a triangle of these places agrees with the surface at its corners, whose normals are
/// added up: a cosine, negative where it is turned over; -1 for one without area.
double agreement(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                 const Eigen::Vector3d& normals);

/// The surface after collapses: its triangles, by that of the surface which each was.
struct CollapsedSurface {
  std::vector<bool> kept;      ///< vertices of the surface
  std::vector<int> triangles;  ///< of the surface that are left, ascending
  Triangles corners;           ///< of these, in the surface's vertices
};

/// After so many collapses, or as many as there can be; `locked` vertices stay. All of these are
/// vertices of the surface's half-edges. Throws Cancelled.
CollapsedSurface collapsed(const Surface& surface, const DecimationPoses& poses,
                           const std::vector<bool>& locked, std::size_t collapses,
                           const Context& context);

}  // namespace mimetra
