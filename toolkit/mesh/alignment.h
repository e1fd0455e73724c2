#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

/// x -> rotation x + translation.
struct RigidTransform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Positions apply(const Eigen::Ref<const Positions>& positions) const;
  RigidTransform inverse() const;
  /// Of the rotation; degrees, 0 to 180.
  double angle() const;
  bool is_identity() const;
};

/// The rigid transform that carries `from` to `to` (both N x 3) with the least sum of weighted
/// squared distances: U diag(1, 1, det) V^T, never a reflection. `weights` (N, >= 0) or empty for
/// ones. Throws std::invalid_argument where sizes differ or all weights are 0.
///
/// [Umeyama. Least-squares estimation of transformation parameters between two point patterns.
/// IEEE PAMI 13(4), 1991]
RigidTransform rigid_fit(const Eigen::Ref<const Positions>& from,
                         const Eigen::Ref<const Positions>& to,
                         const Eigen::VectorXd& weights = {});

/// The rotation that carries points x to y with the least sum of squared distances, both from their
/// centres: U diag(1, 1, det) V^T of sum y x^T = U S V^T.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& cross_covariance);

enum class AlignmentVertices {
  stable,  ///< robust: the vertices that move least, found together with the motion
  all      ///< least squares over all vertices (reads a moving jaw as rotation)
};

/// As people choose it.
constexpr std::string_view choice_name(AlignmentVertices value) {
  switch (value) {
    case AlignmentVertices::stable:
      return "stable";
    case AlignmentVertices::all:
      return "all";
  }
  return {};
}

struct AlignmentOptions {
  AlignmentVertices vertices = AlignmentVertices::stable;

  static constexpr Option kVertices{"vertices", &AlignmentOptions::vertices};
  static constexpr auto declared() { return std::tuple(kVertices); }
};

/// The rigid motion of each frame relative to the rest pose (F).
///
/// `stable` weighs each vertex, over all frames at once, by how little the rigid motion leaves of
/// it. Where one vertex in twenty or more is still on the head, the motion is exact; a sequence
/// that was moved rigidly per frame gives the same result, moved as its rest pose was. Where the
/// motion found is no larger than noise of the still vertices' own size can feign (three standard
/// errors of the fit), every transform is the identity.
///
/// `stable` reads all frames up to 40 times, so that a source that is slow to read should be
/// stored(). Throws what reading throws, Cancelled.
std::vector<RigidTransform> rigid_motion(const FrameSource& source,
                                         const AlignmentOptions& options = {},
                                         const Context& context = {});

/// The motion of what moves least, and how well that tells it.
struct StableMotion {
  /// As rigid_motion() finds it (F).
  std::vector<RigidTransform> motion;
  /// How far the stillest vertices still move: what the motion leaves of the one that one in twenty
  /// stays below, root mean square over the frames.
  double stillest = 0;
  /// The vertices that tell the motion, by weight, are halved across each of their three principal
  /// axes: root mean square angle between the rotations that two halves tell, the largest of the
  /// three; degrees. Where a still part of the head tells them it is 0 up to noise.
  double disagreement = 0;
};

/// Above this disagreement, in degrees, no vertex is still enough to tell the head's motion. Where
/// vertices are still, halves disagree by up to 0.03 with noise of 0.1 % of the size, and by 0.24
/// where they are few; on faces that move everywhere by 0.5 and more, and the motion is then wrong
/// by 0.2 to 1.6.
constexpr double kUncertainDisagreement = 0.35;

/// rigid_motion() with AlignmentVertices::stable. Throws the same.
StableMotion stable_motion(const FrameSource& source, const Context& context = {});

/// Frame f becomes motion[f].apply(frame f) when it is read; the rest pose stays as it is. Throws
/// MismatchError where the count differs from the frames.
std::shared_ptr<const FrameSource> with_motion(std::shared_ptr<const FrameSource> source,
                                               std::vector<RigidTransform> motion);

/// The opposite: motion[f] carries frame f of the result to frame f of the source.
std::shared_ptr<const FrameSource> without_motion(std::shared_ptr<const FrameSource> source,
                                                  const std::vector<RigidTransform>& motion);

/// A sequence without its rigid motion, and that motion.
struct Alignment {
  MeshSequence sequence;
  /// motion[f] carries frame f of `sequence` to frame f of the input (F).
  std::vector<RigidTransform> motion;
};

/// Removes rigid_motion(sequence) from each frame.
Alignment align(const MeshSequence& sequence, const AlignmentOptions& options = {},
                const Context& context = {});

/// Removes the given motion (F). Throws MismatchError where the count differs from the frames.
Alignment align(const MeshSequence& sequence, std::vector<RigidTransform> motion);

/// Gives the motion (F) back. Throws MismatchError.
MeshSequence with_motion(const MeshSequence& sequence, std::vector<RigidTransform> motion);

/// The sequence of align(sequence).
MeshSequence rigidly_aligned(const MeshSequence& sequence);

}  // namespace mimetra
