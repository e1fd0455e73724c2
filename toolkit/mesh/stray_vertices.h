#pragma once

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// How far vertices of poses lie from their neighbours, by triangles of the rest pose.
class StrayVertices {
 public:
  StrayVertices(const Positions& rest, const Triangles& triangles);

  /// By how much each vertex lies farther from the middle of its neighbours than at rest (N); 0 for
  /// one of no triangle.
  Eigen::VectorXd distances(const PositionsView& pose) const;
  /// Share of a mesh's size by which no vertex of a face strays.
  static constexpr double kStray = 0.05;
  /// Whether a vertex that strays so far, in a mesh of this size whose poses are so many times as
  /// large as at rest, is torn off: by more than a twentieth of the size and than its edges are
  /// long at rest. Expressions of three faces stray by up to 3.6 % and 0.6 edges.
  bool is_torn_off(VertexIndex vertex, double distance, double size, double scale = 1) const;

 private:
  Eigen::VectorXd from_neighbors(const PositionsView& pose) const;

  Triangles triangles_;
  Eigen::VectorXd at_rest_, edges_;
};

}  // namespace mimetra
