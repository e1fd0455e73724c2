#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/pipeline/solve.h"
#include "toolkit/transfer/example_rig.h"

namespace mimetra {

struct RigOptions {
  Axes axes = Axes::fit;
  TriangleWeight triangle_weight = TriangleWeight::unit;
  ExampleRigOptions examples = {};

  static constexpr Option kAxes{"axes", &RigOptions::axes};
  static constexpr Option kTriangleWeight{"triangle_weight", &RigOptions::triangle_weight};
  static constexpr auto declared() { return std::tuple(kAxes, kTriangleWeight); }
};

/// Origin of an expression of a rig.
enum class RigOrigin {
  transferred,  ///< from the source, unchanged
  corrected,    ///< from the source, changed by examples
  example,      ///< an example that is its true shape
  own           ///< the target's own, which the source does not have
};

constexpr std::string_view choice_name(RigOrigin value) {
  switch (value) {
    case RigOrigin::transferred:
      return "transferred";
    case RigOrigin::corrected:
      return "corrected";
    case RigOrigin::example:
      return "example";
    case RigOrigin::own:
      return "own";
  }
  return {};
}

struct RiggedExpression {
  std::string name;
  RigOrigin origin = RigOrigin::transferred;
  double largest = 0;  ///< largest displacement of a vertex; length
  double change = 0;   ///< largest change of a vertex by examples; length
  /// Triangles that turn by more than 90 degrees from the orientation that the source's gradient
  /// gives.
  int flipped = 0;
};

/// A target with the expressions of a source.
struct Rig {
  BlendshapeModel model;  ///< the source's expressions in their order, then the target's others
  std::vector<RiggedExpression> expressions;  ///< in the order of the model
  std::vector<std::string> examples;  ///< names of the given examples, then of the target's own
  /// Weights of the examples (S x the source's expressions).
  Eigen::MatrixXd weights;
  Similarity similarity;                        ///< from the source's neutral to the target's
  std::optional<MatchReport> match = {};        ///< if the faces differ
  std::shared_ptr<const Pairing> pairing = {};  ///< null if the faces are the same
  double missed = 0;  ///< share of the source's deformation that the transferred expressions lack
};

/// Returns the source's expressions at weight 1, one per frame. Throws MismatchError if there are
/// none.
std::shared_ptr<const Animation> frame_of_each_expression(const BlendshapeModel& source);

/// Transfers the full set of a source's expressions to a target: a neutral mesh, or a model with
/// some expressions. These then count as true shapes.
///
/// Each expression is transferred in vertex space from the triangles that it moves on the source.
/// The rest of the target is fixed. fit_to_examples() corrects the expressions. The `meaning` of an
/// example refers to the source's expressions. Notes examples and expressions that do not move, and
/// a rig that is probably unusable.
///
/// Throws what frame_of_each_expression(), MatchedTarget(), placed_at(), check_sizes(),
/// closed_seams(), VertexTransfer and fit_to_examples() throw; Cancelled.
Rig rig(const BlendshapeModel& source, const Target& target, std::vector<RigExample> examples = {},
        const RigOptions& options = {}, const Context& context = {});

/// Throws MismatchError for an example in another unit than the target's neutral (N x 3). `name` is
/// the target's, for the message.
void check_sizes(const std::vector<RigExample>& examples, const Positions& neutral,
                 const std::string& name);

/// Peak memory of rig() in bytes.
double rig_bytes(const BlendshapeModel& source, const BlendshapeModel& target);

}  // namespace mimetra
