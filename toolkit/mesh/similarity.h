#pragma once

#include <memory>

#include "toolkit/mesh/alignment.h"

namespace mimetra {

/// The map x -> scale * rotation (x - from) + to. `rotation` has determinant -1 if the map mirrors.
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();

  /// Maps positions (N x 3). Returns them bitwise unchanged if is_identity().
  Positions apply(const Eigen::Ref<const Positions>& positions) const;
  /// Motion S M S^-1: `motion` M as seen after this similarity S is applied to its poses.
  RigidTransform carry(const RigidTransform& motion) const;
  /// Angle of the rotation without the mirroring, in degrees, 0 to 180.
  double angle() const;
  bool mirrors() const;
  bool is_identity() const;
};

/// Similarity that carries `from` to `to` (both N x 3) with the least sum of squared distances; the
/// identity if they are equal. It mirrors only if the root mean square distance is then less than a
/// tenth of what the best proper similarity leaves.
///
/// Throws std::invalid_argument if sizes differ or are 0. Throws MismatchError if the points do not
/// determine a rotation, for example because they are on a line.
///
/// [Umeyama. Least-squares estimation of transformation parameters between two point patterns.
/// IEEE PAMI 13(4), 1991]
Similarity similarity_fit(const Eigen::Ref<const Positions>& from,
                          const Eigen::Ref<const Positions>& to);

/// Whether a similarity keeps left and right or exchanges them.
enum class Handedness { kept, mirrored };

/// Best similarity with the given handedness. Throws as similarity_fit().
Similarity similarity_fit(const Eigen::Ref<const Positions>& from,
                          const Eigen::Ref<const Positions>& to, Handedness handedness);

/// Similarity without a rotation. It matches only the centres and the sizes, which are root mean
/// square distances from the centre. Throws std::invalid_argument if sizes differ or are 0, and
/// MismatchError if all points of one set coincide.
Similarity scaling_fit(const Eigen::Ref<const Positions>& from,
                       const Eigen::Ref<const Positions>& to);

/// Source whose frames and rest pose are mapped by `similarity`; frames are mapped on reading.
std::shared_ptr<const FrameSource> carried(std::shared_ptr<const FrameSource> source,
                                           const Similarity& similarity);

}  // namespace mimetra
