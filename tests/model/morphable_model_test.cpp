#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mimetra/model/morphable_model.h>

#include "shapes.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::shared_ptr<const Connectivity> octahedron() {
  return std::make_shared<Connectivity>(test::mesh_of(test::octahedron()).connectivity);
}

Positions mean() {
  return test::octahedron().positions;
}

/// Displacement fields that are `value` everywhere: whole numbers, so that sums are exact.
ShapeBasis constant_shape(const std::string& name, double value) {
  return {{name}, Eigen::MatrixXd::Constant(18, 1, value)};
}

MorphableModel model() {
  return {octahedron(), mean(), constant_shape("0", 3), constant_shape("smile", 5)};
}

TEST(MorphableModel, OfNoCoefficientsIsTheMeanPerson) {
  EXPECT_EQ(model().person().neutral(), mean());
}

TEST(MorphableModel, MovesThePersonAlongIdentities) {
  const BlendshapeModel person = model().person(Eigen::VectorXd::Constant(1, -2));
  EXPECT_EQ(person.neutral(), Positions(mean().array() - 6));
}

TEST(MorphableModel, AddsIdentityAndExpression) {
  // M(alpha, beta) = mean + alpha V + beta B, eq. 3.
  const Eigen::VectorXd alpha = Eigen::VectorXd::Constant(1, 2);
  const Eigen::VectorXd beta = Eigen::VectorXd::Constant(1, 1);
  EXPECT_EQ(model().person(alpha).pose(beta), Positions(mean().array() + 2 * 3 + 5));
}

TEST(MorphableModel, GivesEveryPersonTheSameExpressions) {
  const BlendshapeModel person = model().person(Eigen::VectorXd::Ones(1));
  EXPECT_EQ(person.expressions().names, model().expressions().names);
  EXPECT_EQ(person.expressions().displacements, model().expressions().displacements);
}

TEST(MorphableModel, MayHaveEmptyBases) {
  const MorphableModel bare(octahedron(), mean(), {}, {});
  EXPECT_EQ(bare.identities().displacements.rows(), 18);
  EXPECT_EQ(bare.expressions().displacements.rows(), 18);
  EXPECT_EQ(bare.person().neutral(), mean());
}

TEST(MorphableModel, RefusesAnotherNumberOfCoefficients) {
  EXPECT_THAT([] { model().person(Eigen::Vector2d::Zero()); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("2 identity coefficients for a model of 1 identities")));
}

TEST(MorphableModel, RefusesAMeanOfAnotherVertexCount) {
  EXPECT_THAT(
      [] { MorphableModel(octahedron(), Positions::Zero(7, 3), {}, {}); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("the mean has 7 vertices, expected 6")));
}

TEST(MorphableModel, RefusesABasisOfAnotherVertexCount) {
  EXPECT_THAT(
      [] {
        MorphableModel(octahedron(), mean(), {{"0"}, Eigen::MatrixXd::Zero(3, 1)}, {});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("3 rows, expected 3 x 6")));
}

TEST(MorphableModel, RefusesANameThatOccursTwice) {
  EXPECT_THAT(
      [] {
        MorphableModel(octahedron(), mean(), {}, {{"a", "a"}, Eigen::MatrixXd::Zero(18, 2)});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("'a' occurs twice")));
}

TEST(MorphableModel, NeedsAConnectivity) {
  EXPECT_THAT([] { MorphableModel(nullptr, mean(), {}, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("needs a connectivity")));
}

}  // namespace
}  // namespace mimetra
