#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/model/octahedron.h"
#include "toolkit/model/blendshape_model.h"

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

TEST(MorphableModel, AddsIdentityAndExpression) {
  // M(alpha, beta) = mean + alpha V + beta B, eq. 3.
  const Eigen::VectorXd alpha = Eigen::VectorXd::Constant(1, 2);
  const Eigen::VectorXd beta = Eigen::VectorXd::Constant(1, 1);
  const BlendshapeModel person = face().person(alpha);
  EXPECT_EQ(person.neutral(), Positions(mean().array() + 2 * 3));
  EXPECT_EQ(person.pose(beta), Positions(mean().array() + 2 * 3 + 5));
  EXPECT_EQ(face().person().neutral(), mean());
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

TEST(MorphableModel, RefusesPartsThatDoNotFit) {
  const auto refuse = [](const auto& connectivity, const Positions& middle,
                         const ShapeBasis& identities, const ShapeBasis& expressions,
                         const char* message) {
    EXPECT_THAT([&] { MorphableModel(connectivity, middle, identities, expressions); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  };
  const auto faces = octahedron_connectivity();
  refuse(decltype(octahedron_connectivity())(), mean(), {}, {}, "needs a connectivity");
  refuse(faces, Positions::Zero(7, 3), {}, {}, "the neutral has 7 vertices, expected 6");
  refuse(faces, mean(), {{"0"}, Eigen::MatrixXd::Zero(3, 1)}, {}, "3 rows, expected 3 x 6");
  refuse(faces, mean(), {}, {{"a", "a"}, Eigen::MatrixXd::Zero(18, 2)}, "'a' occurs twice");
}

}  // namespace
}  // namespace mimetra
