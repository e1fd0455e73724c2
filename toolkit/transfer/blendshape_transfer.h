#pragma once

#include <memory>
#include <string>
#include <vector>

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/option.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/model/weight_rules.h"
#include "toolkit/transfer/edges.h"

namespace mimetra {

struct BlendshapeTransferOptions {
  EdgeSum edges = EdgeSum::all;
  /// Weight of |beta|^2, as a share of the Gram matrix' mean diagonal over the columns that L
  /// sees.
  double ridge = 0;
  /// Weight of 2 |beta|_1, as a share of the same.
  double sparsity = 0;
  /// Weight of squared second differences of beta over time: time constant in seconds. The penalty
  /// is (smoothness * frame rate)^4 times the same.
  double smoothness = 0;
  /// Weight of (beta_left - beta_right)^2 for each pair of expressions, as a share of the same.
  /// Pairs of which L sees one only are left out.
  double symmetry = 0;
  /// Expressions of which at most one is there in a frame, by their names.
  Exclusive exclusive = Exclusive::none;
  /// What else is known of the target's expressions.
  WeightRules rules = {};
  /// Of source and target where their faces differ, or null. Triangles without partner show
  /// nothing, also those of L.
  std::shared_ptr<const Pairing> pairing = {};
  /// How often the square of each triangle counts (M), >= 0; empty for once.
  Eigen::VectorXd triangle_weights = {};

  static constexpr Option kEdges{"edges", &BlendshapeTransferOptions::edges};
  static constexpr Option kRidge{"ridge", &BlendshapeTransferOptions::ridge, {.minimum = 0}};
  static constexpr Option kSparsity{
      "sparsity", &BlendshapeTransferOptions::sparsity, {.minimum = 0}};
  static constexpr Option kSmoothness{
      "smoothness", &BlendshapeTransferOptions::smoothness, {.minimum = 0, .maximum = 60}, "s"};
  static constexpr Option kSymmetry{
      "symmetry", &BlendshapeTransferOptions::symmetry, {.minimum = 0}};
  static constexpr Option kExclusive{"exclusive", &BlendshapeTransferOptions::exclusive};
  static constexpr auto declared() {
    return std::tuple(kEdges, kRidge, kSparsity, kSmoothness, kSymmetry, kExclusive);
  }
};

/// Condition number of G_L above which regions hardly determine the weights.
constexpr double kPoorCondition = 1e5;

/// What the chosen triangles show of the target's expressions.
struct BlendshapeConditions {
  /// Columns with no motion in L: their weight is 0 in every frame, or what their rule makes of it.
  std::vector<std::string> unseen;
  /// Columns with G_L,jj < 0.05 G_jj, where all triangles count in G as those of L that count most.
  std::vector<std::string> weakly_seen;
  /// Condition number of G_L over the columns that are seen.
  double condition = 1;
  int degenerate_source_triangles = 0;
  int degenerate_target_triangles = 0;
};

/// Blendshape weights of a target that follow a source's deformation gradients on triangles L:
/// minimise over 0 <= beta <= 1 of sum_{i in L} ||Q_i V_i - V~_i(beta)||^2 (eq. 10, 11), a sum over
/// edges (EdgeSum). Rules of the expressions (WeightRules) change the bounds, draw pairs together
/// and exclude expressions beside others, exactly (RuledLeastSquares).
///
/// The constructor forms the Gram matrix. A frame costs one pass over the triangles of L, which
/// gathers their gradients at the vertices, one product with the displacement fields there, and a
/// solve of D unknowns. Everything is a difference to the rest pose, which itself gives exactly 0.
/// Queries are const.
class BlendshapeTransfer {
 public:
  /// `source_rest` N x 3 has the connectivity of the target, or of the pairing's source;
  /// `triangles` are rows of target.triangles(). Throws MismatchError if the vertex counts differ,
  /// if no expression of the target moves in `triangles`, if the rules do not fit the target
  /// (ExpressionRules), and for a sparsity of weights that may be negative by rule;
  /// std::invalid_argument for a triangle, an option or a triangle weight out of range; Cancelled.
  BlendshapeTransfer(const Positions& source_rest, const BlendshapeModel& target,
                     std::vector<int> triangles, const BlendshapeTransferOptions& options = {},
                     const Context& context = {});
  ~BlendshapeTransfer();
  BlendshapeTransfer(BlendshapeTransfer&&) noexcept;
  BlendshapeTransfer& operator=(BlendshapeTransfer&&) noexcept;

  /// beta for every frame (F x D), each within [0, 1]; with rules, the weights to write. Throws
  /// MismatchError, Cancelled, and what reading throws, as does rest_looks_unneutral().
  Eigen::MatrixXd weights(const FrameSource& performance, const Context& context = {}) const;

  /// A^T A of eq. 11 over L (D x D).
  const Eigen::MatrixXd& gram() const;
  /// A^T b of eq. 11 for one frame of the source (D).
  Eigen::VectorXd right_hand_side(const Eigen::Ref<const Positions>& frame) const;
  const BlendshapeConditions& conditions() const;

  /// True where many weights sit at 0 with a multiplier that wants them negative: the source's rest
  /// pose is likely not neutral. `weights` as returned for `performance`. Expressions whose rule
  /// has beta not begin at 0 do not count.
  bool rest_looks_unneutral(const FrameSource& performance, const Eigen::MatrixXd& weights,
                            const Context& context = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
