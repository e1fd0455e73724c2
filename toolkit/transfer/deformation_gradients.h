#pragma once

#include <vector>

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

/// False for a triangle of quality below kDegenerateQuality, whose frame has no usable inverse.
bool has_usable_frame(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                      int triangle);

/// The deformation gradients Q_i = U~_i U_i^-1 of a source (eq. 9): which triangles are usable, and
/// what stands in for the others.
///
/// A triangle of the rest pose with quality below kDegenerateQuality would give a gradient that
/// grows without bound. It takes the mean of its usable neighbours' gradients instead, or the
/// identity where it has none.
class DeformationGradients {
 public:
  /// `triangles` M x 3; `selected` (L) are rows of it. Throws std::invalid_argument for a row out
  /// of range.
  DeformationGradients(const Positions& rest, const Triangles& triangles,
                       std::vector<int> selected);

  /// Q_i of each selected triangle, 3 L x 3 (three rows a triangle), for one frame (N x 3).
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> operator()(
      const Eigen::Ref<const Positions>& frame) const;

  const std::vector<int>& selected() const { return selected_; }
  /// Selected triangles whose gradient is a stand-in.
  int replaced() const { return replaced_; }

  /// Triangles whose gradients are averaged for the selected triangle number s: itself as a rule,
  /// its usable neighbours where it is degenerate, none where the identity stands in.
  const std::vector<int>& sources(int s) const { return sources_[s]; }
  /// U_i^-1 of a triangle that is among the sources of a selected one.
  const Eigen::Matrix3d& inverse_frame(int triangle) const { return inverse_frames_[triangle]; }

 private:
  Triangles triangles_;
  std::vector<int> selected_;
  std::vector<std::vector<int>> sources_;
  std::vector<Eigen::Matrix3d> inverse_frames_;  // of every triangle; the identity where unused
  int replaced_ = 0;
};

}  // namespace mimetra
