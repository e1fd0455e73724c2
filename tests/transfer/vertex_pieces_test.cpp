#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/transfer/faces.h"
#include "toolkit/transfer/gradient_system.h"
#include "toolkit/transfer/vertex_transfer.h"

/// What holds the pieces of a mesh in place.
namespace mimetra {
namespace {

using test::both;
using test::patch;
using test::Shape;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two triangles that share vertex 2 only, and one apart.
Triangles bow_tie_and_triangle() {
  Triangles triangles(3, 3);
  triangles << 0, 1, 2, 2, 3, 4, 5, 6, 7;
  return triangles;
}

TEST(VertexUnknowns, TakeTrianglesThatShareOneVertexAsOnePieceAndPinItsLowestVertex) {
  const VertexUnknowns unknowns = number_unknowns(bow_tie_and_triangle(), {1, 1, 1},
                                                  std::vector<bool>(8, false), Weld::none(8));
  ASSERT_EQ(unknowns.floating.size(), 2);
  EXPECT_THAT(unknowns.floating[0].vertices, ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(unknowns.floating[1].vertices, ElementsAre(5, 6, 7));
  EXPECT_THAT(unknowns.of_vertex, ElementsAre(-1, 0, 1, 2, 3, -1, 4, 5));
  EXPECT_EQ(unknowns.count, 6);
}

TEST(VertexUnknowns, NeedNoPinWhereAFixedVertexHoldsThePiece) {
  std::vector<bool> fixed(8, false);
  fixed[2] = true;
  const VertexUnknowns unknowns =
      number_unknowns(bow_tie_and_triangle(), {1, 1, 1}, fixed, Weld::none(8));
  EXPECT_THAT(unknowns.of_vertex, ElementsAre(0, 1, -1, 2, 3, -1, 4, 5));
  EXPECT_THAT(unknowns.held, ElementsAre(ElementsAre(0, 1, 3, 4)));
}

TEST(VertexUnknowns, AreNotConnectedByTrianglesWithoutWeight) {
  std::vector<bool> fixed(8, false);
  fixed[3] = fixed[4] = true;
  const VertexUnknowns unknowns =
      number_unknowns(bow_tie_and_triangle(), {1, 0, 1}, fixed, Weld::none(8));
  ASSERT_EQ(unknowns.floating.size(), 2);
  EXPECT_THAT(unknowns.floating[0].vertices, ElementsAre(0, 1, 2));
  EXPECT_TRUE(unknowns.held.empty());
}

Shape two_patches() {
  Shape away = patch();
  away.positions.col(0).array() += 100;
  return both(patch(), away);
}

MeshSequence one_frame(const MeshSequence& like, const Positions& pose) {
  return like.with_frames(Eigen::Map<const Frames>(pose.data(), 1, pose.size()));
}

Positions result_of(const VertexTransfer& transfer, const MeshSequence& pose) {
  return test::only_frame(transfer.frames(pose));
}

TEST(VertexTransfer, NothingDriftsOnSeveralPieces) {
  const Shape shape = two_patches();
  const MeshSequence take = test::shaken(shape, 4, 0.2);
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles,
                                all_triangles(shape.triangles));
  // Positions near 100, solved with a condition number near 1e3.
  EXPECT_LT((transfer.frames(take) - take.positions()).lpNorm<Eigen::Infinity>(), 1e-11);
}

TEST(VertexTransfer, MovesEachPieceAsTheSourcesPieceMoves) {
  const Shape shape = two_patches();
  const MeshSequence still = test::shaken(shape, 1, 0);
  Positions pose = shape.positions;
  pose.topRows(81).rowwise() += Eigen::RowVector3d(1, 0, 0);
  pose.bottomRows(81).rowwise() += Eigen::RowVector3d(0, -2, 0);
  Shape target = shape;
  target.positions *= 3;
  const VertexTransfer transfer(shape.positions, target.positions, shape.triangles,
                                all_triangles(shape.triangles));
  // The source's motion in the source's unit: a target three times the size moves as far.
  EXPECT_LT(
      (result_of(transfer, one_frame(still, pose)) - target.positions - (pose - shape.positions))
          .lpNorm<Eigen::Infinity>(),
      1e-11);
}

TEST(VertexTransfer, KeepsCentroidsWhereTheyAreTheAnchor) {
  const Shape shape = two_patches();
  const MeshSequence take = test::shaken(shape, 1, 0.3);
  VertexTransferOptions options;
  options.anchor = Anchor::centroid;
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles,
                                all_triangles(shape.triangles), options);
  const Positions moved = result_of(transfer, take) - shape.positions;
  EXPECT_LT(moved.topRows(81).colwise().mean().norm(), 1e-12);
  EXPECT_LT(moved.bottomRows(81).colwise().mean().norm(), 1e-12);
}

TEST(VertexTransfer, KeepsAVertexWhereItIsTheAnchor) {
  const Shape shape = two_patches();
  VertexTransferOptions options;
  options.anchor = Anchor::vertex;
  options.anchor_vertex = 40;
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles,
                                all_triangles(shape.triangles), options);
  const Positions found = result_of(transfer, test::shaken(shape, 1, 0.3));
  EXPECT_LT((found.row(40) - shape.positions.row(40)).norm(), 1e-15);
  EXPECT_EQ(found.row(81), shape.positions.row(81));  // the other piece's lowest vertex
}

