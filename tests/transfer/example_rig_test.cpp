#include "toolkit/transfer/example_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>

#include "tests/transfer/faces.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int kExpressions = 4;

class ExampleRigTest : public testing::Test {
 protected:
  const BlendshapeModel model_ = test::model_on(test::bent_patch(), kExpressions);
  const Weld apart_ = Weld::none(model_.vertices());

  /// The patch as another shape moves it: `amount` times smooth bumps that no expression is.
  Positions odd_pose(double amount, unsigned seed = 7) const {
    const ShapeBasis odd = test::bumps(model_.neutral(), 6, seed);
    const Eigen::VectorXd field = amount * odd.displacements.rowwise().sum();
    return model_.neutral() + Eigen::Map<const Positions>(field.data(), model_.vertices(), 3);
  }

  Eigen::VectorXd field_of(const Positions& pose) const {
    const Positions difference = pose - model_.neutral();
    return Eigen::Map<const Eigen::VectorXd>(difference.data(), difference.size());
  }
};

/// Gradient of a displacement field in the plane of a triangle, 3 x 3: E g for each vector of the
/// plane, 0 along the normal.
Eigen::Matrix3d literal_gradient(const BlendshapeModel& model, int t,
                                 const Eigen::VectorXd& field) {
  const auto corners = model.triangles().row(t);
  Eigen::Matrix<double, 3, 2> edges, moved;
  for (int e = 0; e < 2; ++e) {
    edges.col(e) =
        (model.neutral().row(corners[e + 1]) - model.neutral().row(corners[0])).transpose();
    moved.col(e) = field.segment<3>(3 * corners[e + 1]) - field.segment<3>(3 * corners[0]);
  }
  return moved * edges.completeOrthogonalDecomposition().pseudoInverse();
}

/// The paper's least squares in all expressions at once: rows of unknowns are expressions.
/// `before` (D x q), `poses` (S x q) are what expressions and examples do.
Eigen::MatrixXd literal_step(const Eigen::MatrixXd& before, const Eigen::MatrixXd& poses,
                             const Eigen::MatrixXd& weights, const ExampleRigOptions& options) {
  const Eigen::ArrayXd norms = before.rowwise().norm();
  const Eigen::ArrayXd pull = ((1 + norms) / (options.kappa + norms)).pow(options.theta);
  const Eigen::MatrixXd covariance = Eigen::MatrixXd(pull.inverse().matrix().asDiagonal()) +
                                     options.share * before * before.transpose();
  const Eigen::MatrixXd precision = options.prior * covariance.inverse();
  return (weights.transpose() * weights + precision)
      .fullPivLu()
      .solve(weights.transpose() * poses + precision * before);
}

/// The same for a whole mesh without fixed vertices: gradients, then vertices by dense least
/// squares, each expression's mean displacement by the same step.
Eigen::MatrixXd literal_rig(const BlendshapeModel& model, const Eigen::MatrixXd& poses,
                            const Eigen::MatrixXd& weights, const ExampleRigOptions& options) {
  const Eigen::MatrixXd& prior = model.expressions().displacements;
  const int vertices = model.vertices(), triangles = static_cast<int>(model.triangles().rows());
  const auto count = prior.cols();
  // Least squares of the gradients minus those that are wanted, and of the mean.
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(9 * triangles + 3, 3 * vertices);
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(rows.rows(), count);
  for (int t = 0; t < triangles; ++t) {
    for (const VertexIndex v : model.triangles().row(t)) {
      for (int c = 0; c < 3; ++c) {
        rows.block<9, 1>(9 * t, 3 * v + c) =
            literal_gradient(model, t, Eigen::VectorXd::Unit(3 * vertices, 3 * v + c)).reshaped();
      }
    }
    const auto gradients_of = [&](const Eigen::MatrixXd& fields) {
      Eigen::MatrixXd result(fields.cols(), 9);
      for (int j = 0; j < fields.cols(); ++j) {
        result.row(j) = literal_gradient(model, t, fields.col(j)).reshaped().transpose();
      }
      return result;
    };
    wanted.middleRows<9>(9 * t) =
        literal_step(gradients_of(prior), gradients_of(poses), weights, options).transpose();
  }
  const double size = box_diagonal(model.neutral());
  const auto means_of = [&](const Eigen::MatrixXd& fields) {
    Eigen::MatrixXd result(fields.cols(), 3);
    for (int j = 0; j < fields.cols(); ++j) {
      const Eigen::VectorXd field = fields.col(j);
      result.row(j) = Eigen::Map<const Positions>(field.data(), vertices, 3).colwise().mean();
    }
    return Eigen::MatrixXd(result / size);
  };
  for (int v = 0; v < vertices; ++v) {
    rows.block<3, 3>(9 * triangles, 3 * v) = Eigen::Matrix3d::Identity() / vertices;
  }
  wanted.bottomRows<3>() =
      size * literal_step(means_of(prior), means_of(poses), weights, options).transpose();
  return rows.colPivHouseholderQr().solve(wanted);
}

