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
  /// Angle of the rotation in degrees, 0 to 180.
  double angle() const;
  bool is_identity() const;
};

/// Rigid transform that carries `from` to `to` (both N x 3) with the least sum of weighted squared
/// distances. Its rotation is U diag(1, 1, det) V^T, never a reflection. `weights` are N numbers >=
/// 0; empty means all ones. Throws std::invalid_argument if sizes differ, or if no weight is
/// positive.
///
/// [Umeyama. Least-squares estimation of transformation parameters between two point patterns.
/// IEEE PAMI 13(4), 1991]
RigidTransform rigid_fit(const Eigen::Ref<const Positions>& from,
                         const Eigen::Ref<const Positions>& to,
                         const Eigen::VectorXd& weights = {});

/// Rotation that carries points x to y, both relative to their centres, with the least sum of
/// squared distances. It is U diag(1, 1, det) V^T for `cross_covariance` = sum y x^T = U S V^T.
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& cross_covariance);

enum class AlignmentVertices {
  stable,  ///< robust: finds the vertices that move least together with the motion
  all      ///< least squares over all vertices, so that a moving jaw reads as rotation
};

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

/// Rigid motion of each frame relative to the rest pose (F).
///
/// `stable` fits all frames at once and weighs each vertex by how little residual the rigid motion
/// leaves. The motion is exact if at least one vertex in twenty is still on the head. Rigid motion
/// that is added to the frames does not change the aligned sequence, which only follows the rest
/// pose. If noise of the still vertices explains the motion (up to three standard errors of the
/// fit), all transforms are the identity.
///
/// `stable` reads all frames up to 41 times; pass slow sources through stored() first. Throws
/// whatever reading throws, and Cancelled.
std::vector<RigidTransform> rigid_motion(const FrameSource& source,
                                         const AlignmentOptions& options = {},
                                         const Context& context = {});

/// Motion of the vertices that move least, and how reliable it is.
struct StableMotion {
  /// Result of rigid_motion() (F).
  std::vector<RigidTransform> motion;
  /// Remaining motion of the stillest vertices: root mean square residual over the frames, 5th
  /// percentile over the vertices.
  double stillest = 0;
  /// Disagreement between halves of the vertices, in degrees. The weighted vertices are halved
  /// across each of their three principal axes, and each half gives a rotation per frame. This is
  /// the root mean square angle between the two rotations, for the worst axis. It is 0 up to noise
  /// if part of the head is still.
  double disagreement = 0;
};

/// Largest disagreement, in degrees, at which the head's motion is reliable. With still vertices,
/// halves disagree by up to 0.03 at noise of 0.1 % of the size, or 0.24 if few. On faces that move
/// everywhere, they disagree by at least 0.5, and the motion is wrong by 0.2 to 1.6.
constexpr double kUncertainDisagreement = 0.35;

/// Computes rigid_motion() with AlignmentVertices::stable. Throws as rigid_motion().
StableMotion stable_motion(const FrameSource& source, const Context& context = {});

/// Source whose frame f is motion[f].apply(frame f), computed on reading; the rest pose is
/// unchanged. Throws MismatchError unless there is one transform per frame.
std::shared_ptr<const FrameSource> with_motion(std::shared_ptr<const FrameSource> source,
                                               std::vector<RigidTransform> motion);

/// Inverse of with_motion(): motion[f] carries frame f of the result to frame f of the source.
std::shared_ptr<const FrameSource> without_motion(std::shared_ptr<const FrameSource> source,
                                                  const std::vector<RigidTransform>& motion);

/// A sequence without its rigid motion, and the motion that was removed.
struct Alignment {
  MeshSequence sequence;
  /// motion[f] carries frame f of `sequence` to frame f of the input (F).
  std::vector<RigidTransform> motion;
};

/// Removes rigid_motion(sequence) from each frame.
Alignment align(const MeshSequence& sequence, const AlignmentOptions& options = {},
                const Context& context = {});

/// Removes the given motion (F). Throws MismatchError unless there is one transform per frame.
Alignment align(const MeshSequence& sequence, std::vector<RigidTransform> motion);

/// Applies the motion (F) to the frames. Throws MismatchError unless there is one transform per
/// frame.
MeshSequence with_motion(const MeshSequence& sequence, std::vector<RigidTransform> motion);

/// The sequence of align(sequence).
MeshSequence rigidly_aligned(const MeshSequence& sequence);

}  // namespace mimetra
