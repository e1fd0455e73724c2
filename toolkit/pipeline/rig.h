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

/// Where an expression of a rig comes from.
enum class RigOrigin {
  transferred,  ///< from the source, as it is
  corrected,    ///< from the source, changed by examples
  example,      ///< an example that is its true shape
  own           ///< the target's, which the source has not
};

/// As people read it.
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
  double largest = 0;  ///< displacement of a vertex; length
  double change = 0;   ///< the largest by which examples moved a vertex; length
  /// Triangles that turned by more than 90 degrees against where the source's gradient wants them.
  int flipped = 0;
};

/// A target with the expressions of a source.
struct Rig {
  BlendshapeModel model;  ///< the source's expressions in their order, then the target's others
  std::vector<RiggedExpression> expressions;  ///< of the model
  std::vector<std::string> examples;      ///< names of those that were given, then the target's own
  Eigen::MatrixXd weights;                ///< of the examples (S x the source's expressions)
  Similarity similarity;                  ///< from the source's neutral to the target's
  std::optional<MatchReport> match = {};  ///< where the faces differ
  std::shared_ptr<const Pairing> pairing = {};  ///< of these faces; null where they are the same
  double missed = 0;  ///< share of the source's deformation that the transferred expressions lack
};

/// The source's expressions at weight 1, a frame each. Throws MismatchError where it has none.
std::shared_ptr<const Animation> frame_of_each_expression(const BlendshapeModel& source);

/// The full set of a source's expressions on a target, a neutral mesh or a model that has only
/// some, which are then their true shapes.
///
/// Each expression is transferred in vertex space from the triangles that it moves on the source,
/// with all else of the target fixed. fit_to_examples() corrects them; the `meaning` of an example
/// is about the source's expressions. Notes examples that do not move, expressions that do not, and
/// a rig that is likely not usable.
///
/// Throws what frame_of_each_expression(), MatchedTarget(), placed_at(),
/// check_sizes(), closed_seams(), VertexTransfer and fit_to_examples() throw; Cancelled.
Rig rig(const BlendshapeModel& source, const Target& target, std::vector<RigExample> examples = {},
        const RigOptions& options = {}, const Context& context = {});

/// Throws MismatchError for an example in another unit than the neutral (N x 3) of the target of
/// this name.
void check_sizes(const std::vector<RigExample>& examples, const Positions& neutral,
                 const std::string& name);

/// Bytes that it takes at its peak.
double rig_bytes(const BlendshapeModel& source, const BlendshapeModel& target);

}  // namespace mimetra
