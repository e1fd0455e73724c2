#include "toolkit/regions/discs.h"

#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"

namespace mimetra {
namespace {

/// A wavy sheet, with some amount on each of a third of its triangles.
class DiscSearchTest : public testing::Test {
 protected:
  void SetUp() override {
    for (int v = 0; v < shape_.positions.rows(); ++v) {
      shape_.positions(v, 2) = std::sin(shape_.positions(v, 0));
    }
    distances_ = SurfaceDistances(shape_.positions, shape_.triangles,
                                  Weld::none(static_cast<int>(shape_.positions.rows())),
                                  GeodesicMethod::exact);
  }

  Eigen::VectorXd random_amounts(unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-2, 1);
    return Eigen::VectorXd::NullaryExpr(shape_.triangles.rows(), [&] { return uniform(random); })
        .cwiseMax(0);
  }

  DiscSearch search(double radius) const {
    return {shape_.positions, shape_.triangles, distances_, radius};
  }

  /// Sum over the triangles that have a vertex within the radius.
  double held(VertexIndex center, double radius, const Eigen::VectorXd& amounts) const {
    const Eigen::VectorXd from = distances_({&center, 1});
    double sum = 0;
    for (int t = 0; t < shape_.triangles.rows(); ++t) {
      if (from(shape_.triangles.row(t)).minCoeff() <= radius) sum += amounts[t];
    }
    return sum;
  }

  /// By the disc around any vertex.
  double most_held(double radius, const Eigen::VectorXd& amounts) const {
    double most = 0;
    for (VertexIndex v = 0; v < shape_.positions.rows(); ++v) {
      most = std::max(most, held(v, radius, amounts));
    }
    return most;
  }

  test::Shape shape_ = test::grid(14, 11);
  DistanceFunction distances_;
};

TEST_F(DiscSearchTest, FindsTheDiscThatHoldsMost) {
  // A quarter of the radius is less than an edge: every vertex is a centre to compare.
  const double radius = 2.5;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Eigen::VectorXd amounts = random_amounts(seed);
    const double most = most_held(radius, amounts);
    DiscSearch search = this->search(radius);
    const Disc disc = search.best(amounts);
    EXPECT_NEAR(held(disc.center, radius, amounts), most, 1e-9 * most);
    EXPECT_NEAR(amounts(disc.triangles).sum(), most, 1e-9 * most);
    for (const VertexIndex v : disc.vertices) {
      EXPECT_LE(distances_({&disc.center, 1})(v, 0), radius * (1 + 1e-9));
    }
  }
}

TEST_F(DiscSearchTest, ComesCloseWhereItComparesFewCentres) {
  const double radius = 5;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Eigen::VectorXd amounts = random_amounts(seed);
    const double most = most_held(radius, amounts);
    EXPECT_GT(amounts(search(radius).best(amounts).triangles).sum(), 0.8 * most);
  }
}

TEST_F(DiscSearchTest, IsTheSameOnATurnedMesh) {
  const Eigen::VectorXd amounts = random_amounts(5);
  const Disc disc = search(2.5).best(amounts);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  const Positions turned =
      (shape_.positions * turn.transpose()).rowwise() + Eigen::RowVector3d(90, 20, -40);
  DiscSearch other(turned, shape_.triangles, distances_, 2.5);
  const Disc found = other.best(amounts);
  EXPECT_EQ(found.center, disc.center);
  EXPECT_EQ(found.vertices, disc.vertices);
}

TEST_F(DiscSearchTest, HoldsOnlyWhatIsInside) {
  std::vector<bool> inside(shape_.positions.rows());
  for (VertexIndex v = 0; v < shape_.positions.rows(); ++v) inside[v] = shape_.positions(v, 0) < 4;
  DiscSearch search(shape_.positions, shape_.triangles, distances_, 2.5, inside);
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Disc disc = search.best(random_amounts(seed));
    ASSERT_FALSE(disc.vertices.empty());
    EXPECT_TRUE(inside[disc.center]);
    for (const VertexIndex v : disc.vertices) EXPECT_TRUE(inside[v]);
    for (const int t : disc.triangles) {
      const auto corners = shape_.triangles.row(t);
      EXPECT_TRUE(inside[corners[0]] || inside[corners[1]] || inside[corners[2]]);
    }
  }
}

TEST_F(DiscSearchTest, FindsNoDiscWhereThereIsNothing) {
  const Disc disc = search(2.5).best(Eigen::VectorXd::Zero(shape_.triangles.rows()));
  EXPECT_EQ(disc.center, -1);
  EXPECT_TRUE(disc.vertices.empty());
  EXPECT_TRUE(disc.triangles.empty());
}

}  // namespace
}  // namespace mimetra
