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
  /// Weight of |beta|^2, as a share of the mean diagonal of the Gram matrix over the columns that L
  /// sees.
  double ridge = 0;
  /// Weight of 2 |beta|_1, as a share of the same mean.
  double sparsity = 0;
  /// Time constant in seconds of a penalty on squared second differences of beta over time. Its
  /// weight is (smoothness * frame rate)^4 times the same mean.
  double smoothness = 0;
  /// Weight of (beta_left - beta_right)^2 for each pair of expressions, as a share of the same
  /// mean. Pairs are ignored unless L sees both expressions.
  double symmetry = 0;
  /// Groups of expressions, found by their names. At most one of a group is active in a frame.
  Exclusive exclusive = Exclusive::none;
  /// Further rules for the target's expressions.
  WeightRules rules = {};
  /// Pairing of source and target if their faces differ, or null. Triangles without a partner
  /// contribute nothing, also if they are in L.
  std::shared_ptr<const Pairing> pairing = {};
  /// Factor of the square of each triangle (M), >= 0. Empty for 1.
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

/// Visibility of the target's expressions in the chosen triangles.
struct BlendshapeConditions {
  /// Columns without motion in L. Their weight is 0 in every frame, or the value that their rule
  /// prescribes.
  std::vector<std::string> unseen;
  /// Columns with G_L,jj < 0.05 G_jj. In G, each triangle has the largest weight that occurs in L.
  std::vector<std::string> weakly_seen;
  /// Condition number of G_L over the columns that L sees.
  double condition = 1;
  int degenerate_source_triangles = 0;
  int degenerate_target_triangles = 0;
};

/// Blendshape weights of a target that follow a source's deformation gradients on triangles L.
///
/// Minimises sum_{i in L} ||Q_i V_i - V~_i(beta)||^2 over 0 <= beta <= 1 (eq. 10, 11), summed over
/// edges (EdgeSum). Rules of the expressions (WeightRules) change the bounds, draw pairs together,
/// and exclude expressions from occurring together. RuledLeastSquares solves the problem with rules
/// exactly.
///
/// The constructor forms the Gram matrix. A frame costs one pass over the triangles of L, one
/// product with the displacement fields, and a solve of D unknowns. All terms are differences from
/// the rest pose, so that the rest pose gives exactly 0. Queries are const.
class BlendshapeTransfer {
 public:
  /// `source_rest` (N x 3) has the connectivity of the target, or of the pairing's source.
  /// `triangles` are rows of target.triangles().
  ///
  /// Throws MismatchError if the vertex counts differ, or if no expression of the target moves in
  /// `triangles`. Throws MismatchError if the rules do not fit the target (ExpressionRules), or if
  /// sparsity meets a rule that allows negative weights. Throws std::invalid_argument if a
  /// triangle, an option or a triangle weight is out of range. Throws Cancelled.
  BlendshapeTransfer(const Positions& source_rest, const BlendshapeModel& target,
                     std::vector<int> triangles, const BlendshapeTransferOptions& options = {},
                     const Context& context = {});
  ~BlendshapeTransfer();
  BlendshapeTransfer(BlendshapeTransfer&&) noexcept;
  BlendshapeTransfer& operator=(BlendshapeTransfer&&) noexcept;

  /// beta for every frame (F x D), each within [0, 1]. With rules, the weights in the form that is
  /// written. Throws MismatchError if the vertex counts differ, what reading throws, and Cancelled.
  Eigen::MatrixXd weights(const FrameSource& performance, const Context& context = {}) const;

  /// A^T A of eq. 11 over L (D x D).
  const Eigen::MatrixXd& gram() const;
  /// A^T b of eq. 11 for one frame of the source (D). Throws MismatchError if the vertex counts
  /// differ.
  Eigen::VectorXd right_hand_side(const Eigen::Ref<const Positions>& frame) const;
  const BlendshapeConditions& conditions() const;

  /// Returns true if many weights are 0 although their optimum is negative. The source's rest pose
  /// is then probably not neutral. `weights` are those that weights() returned for `performance`.
  /// Expressions whose lower bound is not 0 do not count. Throws as weights() does.
  bool rest_looks_unneutral(const FrameSource& performance, const Eigen::MatrixXd& weights,
                            const Context& context = {}) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace mimetra
