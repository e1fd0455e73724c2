#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "tests/transfer/faces.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/edges.h"
#include "toolkit/transfer/transfer_error.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {
namespace {

using test::patch;
using test::Shape;

/// Eq. 12 of one triangle, of which the corner `first` is written first.
double literal_error(const MeshSequence& source, const MeshSequence& result, int frame,
                     int triangle, int first) {
  const auto corners = source.triangles().row(triangle);
  const Triangles turned =
      Eigen::RowVector3i(corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]);
  const Eigen::Matrix3d q = triangle_frame(source.frame(frame), turned, 0) *
                            triangle_frame(source.rest(), turned, 0).inverse();
  const Edges v = triangle_frame(result.rest(), turned, 0).leftCols<2>();
  const Edges found = triangle_frame(result.frame(frame), turned, 0).leftCols<2>();
  return (q * v - found).squaredNorm();
}

TEST(TransferError, IsTheMeanOfEquation12) {
  const Shape shape = patch();
  const MeshSequence source = test::shaken(shape, 3, 0.2, 1),
                     result = test::shaken(shape, 3, 0.2, 2);
  const auto selected = test::half_of(shape.triangles);
  for (const EdgeSum edges : {EdgeSum::all, EdgeSum::two}) {
    const TransferError error = transfer_error(source, result, selected, {.edges = edges});
    double all = 0, region = 0;
    for (int f = 0; f < 3; ++f) {
      for (int t = 0; t < shape.triangles.rows(); ++t) {
        double squared = literal_error(source, result, f, t, 0);
        if (edges == EdgeSum::all) {
          squared +=
              literal_error(source, result, f, t, 1) + literal_error(source, result, f, t, 2);
          squared /= 3;
        }
        all += squared;
        if (t % 2 == 0) region += squared;
      }
    }
    // Means of a few hundred numbers below 1.
    EXPECT_NEAR(error.de_all, all / (3 * 128), 1e-13);
    EXPECT_NEAR(error.de_region, region / (3 * 64), 1e-13);
    EXPECT_NEAR(error.per_frame.mean(), error.de_all, 1e-13);
    EXPECT_NEAR(error.per_triangle.mean(), error.de_all, 1e-13);
  }
}

TEST(TransferError, OfTheSourceItselfIsZero) {
  const MeshSequence source = test::shaken(patch(), 3, 0.2);
  const TransferError error = transfer_error(source, source, all_triangles(source.triangles()));
  // Squares of rounding errors of numbers near 10.
  EXPECT_LT(error.de_all, 1e-26);
  EXPECT_EQ(error.leak, 0);
  EXPECT_EQ(error.flipped, 0);
}

TEST(TransferError, OverAllTrianglesIsNeverBelowTheFullTransfers) {
  Shape other = patch();
  other.positions.col(0) *= 1.4;
  const BlendshapeModel target = test::model_on(other, 5);
  const MeshSequence source = test::shaken(patch(), 10, 0.3);
  const auto error_of = [&](const std::vector<int>& selected) {
    const BlendshapeTransfer transfer(source.rest(), target, selected);
    return transfer_error(source, target.animate(transfer.weights(source)), selected).de_all;
  };
  const double full = error_of(all_triangles(target.triangles()));
  for (int first = 0; first < 128; first += 16) {
    std::vector<int> some(40);
    std::iota(some.begin(), some.end(), std::min(first, 88));
    EXPECT_GE(error_of(some), full * (1 - 1e-12)) << first;
  }
}

TEST(TransferError, LeakIsTheLargestMotionOfAVertexOutside) {
  const MeshSequence source = test::shaken(patch(), 2, 0);
  Frames frames = source.positions();
  frames(1, 3 * 80 + 2) += 0.7;
  const MeshSequence result = source.with_frames(frames);
  EXPECT_DOUBLE_EQ(transfer_error(source, result, {0, 1}).leak, 0.7);
  EXPECT_EQ(transfer_error(source, result, all_triangles(source.triangles())).leak, 0);
}

TEST(TransferError, CountsFlippedTriangles) {
  const Shape shape = test::grid(3, 3);
  const MeshSequence source = test::shaken(shape, 1, 0);
  Positions pose = shape.positions;
  pose.row(0) << 5, 5, 0;  // across the opposite edges of its two triangles
  Frames frames = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  EXPECT_EQ(transfer_error(source, source.with_frames(frames), {0}).flipped, 2);
}

TEST(TransferError, CountsNoFlippedSlivers) {
  Shape shape = test::grid(3, 3);
  // Across its long edge and back: a sliver of a thousandth, and its neighbour.
  const Eigen::RowVector3d middle =
      (shape.positions.row(shape.triangles(0, 1)) + shape.positions.row(shape.triangles(0, 2))) / 2;
  const Eigen::RowVector3d corner = shape.positions.row(shape.triangles(0, 0));
  Positions pose = shape.positions;
  shape.positions.row(shape.triangles(0, 0)) = middle + 5e-4 * (corner - middle);
  pose.row(shape.triangles(0, 0)) = middle - 5e-4 * (corner - middle);
  const MeshSequence source = test::shaken(shape, 1, 0);
  const Frames frames = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  const TransferError error = transfer_error(source, source.with_frames(frames), {0});
  ASSERT_LT(quality_of(shape.positions, shape.triangles, 0), kSliverQuality);
  EXPECT_EQ(error.flipped, 0);
}