TEST_F(ExampleRigTest, AgreesWithALiteralTranscriptionOfThePaper) {
  // Every vertex moves in every expression, so that nothing is fixed.
  ShapeBasis basis = model_.expressions();
  const Eigen::VectorXd drift = field_of(odd_pose(0.01)).array() + 0.01;
  basis.displacements.colwise() += drift;
  const BlendshapeModel model(model_.shared_connectivity(), model_.neutral(), basis);
  const Eigen::MatrixXd weights = test::random_weights(3, kExpressions, 5);
  std::vector<RigExample> examples;
  Eigen::MatrixXd poses(model.neutral().size(), 3);
  for (int s = 0; s < 3; ++s) {
    examples.push_back({"pose", odd_pose(0.4, 11 + s), Eigen::VectorXd(weights.row(s))});
    poses.col(s) = field_of(examples.back().pose);
  }
  for (const double share : {0.0, 1.0}) {
    const ExampleRigOptions options{.prior = 0.3, .share = share};
    const Eigen::MatrixXd found = fit_to_examples(model, examples, apart_, options).displacements;
    const Eigen::MatrixXd expected = literal_rig(model, poses, weights, options);
    // Both are exact but for rounding, in systems of condition up to 1e5.
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST_F(ExampleRigTest, ReturnsTrueShapesAsTheyAreGiven) {
  const std::vector<RigExample> examples = {{"one", odd_pose(0.5), 1}, {"three", odd_pose(0.3), 3}};
  const ExampleRig rig = fit_to_examples(model_, examples, apart_);
  EXPECT_EQ(rig.displacements.col(1), field_of(examples[0].pose));
  EXPECT_EQ(rig.displacements.col(3), field_of(examples[1].pose));
  EXPECT_EQ(rig.weights.row(0), Eigen::RowVector4d(0, 1, 0, 0));
}

TEST_F(ExampleRigTest, ChangesNothingWhereExamplesAreTheTransferredExpressions) {
  // The pose rounds, and what the sum of the neutral and a displacement lost is what is left.
  const Positions pose = model_.pose(Eigen::Vector4d(0, 0, 1, 0));
  const ExampleRig rig = fit_to_examples(model_, {{"two", pose, 2}}, apart_);
  EXPECT_LT((rig.displacements - model_.expressions().displacements).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(fit_to_examples(model_, {}, apart_).displacements, model_.expressions().displacements);
  EXPECT_EQ(fit_to_examples(model_, {{"still", model_.neutral(), Eigen::VectorXd::Zero(4)}}, apart_)
                .displacements,
            model_.expressions().displacements);
}

TEST_F(ExampleRigTest, LeavesOtherExpressionsAloneWithoutShare) {
  const ExampleRig rig = fit_to_examples(model_, {{"one", odd_pose(0.5), 1}}, apart_, {.share = 0});
  for (const int other : {0, 2, 3}) {
    EXPECT_EQ(rig.displacements.col(other), model_.expressions().displacements.col(other));
  }
}

TEST_F(ExampleRigTest, CarriesWhatAnExpressionDoesDifferentlyToOneThatMovesAlike) {
  // Expression 0 twice: what the target does with the one it does with the other. Without it, the
  // other is half as large as it should be; with a large share, nearly all of that is made up for.
  ShapeBasis basis = model_.expressions();
  basis.displacements.col(1) = basis.displacements.col(0);
  const BlendshapeModel model(model_.shared_connectivity(), model_.neutral(), basis);
  const Eigen::VectorXd truth = 2 * basis.displacements.col(0);
  const Positions pose = model.pose(Eigen::Vector4d(2, 0, 0, 0));
  const auto error_with = [&](double share) {
    const ExampleRig rig = fit_to_examples(model, {{"zero", pose, 0}}, apart_, {.share = share});
    return (rig.displacements.col(1) - truth).norm() / (basis.displacements.col(1) - truth).norm();
  };
  EXPECT_EQ(error_with(0), 1);
  EXPECT_LT(error_with(1), 0.9);
  EXPECT_LT(error_with(1000), 0.01);
}

TEST_F(ExampleRigTest, KeepsVerticesThatNothingMovesWhereTheyAre) {
  const Positions pose = model_.pose(Eigen::Vector4d(1.5, 0, 0, 0.5));
  const Eigen::VectorXd weights = Eigen::Vector4d(1, 0, 0, 0.5);
  const ExampleRig rig = fit_to_examples(model_, {{"pose", pose, weights}}, apart_);
  const Eigen::MatrixXd& before = model_.expressions().displacements;
  int still = 0;
  for (int v = 0; v < model_.vertices(); ++v) {
    const auto moves = [&](const auto& field) {
      return field.template segment<3>(3 * v).norm() > 0;
    };
    if (moves(before.col(0)) || moves(field_of(pose))) continue;
    EXPECT_EQ(rig.displacements.col(0).segment<3>(3 * v).norm(), 0);
    ++still;
  }
  EXPECT_GT(still, 0);
  EXPECT_GT((rig.displacements - before).norm(), 0);
}

TEST_F(ExampleRigTest, FindsTheWeightsOfPoses) {
  const Eigen::MatrixXd truth = test::random_weights(3, kExpressions, 9);
  std::vector<RigExample> examples;
  examples.reserve(3);
  for (int s = 0; s < 3; ++s) {
    examples.push_back({"pose", model_.pose(truth.row(s).transpose()), {}});
  }
  const ExampleRig rig = fit_to_examples(model_, examples, apart_);
  // A ridge of a thousandth pulls weights of bumps that hardly overlap to 0 by about as much.
  EXPECT_LT((rig.weights - truth).cwiseAbs().maxCoeff(), 5e-3);
  EXPECT_GE(rig.weights.minCoeff(), 0);
  EXPECT_LE(rig.weights.maxCoeff(), 1);
}

TEST_F(ExampleRigTest, ComesNearerToPosesWithALooserPrior) {
  const Eigen::VectorXd weights = Eigen::Vector4d(1, 0.5, 0, 1);
  const std::vector<RigExample> examples = {{"pose", odd_pose(0.4), weights}};
  double before = 1e300;
  for (const double prior : {1.0, 0.1, 0.001}) {
    const ExampleRig rig = fit_to_examples(model_, examples, apart_, {.prior = prior});
    const double left = (rig.displacements * weights - field_of(examples[0].pose)).norm();
    EXPECT_LT(left, before);
    before = left;
  }
}

TEST_F(ExampleRigTest, MovesPiecesThatNothingHoldsAsTheirExamplesDo) {
  // The whole patch goes up: no gradient tells it.
  ShapeBasis rising{{"up"}, Eigen::MatrixXd::Zero(model_.neutral().size(), 1)};
  for (int v = 0; v < model_.vertices(); ++v) rising.displacements(3 * v + 1, 0) = 1;
  const BlendshapeModel model(model_.shared_connectivity(), model_.neutral(), rising);
  const Positions pose = model.pose(Eigen::VectorXd::Constant(1, 2));
  const ExampleRig rig =
      fit_to_examples(model, {{"pose", pose, Eigen::VectorXd::Ones(1)}}, apart_, {.prior = 1e-6});
  EXPECT_LT((rig.displacements.col(0) - field_of(pose)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST_F(ExampleRigTest, MovesVerticesThatAreOneAsOne) {
  // A second patch at the place of the first one's, as the two sides of a seam.
  const int count = model_.vertices();
  Triangles triangles(2 * model_.triangles().rows(), 3);
  triangles << model_.triangles(), model_.triangles().array() + count;
  Positions twice(2 * count, 3);
  twice << model_.neutral(), model_.neutral();
  ShapeBasis basis = model_.expressions();
  basis.displacements = basis.displacements.replicate(2, 1).eval();
  const BlendshapeModel model(
      std::make_shared<Connectivity>(Connectivity::from_triangles(2 * count, triangles)), twice,
      basis);
  Positions pose(2 * count, 3);
  pose << odd_pose(0.4), odd_pose(0.2);
  const ExampleRig rig = fit_to_examples(
      model, {{"pose", pose, Eigen::VectorXd(Eigen::Vector4d(1, 1, 0, 0))}}, Weld::exact(twice));
  EXPECT_EQ(rig.displacements.topRows(3 * count), rig.displacements.bottomRows(3 * count));
}

TEST_F(ExampleRigTest, GivesEqualBytesForAnyNumberOfThreads) {
  const std::vector<RigExample> examples = {{"one", odd_pose(0.5), 1}, {"pose", odd_pose(0.2), {}}};
  const ExampleRig one = fit_to_examples(model_, examples, apart_, {}, Context().with_threads(1));
  const ExampleRig three = fit_to_examples(model_, examples, apart_, {}, Context().with_threads(3));
  EXPECT_EQ(one.displacements, three.displacements);
  EXPECT_EQ(one.weights, three.weights);
}

TEST_F(ExampleRigTest, RefusesWhatIsNoExample) {
  const auto fit = [this](std::vector<RigExample> examples, const ExampleRigOptions& options = {}) {
    return [this, examples = std::move(examples), options] {
      fit_to_examples(model_, examples, apart_, options);
    };
  };
  using Error = std::invalid_argument;
  const Positions pose = odd_pose(0.1);
  EXPECT_THAT(fit({{"small", Positions(pose.topRows(9)), 0}}),
              ThrowsMessage<Error>(HasSubstr("small: 9 vertices, expected 81")));
  EXPECT_THAT(fit({{"far", pose, 4}}), ThrowsMessage<Error>(HasSubstr("far: is expression 4")));
  EXPECT_THAT(fit({{"a", pose, 1}, {"b", pose, 1}}),
              ThrowsMessage<Error>(HasSubstr("b: a second shape of 'shape1'")));
  EXPECT_THAT(fit({{"much", pose, Eigen::VectorXd(Eigen::Vector4d(0, 2, 0, 0))}}),
              ThrowsMessage<Error>(HasSubstr("much: expected 4 weights within 0 to 1")));
  EXPECT_THAT(fit({}, {.prior = 0}), ThrowsMessage<Error>(HasSubstr("prior")));
}

}  // namespace
}  // namespace mimetra
