#include "toolkit/model/animation.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

std::shared_ptr<const BlendshapeModel> waves(int side, int expressions) {
  const test::Shape shape = test::grid(side, side);
  const Eigen::Index rows = shape.positions.size();
  ShapeBasis basis{{}, Eigen::MatrixXd(rows, expressions)};
  for (int j = 0; j < expressions; ++j) {
    basis.names.push_back("wave" + std::to_string(j));
    for (Eigen::Index i = 0; i < rows; ++i) {
      basis.displacements(i, j) = std::sin(0.3 * static_cast<double>(i) + j);
    }
  }
  return std::make_shared<const BlendshapeModel>(
      std::make_shared<const Connectivity>(
          Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles)),
      shape.positions, basis);
}

Eigen::MatrixXd some_weights(int frames, int expressions) {
  Eigen::MatrixXd weights(frames, expressions);
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    weights.data()[i] = std::pow(std::sin(1.7 * static_cast<double>(i)), 2);
  }
  return weights;
}

// Sizes on both sides of those at which a product of matrices is cut.
TEST(Animation, EveryRunHasTheBytesOfTheWhole) {
  for (const auto& [side, expressions] : {std::pair{3, 1}, {4, 7}, {9, 53}, {13, 300}}) {
    const auto model = waves(side, expressions);
    for (const int frames : {1, 2, 3, 4, 5, 7, 8, 9, 30, 61}) {
      const Eigen::MatrixXd weights = some_weights(frames, expressions);
      const Frames whole = model->animate(weights).positions();
      const Animation animation(model, weights);
      for (int first = 0; first < frames; ++first) {
        for (const int count : {1, 2, 3, 4, 6, 11, 33}) {
          if (first + count > frames) break;
          ASSERT_EQ(animation.read(first, count), whole.middleRows(first, count))
              << side << ", " << expressions << ", " << frames << ": " << first << " + " << count;
        }
      }
    }
  }
}

TEST(Animation, RestsInTheNeutral) {
  const auto model = waves(3, 2);
  const Animation animation(model, some_weights(5, 2));
  EXPECT_TRUE(animation.rest_is_known());
  EXPECT_EQ(animation.rest(), model->neutral());
  EXPECT_EQ(animation.times(), default_times(5));
}

TEST(Animation, NeedsAWeightForEachExpressionAndATimeForEachFrame) {
  EXPECT_THAT([] { Animation(waves(3, 2), some_weights(5, 3)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("3 weights for a model of 2")));
  EXPECT_THAT([] { Animation(waves(3, 2), some_weights(5, 2), Eigen::VectorXd::Zero(4)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("4 times for 5 frames")));
}

TEST(Animation, KeepsItsExpressionsOnAMeshThatIsNumberedDifferently) {
  const auto model = waves(4, 3);
  const Eigen::MatrixXd weights = some_weights(5, 3);
  const Animation animation(model, weights, Eigen::VectorXd::LinSpaced(5, 1, 2));
  std::vector<VertexIndex> vertices(16);
  for (int v = 0; v < 16; ++v) vertices[v] = 15 - v;
  const auto connectivity =
      std::make_shared<const Connectivity>(Connectivity::from_triangles(16, Triangles(0, 3)));
  const Animation other = animation.renumbered(connectivity, vertices);
  EXPECT_EQ(other.weights(), weights);
  EXPECT_EQ(other.times(), animation.times());
  EXPECT_EQ(other.model().expressions().names, model->expressions().names);
  const Frames before = animation.read(0, 5), after = other.read(0, 5);
  for (int v = 0; v < 16; ++v) {
    EXPECT_EQ(after.middleCols(3 * v, 3), before.middleCols(3 * vertices[v], 3)) << v;
  }
  EXPECT_THROW(animation.renumbered(connectivity, {0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
