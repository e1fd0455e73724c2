#pragma once

#include <memory>
#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/option.h"
#include "toolkit/model/animation.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

struct LocalWeightsOptions {
  /// Weight of a term that pulls each region's weights towards the whole face's. It is a share of
  /// the mean diagonal of the region's Gram matrix over the expressions that move in the region.
  double ridge = 1;
  EdgeSum edges = EdgeSum::all;
  /// Pairing of source and target if their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  /// The minimum is above 0, because weights that a region hardly sees would be arbitrary without
  /// the ridge.
  static constexpr Option kRidge{"ridge", &LocalWeightsOptions::ridge, {.minimum = 1e-6}};
  static constexpr Option kEdges{"edges", &LocalWeightsOptions::edges};
  static constexpr auto declared() { return std::tuple(kRidge, kEdges); }
};

struct RegionalWeights {
  Eigen::MatrixXd beta;  ///< F x R D, column r D + j, each within [0, 1]
  /// Largest box_optimality_violation() over all frames.
  double violation = 0;
};

/// Blendshape weights of several regions that follow a source together.
///
/// The functional is eq. 10 for the target neutral + sum_r share_r sum_j beta_rj dV_j. A ridge
/// pulls the weights of a region towards the weights of the whole face. All regions are minimised
/// in one problem over the box. If regions were solved one by one, they would ignore each other
/// where they overlap. Their blend is worse than the weights of the whole face.
class LocalWeights {
 public:
  /// `source_rest` and `triangles` are as in BlendshapeTransfer. `shares` (N x R) are of the
  /// target's vertices, and each row adds up to 1. Keeps a reference to the target's displacement
  /// fields.
  ///
  /// Throws MismatchError if the vertex counts differ or the target has no expressions. Throws
  /// std::invalid_argument if a triangle or an option is out of range, or if shares have another
  /// number of vertices. Throws Cancelled.
  LocalWeights(const Positions& source_rest, const BlendshapeModel& target,
               const RegionShares& shares, std::vector<int> triangles,
               const LocalWeightsOptions& options = {}, const Context& context = {});
  ~LocalWeights();
  LocalWeights(LocalWeights&&) noexcept;
  LocalWeights& operator=(LocalWeights&&) noexcept;

  /// `global` (F x D, within [0, 1]) are the weights of the whole face. A region keeps them for
  /// expressions that do not move in it. Throws MismatchError if sizes disagree, what reading
  /// throws, and Cancelled.
  RegionalWeights weights(const FrameSource& performance, const Eigen::MatrixXd& global,
                          const Context& context = {}) const;

  /// A^T A of the joint problem without its ridge (R D x R D). Blocks of regions without a common
  /// triangle are 0.
  const Eigen::MatrixXd& gram() const;
  /// Weight of the ridge for each unknown (R D); 0 for expressions that do not move in their
  /// region.
  const Eigen::VectorXd& pull() const;
  /// A^T b for one frame of the source (R D). Throws MismatchError if the vertex counts differ.
  Eigen::VectorXd right_hand_side(const Eigen::Ref<const Positions>& frame) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
