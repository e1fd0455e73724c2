#pragma once

#include <string>
#include <variant>
#include <vector>

#include "toolkit/mesh/context.h"
#include "toolkit/mesh/option.h"
#include "toolkit/mesh/weld.h"
#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// What is known of an example: it is the true shape of an expression (its index), a pose of these
/// weights (D), or a pose whose weights are looked for.
using ExampleMeaning = std::variant<std::monostate, int, Eigen::VectorXd>;

/// A pose of the target.
struct RigExample {
  std::string name;  ///< in errors
  Positions pose;    ///< N x 3, where the neutral is: without head motion
  ExampleMeaning meaning = {};
};

struct ExampleRigOptions {
  /// Pull towards the transferred expressions (the paper's beta), against poses; true shapes of
  /// expressions are taken as they are.
  double prior = 0.1;
  /// The pull on an expression whose gradient is m at a triangle is ((1 + m) / (kappa + m))^theta
  /// times that: what does not move there shall not begin to.
  double kappa = 0.1;
  double theta = 2;
  /// How much expressions that do the same to a triangle share of what examples tell; 0 is the
  /// paper's, whose true shapes of expressions tell nothing of others.
  double share = 1;
  /// Rounds of expressions from weights and weights from expressions, where weights are looked for.
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
  Eigen::MatrixXd weights;        ///< of the examples (S x D), each within [0, 1]
};

/// Corrects expressions that were transferred to a target by examples of it, in gradient space: for
/// each triangle, the least squares of what the examples' gradients differ from the expressions'
/// by, with a pull towards those that were transferred; vertices then follow the gradients.
/// `transferred` is the target with the expressions of the source; `weld` (N) says which of its
/// vertices move as one.
///
/// A vertex that neither the transferred expression nor an example that holds it moves stays
/// exactly. The true shape of an expression is returned as it is given; other expressions take over
/// from it what it does differently where they move alike (options.share), which the paper's do
/// not. Where no example differs from the transferred expressions, these are returned bit by bit.
///
/// Throws std::invalid_argument for options out of range, a pose of another size, weights that are
/// no D numbers within [0, 1], an index out of range, and two true shapes of one expression;
/// std::runtime_error where triangles do not determine the vertices; Cancelled.
///
/// [Li, Weise, Pauly. Example-Based Facial Rigging. ACM TOG 29(4), 2010]
ExampleRig fit_to_examples(const BlendshapeModel& transferred,
                           const std::vector<RigExample>& examples, const Weld& weld,
                           const ExampleRigOptions& options = {}, const Context& context = {});

}  // namespace mimetra