TEST(TransferError, MeasuresADegenerateSourceTriangleAgainstItsStandIn) {
  Shape shape = patch();
  shape.positions.row(shape.triangles(60, 2)) = shape.positions.row(shape.triangles(60, 0));
  const MeshSequence source = test::shaken(shape, 2, 0.05);
  const MeshSequence result = test::shaken(patch(), 2, 0.05, 9);
  const TransferError error = transfer_error(source, result, {60}, {.edges = EdgeSum::two});
  const DeformationGradients gradients(source.rest(), source.triangles(), {60});
  double expected = 0;
  for (int f = 0; f < 2; ++f) {
    const Eigen::Matrix3d q = gradients(source.frame(f));
    const Edges v = triangle_frame(result.rest(), source.triangles(), 60).leftCols<2>();
    const Edges found = triangle_frame(result.frame(f), source.triangles(), 60).leftCols<2>();
    expected += (q * v - found).squaredNorm() / 2;
  }
  EXPECT_NEAR(error.de_region, expected, 1e-13);
}

TEST(TransferError, OfNoTrianglesIsZero) {
  const MeshSequence source = test::shaken(patch(), 2, 0.1);
  EXPECT_EQ(transfer_error(source, source, {}).de_region, 0);
}

TEST(TransferError, RefusesATriangleOutOfRange) {
  const MeshSequence source = test::shaken(patch(), 1, 0);
  EXPECT_THROW(transfer_error(source, source, {128}), std::invalid_argument);
  EXPECT_THROW(transfer_error(source, source, {-1}), std::invalid_argument);
}

TEST(TransferError, RefusesOtherSizes) {
  const MeshSequence three = test::shaken(patch(), 3, 0), two = test::shaken(patch(), 2, 0);
  EXPECT_THROW(transfer_error(three, two, {0}), MismatchError);
}

TEST(MeanPercentageError, IsZeroWhereBothAreEqualAndNegativeWhereWorseThanFull) {
  EXPECT_DOUBLE_EQ(mean_percentage_error(2, 2.5), -25);
  EXPECT_EQ(mean_percentage_error(2, 2), 0);
  EXPECT_EQ(mean_percentage_error(0, 0), 0);
}

TEST(TransferError, SaysWhichShareOfTheDeformationIsMissing) {
  const BlendshapeModel model = test::model_on(test::patch(), 3);
  const MeshSequence source = model.animate(test::random_weights(3, 3));
  const std::vector<int> all = all_triangles(source.triangles());
  EXPECT_LT(missed_share(transfer_error(source, source, all)), 1e-20);
  const MeshSequence still = model.animate(Eigen::MatrixXd::Zero(3, 3));
  const TransferError error = transfer_error(source, still, all);
  EXPECT_NEAR(missed_share(error), 1, 1e-12);
  EXPECT_EQ(flipped_share(error), error.flipped / (3.0 * double(all.size())));
  EXPECT_EQ(missed_share(transfer_error(still, still, all)), 0);
}

TEST(TransferError, MissesNothingWhereVerticesTakeTheShareThatTheyAreToTake) {
  const BlendshapeModel model = test::model_on(test::patch(), 3);
  const Eigen::MatrixXd weights = test::random_weights(3, 3);
  const MeshSequence source = model.animate(weights), half = model.animate(weights / 2);
  const std::vector<int> all = all_triangles(source.triangles());
  EXPECT_NEAR(missed_share(transfer_error(source, half, all)), 0.25, 1e-12);
  const TransferErrorOptions halved{.weights = Eigen::VectorXd::Constant(source.vertices(), 0.5)};
  const TransferError error = transfer_error(source, half, all, halved);
  EXPECT_LT(missed_share(error), 1e-20);
  EXPECT_NEAR(error.de_all, error.de_still, 1e-12 * error.de_all);
}

TEST(TransferError, InsideIsThatOfTrianglesThatTakeAll) {
  const BlendshapeModel model = test::model_on(test::patch(), 3);
  const MeshSequence source = model.animate(test::random_weights(3, 3));
  const MeshSequence still = model.animate(Eigen::MatrixXd::Zero(3, 3));
  const std::vector<int> all = all_triangles(source.triangles());
  TransferErrorOptions options{.weights = Eigen::VectorXd::Constant(source.vertices(), 0.5)};
  EXPECT_FALSE(transfer_error(source, still, all, options).de_inside);
  for (const VertexIndex v : source.triangles().row(2)) options.weights[v] = 1;
  const TransferError error = transfer_error(source, still, all, options);
  EXPECT_EQ(error.de_inside, error.per_triangle[2]);
  EXPECT_EQ(transfer_error(source, still, {1}).de_inside, error.per_triangle[1]);
}

}  // namespace
}  // namespace mimetra
