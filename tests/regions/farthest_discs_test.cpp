#include "toolkit/regions/discs.h"

#include <gmock/gmock.h>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// A flat sheet of unit squares, on which straight distances run along the surface.
class FarthestDiscsTest : public testing::Test {
 protected:
  std::vector<Disc> spread(const FarthestDiscsOptions& options) const {
    const auto straight = one_by_one([this](VertexIndex source) {
      return Eigen::VectorXd(
          (shape_.positions.rowwise() - shape_.positions.row(source)).rowwise().norm());
    });
    return farthest_discs(shape_.positions, shape_.triangles, straight, options);
  }

  double distance(VertexIndex a, VertexIndex b) const {
    return (shape_.positions.row(a) - shape_.positions.row(b)).norm();
  }

  const test::Shape shape_ = test::grid(9, 7);
};

TEST_F(FarthestDiscsTest, EachCenterIsTheVertexFarthestFromThoseBefore) {
  const std::vector<Disc> discs = spread({.count = 12});
  ASSERT_EQ(discs.size(), 12U);
  for (std::size_t d = 1; d < discs.size(); ++d) {
    const auto nearest = [&](VertexIndex v) {
      double least = distance(v, discs[0].center);
      for (std::size_t e = 1; e < d; ++e) least = std::min(least, distance(v, discs[e].center));
      return least;
    };
    double most = 0;
    for (VertexIndex v = 0; v < shape_.positions.rows(); ++v) most = std::max(most, nearest(v));
    // Squares of distances tie up to rounding.
    EXPECT_NEAR(nearest(discs[d].center), most, 1e-8);
  }
}

TEST_F(FarthestDiscsTest, HoldWhatIsWithinTheRadius) {
  for (const Disc& disc : spread({.radius = 1.5, .count = 5})) {
    std::vector<VertexIndex> near;
    for (VertexIndex v = 0; v < shape_.positions.rows(); ++v) {
      if (distance(v, disc.center) <= 1.5) near.push_back(v);
    }
    EXPECT_EQ(disc.vertices, near);
    std::vector<int> touching;
    for (int t = 0; t < shape_.triangles.rows(); ++t) {
      const auto corners = shape_.triangles.row(t);
      if (std::ranges::any_of(
              corners, [&](VertexIndex v) { return std::ranges::find(near, v) != near.end(); })) {
        touching.push_back(t);
      }
    }
    EXPECT_EQ(disc.triangles, touching);
  }
}

TEST_F(FarthestDiscsTest, LieInside) {
  std::vector<bool> inside(shape_.positions.rows(), false);
  for (VertexIndex v = 0; v < shape_.positions.rows(); ++v) inside[v] = shape_.positions(v, 0) < 4;
  for (const Disc& disc : spread({.radius = 2, .count = 10, .inside = inside})) {
    for (const VertexIndex v : disc.vertices) EXPECT_TRUE(inside[v]);
    EXPECT_TRUE(inside[disc.center]);
  }
}

TEST_F(FarthestDiscsTest, AreNoMoreThanVertices) {
  EXPECT_EQ(spread({.count = 1000}).size(), static_cast<std::size_t>(shape_.positions.rows()));
}

TEST_F(FarthestDiscsTest, RefuseOptionsOutOfRange) {
  EXPECT_THAT([&] { spread({.radius = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("it must be above 0")));
  EXPECT_THAT([&] { spread({.count = 0}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("at least 1 disc")));
  EXPECT_THAT([&] { spread({.inside = {true}}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("1 vertices, expected 63")));
}

}  // namespace
}  // namespace mimetra
