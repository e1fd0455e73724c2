#include <gtest/gtest.h>

#include "tests/transfer/faces.h"
#include "toolkit/transfer/blendshape_transfer.h"

/// What a blendshape transfer does not depend on.
namespace mimetra {
namespace {

using test::bent_patch;
using test::patch;
using test::Shape;

Eigen::Matrix3d turn() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(2, -1, 3).normalized()).toRotationMatrix();
}

/// Every point p of a sequence becomes map p + shift, in the rest pose too.
MeshSequence mapped(const MeshSequence& sequence, const Eigen::Matrix3d& map,
                    const Eigen::RowVector3d& shift) {
  Frames frames(sequence.frames(), 3 * sequence.vertices());
  for (int f = 0; f < sequence.frames(); ++f) {
    Eigen::Map<Positions>(frames.row(f).data(), sequence.vertices(), 3) =
        (sequence.frame(f) * map.transpose()).rowwise() + shift;
  }
  const Positions rest = (sequence.rest() * map.transpose()).rowwise() + shift;
  return {sequence.shared_connectivity(), frames, sequence.times(), rest};
}

BlendshapeModel mapped(const BlendshapeModel& model, const Eigen::Matrix3d& map,
                       const Eigen::RowVector3d& shift) {
  ShapeBasis basis = model.expressions();
  for (int j = 0; j < basis.size(); ++j) {
    for (int v = 0; v < model.vertices(); ++v) {
      basis.displacements.col(j).segment<3>(3 * v) =
          (map * model.expressions().displacements.col(j).segment<3>(3 * v)).eval();
    }
  }
  const Positions neutral = (model.neutral() * map.transpose()).rowwise() + shift;
  return {model.shared_connectivity(), neutral, basis};
}

Eigen::MatrixXd weights_of(const MeshSequence& source, const BlendshapeModel& target) {
  return BlendshapeTransfer(source.rest(), target, all_triangles(target.triangles()))
      .weights(source);
}

class BlendshapeInvariance : public testing::Test {
 protected:
  const BlendshapeModel target_ = test::model_on(bent_patch(), 5);
  const MeshSequence source_ = test::shaken(patch(), 5, 0.2);
  const Eigen::MatrixXd weights_ = weights_of(source_, target_);
  const Eigen::Matrix3d identity_ = Eigen::Matrix3d::Identity();

  /// Rounding of positions near 10, in units of edges near 1, times a condition number near 1e2.
  static constexpr double kRounding = 1e-12;

  void expect_the_same(const MeshSequence& source, const BlendshapeModel& target,
                       double tolerance = kRounding) const {
    EXPECT_LT((weights_of(source, target) - weights_).lpNorm<Eigen::Infinity>(), tolerance);
  }
};

TEST_F(BlendshapeInvariance, HoldsForTheScaleOfEither) {
  expect_the_same(mapped(source_, 1000 * identity_, {0, 0, 0}), target_);
  expect_the_same(source_, mapped(target_, 0.001 * identity_, {0, 0, 0}));
}

TEST_F(BlendshapeInvariance, HoldsForAPlaceFarFromTheOrigin) {
  // Positions near 1e5 carry rounding of 1e-11.
  expect_the_same(mapped(source_, identity_, {1e5, -1e5, 0}),
                  mapped(target_, identity_, {0, 1e5, 1e5}), 1e-8);
}

TEST_F(BlendshapeInvariance, HoldsForARotationOfBoth) {
  expect_the_same(mapped(source_, turn(), {1, 2, 3}), mapped(target_, turn(), {-3, 0, 1}));
}

TEST(BlendshapeTransfer, GivesExactlyZeroWhereAFrameOfAMovingTakeIsTheRestPose) {
  const BlendshapeModel target = test::model_on(bent_patch(), 5);
  const MeshSequence take = test::shaken(patch(), 12, 0.3);
  Frames frames = take.positions();
  frames.row(7) = Eigen::Map<const Eigen::RowVectorXd>(take.rest().data(), take.rest().size());
  EXPECT_EQ(weights_of(take.with_frames(frames), target).row(7), Eigen::RowVectorXd::Zero(5));
}

TEST(BlendshapeTransfer, IsTheSameAtTheBordersOfItsBlocksOfFrames) {
  const BlendshapeModel target = test::model_on(bent_patch(), 5);
  const MeshSequence take = test::shaken(patch(), 49, 0.3);
  const BlendshapeTransfer transfer(take.rest(), target, all_triangles(target.triangles()));
  const Eigen::MatrixXd all = transfer.weights(take);
  for (const int f : {0, 15, 16, 17, 31, 32, 33, 47, 48}) {
    // Another start leaves rounding times the condition number of about 1e2.
    EXPECT_LT((transfer.weights(take.slice(f, f + 1)) - all.row(f)).lpNorm<Eigen::Infinity>(),
              1e-12)
        << f;
  }
}

TEST(BlendshapeTransfer, GivesTheSameBytesAgain) {
  const BlendshapeModel target = test::model_on(bent_patch(), 5);
  const MeshSequence take = test::shaken(patch(), 40, 0.3);
  EXPECT_EQ(weights_of(take, target), weights_of(take, target));
}

TEST(BlendshapeTransfer, CountsNeedlesAndCollapsedTriangles) {
  Shape needle = patch(), collapsed = patch();
  const auto corners = needle.triangles.row(60);
  const Eigen::RowVector3d middle =
      (needle.positions.row(corners[0]) + needle.positions.row(corners[1])) / 2;
  const Eigen::RowVector3d tip = needle.positions.row(corners[2]);
  needle.positions.row(corners[2]) = middle + 1e-9 * (tip - middle);
  const BlendshapeTransfer of_source(needle.positions, test::model_on(patch(), 5), {59, 60, 61});
  EXPECT_EQ(of_source.conditions().degenerate_source_triangles, 1);
  collapsed.positions.row(corners[2]) = collapsed.positions.row(corners[0]);
  const BlendshapeTransfer of_target(patch().positions, test::model_on(collapsed, 4), {60});
  EXPECT_EQ(of_target.conditions().degenerate_target_triangles, 1);
}

TEST(BlendshapeTransfer, TakesTrianglesOfTheRegionOnly) {
  const BlendshapeModel target = test::model_on(bent_patch(), 5);
  const MeshSequence take = test::shaken(patch(), 4, 0.3);
  const BlendshapeTransfer upper(take.rest(), target, [] {
    std::vector<int> rows(64);
    for (int t = 0; t < 64; ++t) rows[t] = t;
    return rows;
  }());
  // Row 8 of the grid belongs to none of the first 64 triangles.
  Frames frames = take.positions();
  frames.rightCols(3 * 9).array() += 1;
  EXPECT_EQ(upper.weights(take), upper.weights(take.with_frames(frames)));
}

}  // namespace
}  // namespace mimetra
