#pragma once

#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Connected parts of a target whose motion is not solved for. None of their triangles has a
/// partner in the source, or none of their vertices has a share of the motion.
///
/// A part follows the moving surface if the surface encloses it (eyes, teeth, a tongue) or the part
/// lies against it (lashes, brows, a beard). It then moves rigidly with the surface around it. All
/// other parts, such as hair, glasses, clothes and a body, stay where they are.
///
/// A part is enclosed if rays from its vertices meet the moving surface in six of ten directions,
/// or its back in three of ten. A part lies against the surface if each of its vertices is close to
/// it. The limit is 2 % of the box diagonal of the moving vertices (with carriers). On published
/// heads and avatars, eyes, teeth and tongues meet the surface in 71 to 100 % of the directions.
/// Glasses meet it in 41 %, hair in 21 %, bodies and clothes in up to 6 %.
///
/// The rigid motion is fitted to the surface vertices nearest to up to 200 of the part's vertices.
/// Vertices that the motion already fits weigh most, starting with no motion. Lids that close over
/// an eye therefore do not turn it, while a jaw takes its teeth along.
class FollowingParts {
 public:
  /// `rest` (N x 3) and `triangles` belong to the target.
  FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                 const Pairing& pairing);
  /// For a target with the source's faces: parts whose weights (N) are all 0.
  FollowingParts(Positions rest, const Triangles& triangles, const Weld& weld,
                 const Eigen::VectorXd& weights);

  /// Vertices of parts that are not solved for, whether they follow or stay (N).
  const std::vector<bool>& without_motion() const { return without_motion_; }
  /// Vertices of each part that follows, ascending.
  std::vector<std::vector<VertexIndex>> parts() const;
  /// Largest distance of a vertex from its rest position over all poses (F x 3N), for each of
  /// parts().
  std::vector<double> farthest(const Eigen::Ref<const Frames>& poses) const;
  /// Moves the parts that follow. The other vertices of the pose must be final.
  void place(Eigen::Map<Positions> pose) const;
  /// Weights of vertices (N) in which parts that follow get the mean weight of the surface around
  /// them. Parts that stay get 0.
  Eigen::VectorXd with_surface(Eigen::VectorXd weights) const;

 private:
  struct Part {
    std::vector<VertexIndex> vertices;
    std::vector<VertexIndex> around;
    Eigen::VectorXd counts;  // number of the part's vertices near each of `around`
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
