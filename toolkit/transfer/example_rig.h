#pragma once

#include <string>
#include <variant>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// Meaning of an example. An index: the pose is the true shape of this expression. A vector (D):
/// the pose has these weights. Otherwise the weights are unknown and are estimated.
using ExampleMeaning = std::variant<std::monostate, int, Eigen::VectorXd>;

/// A pose of the target.
struct RigExample {
  std::string name;  ///< name in error messages
  Positions pose;    ///< N x 3, without head motion, in the place of the neutral
  ExampleMeaning meaning = {};
};

struct ExampleRigOptions {
  /// Weight of the transferred expressions against poses (the paper's beta). True shapes are
  /// reproduced exactly, whatever the prior.
  double prior = 0.1;
  /// Parameters of the prior at a triangle. If an expression's gradient there has norm m, its
  /// weight is multiplied by ((1 + m) / (kappa + m))^theta. Triangles that an expression does not
  /// move should not begin to move.
  double kappa = 0.1;
  double theta = 2;
  /// Coupling of expressions that deform a triangle alike, so that they share what examples show.
  /// With 0, as in the paper, the true shape of an expression does not affect others.
  double share = 1;
  /// Most rounds that alternate between expressions and the unknown weights.
  int rounds = 10;

  static constexpr Option kPrior{"prior", &ExampleRigOptions::prior, {.minimum = 1e-6}};
  static constexpr Option kKappa{
      "kappa", &ExampleRigOptions::kappa, {.minimum = 1e-3, .maximum = 1}};
  static constexpr Option kTheta{"theta", &ExampleRigOptions::theta, {.minimum = 0, .maximum = 10}};
  static constexpr Option kShare{"share", &ExampleRigOptions::share, {.minimum = 0}};
  static constexpr Option kRounds{
      "rounds", &ExampleRigOptions::rounds, {.minimum = 1, .maximum = 1000}};
  static constexpr auto declared() { return std::tuple(kPrior, kKappa, kTheta, kShare, kRounds); }
};

/// Expressions that agree with examples.
struct ExampleRig {
  Eigen::MatrixXd displacements;  ///< 3N x D
  Eigen::MatrixXd weights;        ///< weights of the examples (S x D), each within [0, 1]
};

/// Corrects transferred expressions of a target by examples of it, in gradient space.
///
/// For each triangle, a least-squares fit distributes the difference between the examples'
/// gradients and the expressions'. A prior pulls towards the transferred expressions. The vertices
/// then follow the gradients. `transferred` is the target with the expressions of the source.
/// `weld` (N) lists the vertices that move as one.
///
/// A vertex stays exactly if neither the transferred expression nor an example that contains the
/// expression moves it. The true shape of an expression is returned unchanged. Unlike in the paper,
/// other expressions that move alike take over the difference it makes (options.share). If no
/// example differs from the transferred expressions, they are returned bit by bit.
///
/// Throws std::invalid_argument if an option or index is out of range, or if a pose has another
/// size. Throws std::invalid_argument if weights are not D numbers within [0, 1], or if an
/// expression has two true shapes. Throws std::runtime_error if triangles do not determine the
/// vertices. Throws Cancelled.
///
/// [Li, Weise, Pauly. Example-Based Facial Rigging. ACM TOG 29(4), 2010]
ExampleRig fit_to_examples(const BlendshapeModel& transferred,
                           const std::vector<RigExample>& examples, const Weld& weld,
                           const ExampleRigOptions& options = {}, const Context& context = {});

}  // namespace mimetra
