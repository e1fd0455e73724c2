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
  /// Pull of the weights of each region towards those of the whole face, as a share of the trace of
  /// its Gram matrix over the number of expressions that move in it.
  double ridge = 1;
  EdgeSum edges = EdgeSum::all;
  /// Of source and target where their faces differ, or null.
  std::shared_ptr<const Pairing> pairing = {};

  /// Without it, what a region hardly sees is anything.
  static constexpr Option kRidge{"ridge", &LocalWeightsOptions::ridge, {.minimum = 1e-6}};
  static constexpr Option kEdges{"edges", &LocalWeightsOptions::edges};
  static constexpr auto declared() { return std::tuple(kRidge, kEdges); }
};

/// Weights of each region for every frame.
struct RegionalWeights {
  Eigen::MatrixXd beta;  ///< F x R D, column r D + j, each within [0, 1]
  /// Largest box_optimality_violation() of all frames.
  double violation = 0;
};

/// Blendshape weights of each of some regions that follow a source together: the functional of
/// eq. 10 for the target neutral + sum_r share_r sum_j beta_rj dV_j, with a ridge that draws the
/// weights of a region towards those of the whole face, minimised in one problem over the box.
///
/// One after the other regions would not know what the others do where they overlap, and the
/// blend of what they found is worse than the weights of the whole face.
class LocalWeights {
 public:
  /// `source_rest` and `triangles` as in BlendshapeTransfer; `shares` N x R of the target's
  /// vertices, in each row adding up to 1. Keeps a reference to the target. Throws
  /// MismatchError if the vertex counts differ or the target has no expressions,
  /// std::invalid_argument for a triangle or an option out of range and for shares of another
  /// number of vertices, Cancelled.
  LocalWeights(const Positions& source_rest, const BlendshapeModel& target,
               const RegionShares& shares, std::vector<int> triangles,
               const LocalWeightsOptions& options = {}, const Context& context = {});
  ~LocalWeights();
  LocalWeights(LocalWeights&&) noexcept;
  LocalWeights& operator=(LocalWeights&&) noexcept;

  /// `global` F x D within [0, 1] are the weights of the whole face: where an expression does not
  /// move in a region, that region has them. Throws MismatchError where sizes disagree, Cancelled,
  /// and what reading throws.
  RegionalWeights weights(const FrameSource& performance, const Eigen::MatrixXd& global,
                          const Context& context = {}) const;

  /// A^T A of the joint problem without its ridge (R D x R D): 0 between regions without a common
  /// triangle.
  const Eigen::MatrixXd& gram() const;
  /// The weight of the ridge on each unknown (R D); 0 where it is not seen.
  const Eigen::VectorXd& pull() const;
  /// A^T b of one frame of the source (R D).
  Eigen::VectorXd right_hand_side(const Eigen::Ref<const Positions>& frame) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
