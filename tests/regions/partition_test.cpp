#include "toolkit/regions/falloff.h"

#include <limits>
#include <numeric>

#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

using Lists = std::vector<std::vector<VertexIndex>>;

/// Straight distances, as on a flat grid.
NearestDistance straight(const Positions& positions) {
  return [positions](std::span<const VertexIndex> sources) {
    Eigen::VectorXd nearest =
        Eigen::VectorXd::Constant(positions.rows(), std::numeric_limits<double>::infinity());
    for (const VertexIndex source : sources) {
      nearest = nearest.cwiseMin((positions.rowwise() - positions.row(source)).rowwise().norm());
    }
    return nearest;
  };
}

class Partition : public testing::Test {
 protected:
  static constexpr int kSide = 31;

  /// Vertices within `radius` of a place.
  std::vector<VertexIndex> disc(double x, double y, double radius) const {
    std::vector<VertexIndex> held;
    for (VertexIndex v = 0; v < shape_.positions.rows(); ++v) {
      const Eigen::RowVector2d from = shape_.positions.row(v).head<2>() - Eigen::RowVector2d(x, y);
      if (from.norm() <= radius) held.push_back(v);
    }
    return held;
  }

  Eigen::MatrixXd shares(const Lists& regions, double falloff) const {
    return partition_of_unity(shape_.triangles, weld_, regions, falloff,
                              straight(shape_.positions));
  }
  static VertexIndex at(int x, int y) { return y * kSide + x; }

  const test::Shape shape_ = test::grid(kSide, kSide);
  const Weld weld_ = Weld::none(kSide * kSide);
  const Lists regions_ = {disc(8, 8, 4), disc(12, 8, 3), disc(22, 20, 5)};
};

TEST_F(Partition, AddsUpToOneAndIsNowhereNegative) {
  for (const double falloff : {0.5, 3.0, 12.0, 100.0}) {
    const Eigen::MatrixXd shares = this->shares(regions_, falloff);
    ASSERT_EQ(shares.cols(), 4);
    EXPECT_GE(shares.minCoeff(), 0);
    // A handful of operations of numbers up to 1.
    EXPECT_LT((shares.rowwise().sum().array() - 1).abs().maxCoeff(), 8e-16) << falloff;
  }
}

TEST_F(Partition, IsARegionsInsideItAndTheBackgroundsBeyondTheFalloff) {
  const Eigen::MatrixXd shares = this->shares(regions_, 3);
  EXPECT_EQ(shares(at(22, 20), 2), 1);
  EXPECT_EQ(shares(at(22, 25), 2), 1);
  EXPECT_EQ(shares(at(22, 28), 3), 1);
  EXPECT_EQ(shares(at(2, 28), 3), 1);
  EXPECT_EQ(shares(at(22, 28), 2), 0);
  // What two regions hold is both's in equal parts.
  EXPECT_EQ(shares(at(10, 8), 0), 0.5);
  EXPECT_EQ(shares(at(10, 8), 1), 0.5);
}

TEST_F(Partition, FallsAsTheCubicItIsSaidToBe) {
  const Eigen::MatrixXd shares = this->shares({disc(22, 20, 0)}, 4);
  const auto bump = [](double t) { return (1 - t) * (1 - t) * (1 + 2 * t); };
  for (const int steps : {1, 2, 3}) {
    EXPECT_NEAR(shares(at(22 + steps, 20), 0), bump(steps / 4.0), 1e-15);
    EXPECT_NEAR(shares(at(22 + steps, 20), 1), 1 - bump(steps / 4.0), 1e-15);
  }
}

TEST_F(Partition, IsSmooth) {
  // Two strips that fade into each other and the background, and the same twice as wide: second
  // differences of a smooth column become a quarter; half where there is a corner, and no less
  // where there is a jump.
  const auto roughness = [&](int falloff, int gap) {
    std::vector<VertexIndex> left, right;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        if (x <= 4) left.push_back(at(x, y));
        if (x >= 4 + gap) right.push_back(at(x, y));
      }
    }
    const Eigen::MatrixXd shares = this->shares({left, right}, falloff);
    double most = 0;
    for (int x = 1; x + 1 < kSide; ++x) {
      const Eigen::RowVectorXd bend =
          shares.row(at(x + 1, 12)) - 2 * shares.row(at(x, 12)) + shares.row(at(x - 1, 12));
      most = std::max(most, bend.cwiseAbs().maxCoeff());
    }
    return most;
  };
  EXPECT_LT(roughness(12, 14), 0.35 * roughness(6, 7));
}

