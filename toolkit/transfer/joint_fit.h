#pragma once

#include <memory>
#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/vertex_pull.h"

namespace mimetra {

struct JointFitOptions {
  EdgeSum edges = EdgeSum::all;
  /// Most alternations; a dozen usually suffice. 0 keeps the rotations unchanged.
  int iterations = 100;
  /// Pairing of source and target if their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  static constexpr Option kEdges{"edges", &JointFitOptions::edges};
  static constexpr Option kIterations{"iterations", &JointFitOptions::iterations, {.minimum = 0}};
  static constexpr auto declared() { return std::tuple(kEdges, kIterations); }
};

struct HeadAndExpressions {
  std::vector<RigidTransform> motion;  ///< maps the rest pose to the frame's place (F)
  Eigen::MatrixXd weights;             ///< beta (F x D), each within [0, 1]
};

/// Joint fit of head rotations R and blendshape weights of a target to a source.
///
/// For each frame, it minimises sum_{i in L} ||Q_i V_i - R V~_i(beta)||^2 over rotations R and beta
/// in [0, 1]. If every vertex moves, this separates head from face by the deformations that the
/// target's expressions can explain.
///
/// A rigid fit of the edges V~_i(beta) to Q_i V_i alternates with the box solve of eq. 10 for R^T
/// Q_i. Neither step increases the sum. Both need only 9 (D + 1) numbers a frame, so the cost of an
/// alternation does not grow with the mesh. The translation maps the mean of the rest pose plus the
/// displacements of beta to the frame's mean. Queries are const.
class JointFit {
 public:
  /// Parameters as for BlendshapeTransfer; the source must lie over the target. Throws
  /// MismatchError if the vertex counts differ. Throws std::invalid_argument if a triangle or an
  /// option is out of range. Throws Cancelled.
  JointFit(const Positions& source_rest, const BlendshapeModel& target, std::vector<int> triangles,
           const JointFitOptions& options = {}, const Context& context = {});

  /// `start` (F) is an estimate of the motion. A frame equal to the rest pose gets the identity and
  /// no expression. Throws MismatchError if sizes differ, what reading throws, and Cancelled.
  HeadAndExpressions operator()(const FrameSource& performance,
                                const std::vector<RigidTransform>& start,
                                const Context& context = {}) const;

 private:
  struct Head {
    Eigen::Matrix3d rotation;
    Eigen::VectorXd beta;
  };

  Head solve(const RotationMoments::Moments& moments, const Eigen::Matrix3d& start) const;
  Eigen::VectorXd right_hand_side(const RotationMoments::Moments& moments,
                                  const Eigen::Matrix3d& rotation) const;
  Eigen::Matrix3d rotation_of(const RotationMoments::Moments& moments,
                              const Eigen::VectorXd& beta) const;
  Eigen::Vector3d mean_of(const PositionsView& pose) const;

  Positions rest_;
  DeformationGradients gradients_;
  Eigen::MatrixXd gram_;
  RotationMoments moments_;
  Eigen::VectorXd upper_;              // 1, or 0 for columns without motion in L
  std::vector<VertexIndex> vertices_;  // vertices of the target's triangles in L
  Eigen::Vector3d rest_mean_;
  Eigen::Matrix3Xd mean_fields_;  // mean displacement of each expression
  JointFitOptions options_;
};

}  // namespace mimetra
