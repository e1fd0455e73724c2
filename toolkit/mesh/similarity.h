#pragma once

#include <memory>

#include "toolkit/mesh/alignment.h"

namespace mimetra {

/// x -> scale * rotation (x - from) + to. The rotation is improper where it mirrors.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();

  /// Bit by bit the same positions where is_identity(). N x 3.
  Positions apply(const Eigen::Ref<const Positions>& positions) const;
  /// S M S^-1: the motion M as it looks where S leads.
  RigidTransform carry(const RigidTransform& motion) const;
  /// Of the rotation, without the mirroring; degrees, 0 to 180.
  double angle() const;
  bool mirrors() const;
  bool is_identity() const;
};

/// The similarity that carries `from` to `to` (both N x 3) with the least sum of squared distances;
/// the identity where they are equal. It mirrors where that leaves less than a tenth (root mean
/// square) of what no proper one can avoid. Throws std::invalid_argument where sizes differ,
/// MismatchError where the points determine no rotation: they lie on a line, say.
///
/// [Umeyama. Least-squares estimation of transformation parameters between two point patterns.
/// IEEE PAMI 13(4), 1991]
Similarity similarity_fit(const Eigen::Ref<const Positions>& from,
                          const Eigen::Ref<const Positions>& to);

/// Whether left stays left.
enum class Handedness { kept, mirrored };

/// The same among those that mirror, or those that do not.
Similarity similarity_fit(const Eigen::Ref<const Positions>& from,
                          const Eigen::Ref<const Positions>& to, Handedness handedness);

/// The same without a rotation: only their size (the root mean square distance from the centre) and
/// place. Throws std::invalid_argument where sizes differ, MismatchError where all points of one
/// are at one place.
Similarity scaling_fit(const Eigen::Ref<const Positions>& from,
                       const Eigen::Ref<const Positions>& to);

/// The frames and the rest pose of a source, carried when they are read.
std::shared_ptr<const FrameSource> carried(std::shared_ptr<const FrameSource> source,
                                           const Similarity& similarity);

}  // namespace mimetra