TEST_F(Partition, OfNoRegionIsTheBackground) {
  EXPECT_TRUE(shares({}, 1) == Eigen::MatrixXd::Ones(kSide * kSide, 1));
  EXPECT_TRUE(shares({{}}, 1).col(1) == Eigen::VectorXd::Ones(kSide * kSide));
}

TEST_F(Partition, LeavesNoBackgroundWhereARegionIsEverywhere) {
  std::vector<VertexIndex> all(kSide * kSide);
  std::iota(all.begin(), all.end(), 0);
  const Eigen::MatrixXd shares = this->shares({all}, 1);
  EXPECT_TRUE(shares.col(0) == Eigen::VectorXd::Ones(kSide * kSide));
  EXPECT_TRUE(shares.col(1).isZero(0));
}

TEST_F(Partition, PassesAcrossAWeldedSeam) {
  // Two halves of a strip whose rims coincide; the region holds one copy of the seam's vertices.
  test::Shape left = test::grid(4, 3), right = test::grid(4, 3);
  right.positions.col(0).array() += 3;
  Positions positions(24, 3);
  positions << left.positions, right.positions;
  Triangles triangles(24, 3);
  triangles << left.triangles, (right.triangles.array() + 12).matrix();
  const Weld weld = Weld::exact(positions);
  const Eigen::MatrixXd shares =
      partition_of_unity(triangles, weld, {{3, 7, 11}}, 2, straight(positions));
  for (int row = 0; row < 3; ++row) {
    EXPECT_EQ(shares(4 * row + 3, 0), 1);
    EXPECT_EQ(shares(12 + 4 * row, 0), 1);
    EXPECT_NEAR(shares(12 + 4 * row + 1, 0), 0.5, 1e-12);
    EXPECT_NEAR(shares(4 * row + 2, 0), 0.5, 1e-12);
  }
}

TEST_F(Partition, TakesDistancesFromTheNearestOfSeveralVertices) {
  const SurfaceDistances distances(shape_.positions, shape_.triangles, weld_);
  const VertexIndex one = at(5, 5), other = at(25, 25);
  EXPECT_TRUE(distances.from_nearest(std::span(&one, 1)) == distances(one));
  const std::vector<VertexIndex> both = {one, other};
  const Eigen::VectorXd nearest = distances.from_nearest(both);
  // Far from where both are as near, as the heat method sees it: to 3 % of the distance.
  for (const VertexIndex v : {at(8, 5), at(5, 9), at(22, 25), at(25, 20)}) {
    const double expected = std::min(distances(one)[v], distances(other)[v]);
    EXPECT_NEAR(nearest[v], expected, 0.03 * expected);
  }
}

TEST_F(Partition, TakesExactDistancesFromVerticesOfOneTriangle) {
  const SurfaceDistances distances(shape_.positions, shape_.triangles, weld_,
                                   GeodesicMethod::exact);
  const std::vector<VertexIndex> neighbors = {at(5, 5), at(6, 5), at(6, 6)};
  const Eigen::VectorXd nearest = distances.from_nearest(neighbors);
  // The grid is flat: straight distances up to the rounding of what CGAL unfolds.
  EXPECT_LT((nearest - straight(shape_.positions)(neighbors)).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_THAT([&] { distances.from_nearest({}); }, testing::Throws<std::invalid_argument>());
}

TEST_F(Partition, RefusesWhatIsNoPartition) {
  EXPECT_THAT([this] { shares(regions_, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("falloff is 0")));
  EXPECT_THAT(
      [this] {
        shares({{3}, {kSide * kSide}}, 1);
      },
      ThrowsMessage<MismatchError>(HasSubstr("region 1 holds vertex 961")));
}

}  // namespace
}  // namespace mimetra
