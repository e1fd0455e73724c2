#pragma once

#include <map>
#include <vector>

#include "toolkit/splocs/surface_distances.h"

namespace mimetra {

/// Vertices within a geodesic radius of a centre, and the triangles that contain them.
struct Disc {
  VertexIndex center = -1;
  std::vector<VertexIndex> vertices;  ///< ascending
  std::vector<int> triangles;         ///< with a vertex in the disc, ascending
};

/// Finds discs of one radius that contain much of a quantity on the triangles. Compared centres are
/// a quarter of the radius apart. A disc is measured along the surface only if the ball around its
/// centre, which contains more, could still win.
class DiscSearch {
 public:
  /// `positions` N x 3, `triangles` M x 3; `distances` along them. `radius` > 0, length. `inside`
  /// (N, empty for all): vertices that discs may contain.
  DiscSearch(Positions positions, Triangles triangles, DistanceFunction distances, double radius,
             std::vector<bool> inside = {});

  double radius() const { return radius_; }
  bool is_inside(VertexIndex vertex) const { return inside_.empty() || inside_[vertex]; }
  /// Disc with the largest sum of `amounts` (M, >= 0) over its triangles; without a centre if all
  /// are 0. Throws whatever the distances throw.
  Disc best(const Eigen::VectorXd& amounts);

 private:
  /// A centre and the sum over the ball around it.
  struct Candidate {
    VertexIndex center;
    double bound;
  };

  std::vector<Candidate> candidates(const Eigen::VectorXd& amounts) const;
  /// Measures the discs that are new, all together.
  void measure(std::span<const Candidate> some);

  Positions positions_;
  Triangles triangles_;
  DistanceFunction distances_;
  double radius_;
  std::vector<bool> inside_;
  std::vector<std::vector<int>> triangles_of_vertex_;
  std::map<VertexIndex, Disc> discs_;  // measured so far
};

struct FarthestDiscsOptions {
  double radius = 1;  ///< along the surface, length > 0
  int count = 400;    ///< >= 1
  /// Vertices that discs may contain (N); empty for all.
  std::vector<bool> inside = {};
};

/// Discs of one radius that are spread over a mesh. The first centre is the vertex farthest from
/// the mean of all. Each further centre is the vertex farthest, in a straight line, from all
/// centres so far. There are fewer than `count` if every possible vertex is a centre. Vertices
/// without triangles cannot be centres.
///
/// `positions` N x 3, `triangles` M x 3, `distances` along them. Throws std::invalid_argument for
/// options out of range, and whatever the distances throw.
std::vector<Disc> farthest_discs(const Positions& positions, const Triangles& triangles,
                                 const DistanceFunction& distances,
                                 const FarthestDiscsOptions& options);

}  // namespace mimetra
