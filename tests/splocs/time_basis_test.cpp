#include "toolkit/splocs/time_basis.h"

#include <cmath>

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <Eigen/SVD>

#include "tests/splocs/synthetic.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

constexpr int kFrames = 90;

/// `rank` poses, each a tenth of the one before, in 90 frames of 200 vertices.
Frames fading_motion(int rank) {
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(Eigen::MatrixXd::Random(kFrames, rank));
  const Eigen::MatrixXd courses = qr.householderQ() * Eigen::MatrixXd::Identity(kFrames, rank);
  const Eigen::VectorXd sizes =
      Eigen::VectorXd::NullaryExpr(rank, [](Eigen::Index k) { return std::pow(0.1, k); });
  Frames poses = Frames::Random(rank, 600);
  poses.rowwise().normalize();
  return courses * sizes.asDiagonal() * poses;
}

std::optional<TimeBasis> basis_of(const Frames& X, double tolerance, int threads) {
  return time_basis(VertexBlocks<double>(X), X.squaredNorm(), tolerance, X.rows(),
                    Context().with_threads(threads));
}

double lost_share(const Frames& X, const TimeBasis& basis) {
  return (X - basis.Q * basis.B.frames()).norm() / X.norm();
}

TEST(TimeBasis, LosesNoMoreThanTheTolerance) {
  const Frames X = fading_motion(8);
  for (const double tolerance : {1e-6, 1e-4, 0.03, 0.5}) {
    const auto basis = basis_of(X, tolerance, 2);
    ASSERT_TRUE(basis);
    EXPECT_LE(lost_share(X, *basis), tolerance);
    EXPECT_TRUE((basis->Q.transpose() * basis->Q).isIdentity(1e-12));
  }
}

TEST(TimeBasis, HasNoMorePosesThanNeeded) {
  const Frames X = fading_motion(8);
  // The best basis is that of the singular vectors.
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(X).singularValues();
  for (const double tolerance : {1e-4, 0.03, 0.5}) {
    Eigen::Index needed = 8;
    while (needed > 1 && values.segment(needed - 1, 9 - needed).norm() <= tolerance * X.norm()) {
      --needed;
    }
    const auto basis = basis_of(X, tolerance, 1);
    ASSERT_TRUE(basis);
    EXPECT_EQ(basis->Q.cols(), needed) << tolerance;
  }
}

TEST(TimeBasis, IsFoundUpToHalfAsManyPosesAsFrames) {
  for (const int rank : {33, kFrames / 2}) {
    const Frames X = Frames::Random(kFrames, rank) * Frames::Random(rank, 600);
    const auto basis = basis_of(X, 1e-6, 1);
    ASSERT_TRUE(basis) << rank;
    EXPECT_LE(lost_share(X, *basis), 1e-6);
  }
  const Frames short_one = Frames::Random(10, 3) * Frames::Random(3, 600);
  EXPECT_TRUE(basis_of(short_one, 1e-6, 1));
}

TEST(TimeBasis, IsNoneWhereEveryFrameIsNew) {
  const Frames X = Frames::Random(kFrames, 600);
  EXPECT_FALSE(basis_of(X, 0.01, 1));
}

TEST(TimeBasis, TellsHowFarItIsAndStops) {
  const Frames X = Frames::Random(kFrames, 600);
  const VertexBlocks<double> blocks(X);
  const Context context = Context().with_threads(2);
  double done = 0;
  const auto rising = [&done](double share) {
    EXPECT_GE(share, done);
    done = share;
    return true;
  };
  EXPECT_FALSE(time_basis(blocks, X.squaredNorm(), 0.01, kFrames, context.with_progress(rising)));
  EXPECT_EQ(done, 1);
  const auto stop = [](double share) { return share < 0.5; };
  EXPECT_THROW(time_basis(blocks, X.squaredNorm(), 0.01, kFrames, context.with_progress(stop)),
               Cancelled);
}

TEST(TimeBasis, DoesNotDependOnThreads) {
  const Frames X = fading_motion(8);
  const auto one = basis_of(X, 1e-4, 1);
  const auto three = basis_of(X, 1e-4, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->Q, three->Q);
  EXPECT_EQ(one->B.frames(), three->B.frames());
}

}  // namespace
}  // namespace mimetra::test
