#pragma once

#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Frame [e1 e2 n] of a triangle, with edges e1 = b - a, e2 = c - a and n = e1 x e2 /
/// sqrt(|e1 x e2|). n is as long as an edge: scaling a triangle by s scales its frame by s (eq. 8).
/// The third column is 0 if the triangle has no area.
Eigen::Matrix3d triangle_frame(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c);

/// Frame of row `triangle` of `triangles` at `positions`.
Eigen::Matrix3d triangle_frame(const Eigen::Ref<const Positions>& positions,
                               const Triangles& triangles, int triangle);

/// Gradients of a triangle's three hat functions in its plane, one a column.
using HatGradients = Eigen::Matrix3d;

HatGradients hat_gradients(const Positions& rest, const Triangles& triangles, int triangle);

/// Lowest quality (triangle_quality()) of a sound triangle. Valid faces go down to 2e-2. Below, the
/// noise that a frame adds to a gradient grows as 1 / quality.
constexpr double kSoundQuality = 2e-2;

/// Share of its own gradient that a triangle of a source keeps: 1 from kSoundQuality on, and 0
/// below kDegenerateQuality. In between the share is (quality / kSoundQuality)^2, so that noise
/// fades out with the triangle.
double own_share(double quality);

/// Weight of a target's triangle by its quality, 1 if sound and 0 if degenerate. A sliver's
/// stiffness grows as 1 / quality^2 and its normal becomes arbitrary. The weight therefore falls as
/// the fourth power of the quality.
double target_share(double quality);

/// Quality of row `triangle` of `triangles` at `positions`.
double quality_of(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                  int triangle);

/// Deformation gradients Q_i = U~_i U_i^-1 of a source (eq. 9), with substitutes for slivers.
///
/// A sliver of the rest pose keeps own_share() of its gradient. The triangles around it supply the
/// rest, ring by ring. Each triangle passes its amount to its neighbours in proportion to the
/// shared edges. A neighbour keeps own_share() of what it gets and passes on the remainder. If the
/// rings contain no sound triangle, the identity takes its place.
///
/// If the target has other faces, its triangle gets the weighted mean of its partners' gradients. A
/// triangle without a partner gets the identity and keeps its shape.
class DeformationGradients {
 public:
  /// `triangles` is M x 3, and `selected` (L) are rows of it. `joined` (M x 3) are the same
  /// triangles on welded vertices (Weld::welded()), which define neighbours. Pass null if no
  /// vertices coincide. Throws std::invalid_argument if a row is out of range.
  DeformationGradients(const Positions& rest, const Triangles& triangles, std::vector<int> selected,
                       const Triangles* joined = nullptr);
  /// `rest`, `triangles` and `joined` belong to the source. `selected` are triangles of the target.
  DeformationGradients(const Positions& rest, const Triangles& triangles,
                       const Correspondence& pairs, std::vector<int> selected,
                       const Triangles* joined = nullptr);

  /// Q_i of each selected triangle for one frame (N x 3), three rows a triangle (3 L x 3).
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> operator()(
      const Eigen::Ref<const Positions>& frame) const;

  const std::vector<int>& selected() const { return selected_; }
  /// Triangles of the source.
  const Triangles& triangles() const { return triangles_; }
  /// Number of selected triangles that keep less than half of their own or their partners'
  /// gradient.
  int replaced() const { return replaced_; }

  /// A triangle of the source and the share of its gradient.
  struct Part {
    int triangle;
    double share;
  };

  /// Parts of the gradient of selected triangle number s, usually only itself. If the shares add up
  /// to less than 1, the identity has the rest.
  const std::vector<Part>& parts(int s) const { return parts_[s]; }
  /// U_i^-1 of a triangle that is part of a selected triangle's gradient.
  const Eigen::Matrix3d& inverse_frame(int triangle) const { return inverse_frames_[triangle]; }

 private:
  DeformationGradients(const Positions& rest, const Triangles& triangles,
                       const Correspondence* pairs, std::vector<int> selected,
                       const Triangles* joined);

  Triangles triangles_;
  std::vector<int> selected_;
  std::vector<std::vector<Part>> parts_;
  std::vector<Eigen::Matrix3d> inverse_frames_;  // one per source triangle; the identity if unused
  int replaced_ = 0;
};

/// Gradients for triangles of a target. Without a pairing (null), `triangles` belong to both
/// meshes. `joined` belongs to the source.
DeformationGradients gradients_between(const Positions& source_rest, const Triangles& triangles,
                                       const Pairing* pairing, std::vector<int> selected,
                                       const Triangles* joined = nullptr);

}  // namespace mimetra
