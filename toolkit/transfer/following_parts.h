#pragma once

#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Connected parts of a target none of whose triangles has a partner, such as the eyes and teeth of
/// a head that no marker reaches: each moves rigidly with the surface around it, so that it neither
/// stays behind nor is bent.
///
/// What is around a part are vertices that have carriers, those near up to 200 of its own. Its
/// motion is the rigid one that fits them best, where those count most that it fits already, from
/// no motion on: lids that close over an eye do not turn it, a jaw takes its teeth along.
class FollowingParts {
 public:
  /// `rest` N x 3 and `triangles` of the target.
  FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                 const Pairing& pairing);

  /// Whether a vertex is of such a part (N).
  const std::vector<bool>& vertices() const { return is_following_; }
  /// A pose whose other vertices are where they belong, with these parts where they follow to.
  void place(Eigen::Map<Positions> pose) const;
  /// Weights of vertices (N) with those of each part replaced by one, the mean of what is around.
  Eigen::VectorXd with_surface(Eigen::VectorXd weights) const;

 private:
  struct Part {
    std::vector<VertexIndex> vertices;
    std::vector<VertexIndex> around;
    Eigen::VectorXd counts;  // how many vertices of the part each of `around` is near
  };

  void look_around(Part& part, const std::vector<VertexIndex>& carried) const;

  Positions rest_;
  std::vector<bool> is_following_;
  std::vector<Part> parts_;
  double size_ = 0;
};

}  // namespace mimetra
