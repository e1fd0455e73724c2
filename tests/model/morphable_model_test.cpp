#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/octahedron.h"
#include "toolkit/model/morphable_model.h"

namespace mimetra {
namespace {

using test::octahedron_connectivity;
using testing::HasSubstr;
using testing::ThrowsMessage;

Positions mean() {
  return test::octahedron().positions;
}

/// Displacement fields that are `value` everywhere: whole numbers, so that sums are exact.
ShapeBasis constant_shape(const std::string& name, double value) {
  return {{name}, Eigen::MatrixXd::Constant(18, 1, value)};
}

MorphableModel face() {
  return {octahedron_connectivity(), mean(), constant_shape("0", 3), constant_shape("smile", 5)};
}

TEST(MorphableModel, OfNoCoefficientsIsTheMeanPerson) {
  EXPECT_EQ(face().person().neutral(), mean());
}

TEST(MorphableModel, MovesThePersonAlongIdentities) {
  const BlendshapeModel person = face().person(Eigen::VectorXd::Constant(1, -2));
  EXPECT_EQ(person.neutral(), Positions(mean().array() - 6));
}

TEST(MorphableModel, AddsIdentityAndExpression) {
  // M(alpha, beta) = mean + alpha V + beta B, eq. 3.
  const Eigen::VectorXd alpha = Eigen::VectorXd::Constant(1, 2);
  const Eigen::VectorXd beta = Eigen::VectorXd::Constant(1, 1);
  EXPECT_EQ(face().person(alpha).pose(beta), Positions(mean().array() + 2 * 3 + 5));
}

TEST(MorphableModel, GivesEveryPersonTheSameExpressions) {
  const BlendshapeModel person = face().person(Eigen::VectorXd::Ones(1));
  EXPECT_EQ(person.expressions().names, face().expressions().names);
  EXPECT_EQ(person.expressions().displacements, face().expressions().displacements);
}

TEST(MorphableModel, MayHaveEmptyBases) {
  const MorphableModel bare(octahedron_connectivity(), mean(), {}, {});
  EXPECT_EQ(bare.identities().displacements.rows(), 18);
  EXPECT_EQ(bare.expressions().displacements.rows(), 18);
  EXPECT_EQ(bare.person().neutral(), mean());
}

TEST(MorphableModel, RefusesAnotherNumberOfCoefficients) {
  EXPECT_THAT([] { face().person(Eigen::Vector2d::Zero()); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("2 identity coefficients for a model of 1 identities")));
}

TEST(MorphableModel, RefusesAMeanOfAnotherVertexCount) {
  EXPECT_THAT(
      [] { MorphableModel(octahedron_connectivity(), Positions::Zero(7, 3), {}, {}); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("the neutral has 7 vertices, expected 6")));
}

TEST(MorphableModel, RefusesABasisOfAnotherVertexCount) {
  EXPECT_THAT(
      [] {
        MorphableModel(octahedron_connectivity(), mean(), {{"0"}, Eigen::MatrixXd::Zero(3, 1)}, {});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("3 rows, expected 3 x 6")));
}

TEST(MorphableModel, RefusesANameThatOccursTwice) {
  EXPECT_THAT(
      [] {
        MorphableModel(octahedron_connectivity(), mean(), {},
                       {{"a", "a"}, Eigen::MatrixXd::Zero(18, 2)});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("'a' occurs twice")));
}

TEST(MorphableModel, NeedsAConnectivity) {
  EXPECT_THAT([] { MorphableModel(nullptr, mean(), {}, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("needs a connectivity")));
}

}  // namespace
}  // namespace mimetra
