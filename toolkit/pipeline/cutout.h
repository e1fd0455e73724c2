#pragma once

#include <vector>

#include "toolkit/splocs/decomposition.h"

namespace mimetra {

/// Some vertices of a mesh, decomposed as if there were no others, but for distances, which still
/// run along the whole surface. Internal to the analysis.
class Cutout {
 public:
  /// `inside` (N), true for those that are cut out. \pre one is
  explicit Cutout(const std::vector<bool>& inside);

  int vertices() const { return static_cast<int>(kept_.size()); }
  /// Frames and rest pose of the kept vertices (n), and the triangles that have no others.
  std::shared_ptr<const FrameSource> of(std::shared_ptr<const FrameSource> whole) const;
  /// Distances between kept vertices, of `distances` between all of them.
  DistanceFunction of(DistanceFunction distances) const;
  /// The kept entries (n) of one value a vertex (N).
  std::vector<int> of(const std::vector<int>& values) const;
  /// Components of the kept vertices as components of the whole mesh: zero outside, where the
  /// support maps are 1.
  Components put_back(Components components, const FrameSource& whole) const;

 private:
  std::vector<VertexIndex> kept_;      ///< ascending (n)
  std::vector<VertexIndex> position_;  ///< in kept_, -1 for the others (N)
};

}  // namespace mimetra
