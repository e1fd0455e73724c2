#pragma once

#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Frame [e1 e2 n] of a triangle with edges e1 = b - a, e2 = c - a and n = e1 x e2 / sqrt(|e1 x
/// e2|), whose length is that of an edge: scaling a triangle by s scales its frame by s (eq. 8).
/// The third column is 0 where there is no area.
Eigen::Matrix3d triangle_frame(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c);

/// The frame of row `triangle` of `triangles` at `positions`.
Eigen::Matrix3d triangle_frame(const Eigen::Ref<const Positions>& positions,
                               const Triangles& triangles, int triangle);

/// Gradients of the three hat functions of a triangle in its plane, one a column.
using HatGradients = Eigen::Matrix3d;

HatGradients hat_gradients(const Positions& rest, const Triangles& triangles, int triangle);

/// Triangles of this quality (triangle_quality()) and above are sound: valid faces go down to 2e-2.
/// Below, what a frame's noise makes of a gradient grows as 1 / quality.
constexpr double kSoundQuality = 2e-2;

/// How much of its own gradient a triangle of a source keeps: all of it from kSoundQuality on,
/// below with the square of the quality, so that noise fades out with the triangle; nothing below
/// kDegenerateQuality.
double own_share(double quality);

/// How much a triangle of a target counts. Its stiffness grows as 1 / quality^2 and its normal
/// loses its sense: from sound to degenerate it fades out faster than that, without a jump.
double target_share(double quality);

/// The quality of row `triangle` of `triangles` at `positions`.
double quality_of(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                  int triangle);

/// The deformation gradients Q_i = U~_i U_i^-1 of a source (eq. 9): which triangles are usable, and
/// what stands in for the others.
///
/// A sliver of the rest pose keeps own_share() of its gradient. The rest comes from the triangles
/// around it: it goes to the neighbours in proportion to the edges that they share, each takes as
/// much as it is sound, and the remainder goes on to the next ring. What finds no sound triangle is
/// the identity.
///
/// Where a target has other faces, a triangle of it has the mean of its partners' gradients, by
/// their weights, and the identity without one: it keeps its shape.
class DeformationGradients {
 public:
  /// `triangles` M x 3; `selected` (L) are rows of it. `joined` (M x 3): the same triangles on
  /// vertices that are one (Weld::welded()), by which neighbours are found; null where none are.
  /// Throws std::invalid_argument for a row out of range.
  DeformationGradients(const Positions& rest, const Triangles& triangles, std::vector<int> selected,
                       const Triangles* joined = nullptr);
  /// `rest`, `triangles` and `joined` of the source, `selected` are triangles of the target.
  DeformationGradients(const Positions& rest, const Triangles& triangles,
                       const Correspondence& pairs, std::vector<int> selected,
                       const Triangles* joined = nullptr);

  /// Q_i of each selected triangle, 3 L x 3 (three rows a triangle), for one frame (N x 3).
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> operator()(
      const Eigen::Ref<const Positions>& frame) const;

  const std::vector<int>& selected() const { return selected_; }
  /// Of the source.
  const Triangles& triangles() const { return triangles_; }
  /// Selected triangles that keep less than half of their own, or their partners', gradient.
  int replaced() const { return replaced_; }

  /// A triangle of the source and how much of its gradient is taken.
  struct Part {
    int triangle;
    double share;
  };

  /// What the gradient of the selected triangle number s is made of: itself as a rule. What the
  /// shares lack of 1 is the identity's.
  const std::vector<Part>& parts(int s) const { return parts_[s]; }
  /// U_i^-1 of a triangle that is a part of a selected one's gradient.
  const Eigen::Matrix3d& inverse_frame(int triangle) const { return inverse_frames_[triangle]; }

 private:
  DeformationGradients(const Positions& rest, const Triangles& triangles,
                       const Correspondence* pairs, std::vector<int> selected,
                       const Triangles* joined);

  Triangles triangles_;
  std::vector<int> selected_;
  std::vector<std::vector<Part>> parts_;
  std::vector<Eigen::Matrix3d> inverse_frames_;  // of every triangle; the identity where unused
  int replaced_ = 0;
};

/// Gradients for triangles of a target; its `triangles` are the source's without a pairing (null).
/// `joined` of the source.
DeformationGradients gradients_between(const Positions& source_rest, const Triangles& triangles,
                                       const Pairing* pairing, std::vector<int> selected,
                                       const Triangles* joined = nullptr);

}  // namespace mimetra
