#pragma once

#include <functional>
#include <span>
#include <vector>

#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/surface_distances.h"
#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

/// Support maps around some vertices (S) of the mesh, N x S: over the whole mesh on each rank.
using SupportFunction = std::function<Eigen::MatrixXd(std::span<const VertexIndex>)>;

/// Support maps of distances between `d_min` and `d_max` (lengths). The function throws
/// std::invalid_argument where `distances` gives another count than `vertices`.
SupportFunction support_function(DistanceFunction distances, int vertices, double d_min,
                                 double d_max);

/// The support maps of K components, which follow their components' strongest vertices.
class SupportMaps {
 public:
  /// Those of the n vertices that `part` holds. `center_weights` as of strongest_vertex(), of all
  /// vertices of the mesh.
  SupportMaps(SupportFunction support, int components, const VertexPart& part,
              Eigen::VectorXd center_weights);

  /// Moves each map to the strongest vertex of its component, row k of `components` (K x 3n). A
  /// component that is zero keeps its map. `reduction` over the same part.
  template <typename Scalar>
  void follow(const VertexBlocks<Scalar>& components, const Reduction& reduction);

  /// K x n; 1 everywhere in a map that had no component to follow.
  const Frames& maps() const { return maps_; }

 private:
  SupportFunction support_;
  Eigen::VectorXd center_weights_;
  std::vector<VertexIndex> centers_;
  Frames maps_;
};

}  // namespace mimetra