TEST(VertexTransfer, ChangesOnlyATranslationWithTheAnchor) {
  const Shape shape = patch();
  const MeshSequence take = test::shaken(shape, 1, 0.3);
  const auto with = [&](Anchor anchor) {
    VertexTransferOptions options;
    options.anchor = anchor;
    options.anchor_vertex = 11;
    return result_of(VertexTransfer(shape.positions, shape.positions, shape.triangles,
                                    all_triangles(shape.triangles), options),
                     take);
  };
  const Positions difference = with(Anchor::vertex) - with(Anchor::centroid);
  EXPECT_LT((difference.rowwise() - difference.row(0)).lpNorm<Eigen::Infinity>(), 1e-12);
}

TEST(VertexTransfer, TakesAnAnchorWhereTheSelectedPieceFloats) {
  const Shape shape = two_patches();
  std::vector<int> first_patch(128);
  for (int t = 0; t < 128; ++t) first_patch[t] = t;
  VertexTransferOptions options;
  options.anchor = Anchor::centroid;
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles, first_patch,
                                options);
  const Positions moved = result_of(transfer, test::shaken(shape, 1, 0.3)) - shape.positions;
  EXPECT_LT(moved.topRows(81).colwise().mean().norm(), 1e-12);
  EXPECT_EQ(moved.bottomRows(81), Positions::Zero(81, 3));
}

TEST(VertexTransfer, RefusesAnAnchorWhereVerticesAreFixed) {
  const Shape shape = patch();
  std::vector<int> rows(64);
  for (int t = 0; t < 64; ++t) rows[t] = t;
  VertexTransferOptions options;
  options.anchor = Anchor::centroid;
  EXPECT_THAT(
      [&] { VertexTransfer(shape.positions, shape.positions, shape.triangles, rows, options); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("fixed vertices hold the mesh")));
}

TEST(VertexTransfer, KeepsTheRestPoseWhereNothingIsSelected) {
  const Shape shape = patch();
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles, {});
  EXPECT_EQ(result_of(transfer, test::shaken(shape, 1, 0.3)), shape.positions);
}

TEST(VertexTransfer, KeepsTheSignOfZerosOutside) {
  Shape shape = test::grid(5, 5);
  shape.positions.col(2).setConstant(-0.0);
  const VertexTransfer transfer(shape.positions, shape.positions, shape.triangles, {0, 1});
  const Positions found = result_of(transfer, test::shaken(shape, 1, 0.1));
  EXPECT_TRUE(std::signbit(found(24, 2)));
}

TEST(VertexTransfer, DoesNotDependOnWhereTheMeshLies) {
  const Shape shape = patch();
  const MeshSequence take = test::shaken(shape, 1, 0.2);
  const Eigen::RowVector3d away(1e6, -1e6, 1e6);
  const auto all = all_triangles(shape.triangles);
  const Positions target = 2 * shape.positions;
  const Positions far_rest = shape.positions.rowwise() + away;
  const Positions far_pose = Positions(take.frame(0)).rowwise() + away;
  const Positions far_target = target.rowwise() - away;
  const VertexTransfer near(shape.positions, target, shape.triangles, all);
  const VertexTransfer far(far_rest, far_target, shape.triangles, all);
  const Positions found = result_of(far, one_frame(take, far_pose)).rowwise() + away;
  // Positions near 1e6 carry rounding of 1e-10, which the solve enlarges a little.
  EXPECT_LT((found - result_of(near, take)).lpNorm<Eigen::Infinity>(), 1e-7);
}

}  // namespace
}  // namespace mimetra
