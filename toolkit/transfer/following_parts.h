#pragma once

#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Connected parts of a target that no motion is solved for: none of their triangles has a partner
/// in the source, or none of their vertices a share of the motion.
///
/// Parts that the surface which moves encloses (eyes, teeth, a tongue) or that lie against it
/// (lashes, brows, a beard) follow it: each moves rigidly with the surface around it. All others,
/// such as hair, glasses, clothes and a body, stay where they are.
///
/// A part is enclosed if, averaged over its vertices, six of ten directions end on the surface of
/// the parts that move, or three of ten on its back. It lies against that surface if no vertex is
/// farther from it than 2 % of the box diagonal of their vertices (with carriers). On published
/// heads and avatars, eyes, teeth and tongues meet the surface in 71 to 100 % of the directions,
/// glasses in 41, hair in 21, bodies and clothes in up to 6.
///
/// The motion is the rigid one that fits best what is around the part, those of these vertices that
/// are nearest to up to 200 of its own. Those that the motion fits already count most,
/// starting with no motion: lids that close over an eye do not turn it, a jaw takes its teeth
/// along.
class FollowingParts {
 public:
  /// `rest` (N x 3) and `triangles` of the target.
  FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                 const Pairing& pairing);
  /// Where the target has the source's faces: parts of which all weights (N) are 0.
  FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                 const Eigen::VectorXd& weights);

  /// True for vertices of such parts, whether they follow or stay (N).
  const std::vector<bool>& without_motion() const { return without_motion_; }
  /// Vertices of each part that follows, ascending.
  std::vector<std::vector<VertexIndex>> parts() const;
  /// How far a vertex of each of parts() is from its rest position at most, over poses (F x 3N).
  std::vector<double> farthest(const Eigen::Ref<const Frames>& poses) const;
  /// Moves the parts that follow; the other vertices of the pose are where they belong already.
  void place(Eigen::Map<Positions> pose) const;
  /// Weights of vertices (N): parts that follow get the mean weight of what is around them, parts
  /// that stay get 0.
  Eigen::VectorXd with_surface(Eigen::VectorXd weights) const;

 private:
  struct Part {
    std::vector<VertexIndex> vertices;
    std::vector<VertexIndex> around;
    Eigen::VectorXd counts;  // how many vertices of the part each of `around` is near
  };

  void find(const Triangles& triangles, const Weld& weld, const std::vector<bool>& moves,
            std::vector<VertexIndex> carried);
  void look_around(Part& part, const std::vector<VertexIndex>& carried) const;

  Positions rest_;
  std::vector<bool> without_motion_;
  std::vector<Part> parts_;
  double size_ = 0;
};

}  // namespace mimetra
