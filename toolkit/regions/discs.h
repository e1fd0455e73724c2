#pragma once

#include <map>
#include <vector>

#include "toolkit/splocs/surface_distances.h"

namespace mimetra {

/// Vertices within a geodesic radius of a centre, and the triangles that they take part in.
struct Disc {
  VertexIndex center = -1;
  std::vector<VertexIndex> vertices;  ///< ascending
  std::vector<int> triangles;         ///< with a vertex in the disc, ascending
};

/// Looks for discs of one radius that hold much of a quantity on the triangles. Centres are
/// compared that are a quarter of the radius apart from each other; a disc is measured along the
/// surface only where the ball around its centre, which holds more, could still win.
class DiscSearch {
 public:
  /// `positions` N x 3, `triangles` M x 3; distances along them. `radius` > 0, length. `inside` (N,
  /// empty for all): vertices that discs may hold.
  DiscSearch(Positions positions, Triangles triangles, DistanceFunction distances, double radius,
             std::vector<bool> inside = {});

  double radius() const { return radius_; }
  bool is_inside(VertexIndex vertex) const { return inside_.empty() || inside_[vertex]; }
  /// The disc with the largest sum of `amounts` (M, >= 0) over its triangles; without a centre
  /// where all are 0. Throws what the distances throw.
  Disc best(const Eigen::VectorXd& amounts);

 private:
  /// A centre, and what the ball around it holds.
  struct Candidate {
    VertexIndex center;
    double bound;
  };

  std::vector<Candidate> candidates(const Eigen::VectorXd& amounts) const;
  /// Measured for all of them together where they are new.
  void measure(std::span<const Candidate> some);

  Positions positions_;
  Triangles triangles_;
  DistanceFunction distances_;
  double radius_;
  std::vector<bool> inside_;
  std::vector<std::vector<int>> triangles_of_vertex_;
  std::map<VertexIndex, Disc> discs_;  // those measured so far
};

struct FarthestDiscsOptions {
  double radius = 1;  ///< along the surface, length > 0
  int count = 400;    ///< >= 1
  /// Vertices that discs may hold (N); empty for all.
  std::vector<bool> inside = {};
};

/// Discs of one radius that are spread over a mesh: around the vertex that is farthest from the
/// mean of all, then each time around the one that is farthest, straight through space, from all
/// centres so far; fewer than asked for where every vertex is a centre. Vertices without triangle
/// are none. `positions` N x 3, `triangles` M x 3, `distances` along them. Throws
/// std::invalid_argument for options out of range, and what the distances throw.
std::vector<Disc> farthest_discs(const Positions& positions, const Triangles& triangles,
                                 const DistanceFunction& distances,
                                 const FarthestDiscsOptions& options);

}  // namespace mimetra
