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
  /// Alternations at most; a dozen are needed as a rule. 0 keeps the rotations as they are.
  int iterations = 100;
  /// Of source and target where their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  static constexpr Option kEdges{"edges", &JointFitOptions::edges};
  static constexpr Option kIterations{"iterations", &JointFitOptions::iterations, {.minimum = 0}};
  static constexpr auto declared() { return std::tuple(kEdges, kIterations); }
};

/// The head's motion and the expressions of each frame.
struct HeadAndExpressions {
  std::vector<RigidTransform> motion;  ///< carries the rest pose's place to the frame's (F)
  Eigen::MatrixXd weights;             ///< beta (F x D), each within [0, 1]
};

/// Head rotations R and blendshape weights of a target that follow a source together: minimise over
/// rotations R and 0 <= beta <= 1 of sum_{i in L} ||Q_i V_i - R V~_i(beta)||^2 for each frame.
/// Where every vertex moves, this tells head from face by what the target's expressions can do.
///
/// A rigid fit of the edges V~_i(beta) to Q_i V_i alternates with the box solve of eq. 10 for
/// R^T Q_i, which never makes the sum larger. Both need 9 (D + 1) numbers of a frame, so that an
/// alternation costs nothing that grows with the mesh. The translation carries the mean of the
/// rest pose and the displacements of beta to the frame's. Queries are const.
class JointFit {
 public:
  /// As BlendshapeTransfer, whose source stands where the target does. Throws MismatchError if the
  /// vertex counts differ, std::invalid_argument for triangles or options out of range, Cancelled.
  JointFit(const Positions& source_rest, const BlendshapeModel& target, std::vector<int> triangles,
           const JointFitOptions& options = {}, const Context& context = {});

  /// `start` (F): what is known of the motion. A frame that is the rest pose keeps the identity and
  /// no expression. Throws MismatchError where sizes differ, Cancelled, and what reading throws.
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
  Eigen::VectorXd upper_;              // 1, or 0 for columns that do not move in L
  std::vector<VertexIndex> vertices_;  // of the target's triangles
  Eigen::Vector3d rest_mean_;
  Eigen::Matrix3Xd mean_fields_;  // mean displacement of each expression
  JointFitOptions options_;
};

}  // namespace mimetra
