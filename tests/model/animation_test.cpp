#include "toolkit/model/animation.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace mimetra
