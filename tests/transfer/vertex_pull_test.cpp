#include <numeric>

#include <gtest/gtest.h>

#include "tests/transfer/faces.h"
#include "toolkit/transfer/vertex_pull.h"

namespace mimetra {
namespace {

using test::patch;
using test::Shape;

std::vector<Edges> random_vectors(std::size_t count) {
  std::vector<Edges> vectors(count);
  for (Edges& vector : vectors) vector.setRandom();
  return vectors;
}

/// The sum of (Q_i - I) x_iv at each vertex, written out.
Positions literal_pull(const DeformationGradients& gradients, const Triangles& triangles,
                       const std::vector<Edges>& vectors, const PositionsView& frame) {
  Positions sums = Positions::Zero(frame.rows(), 3);
  const Eigen::Matrix<double, Eigen::Dynamic, 3> q = gradients(frame);
  for (std::size_t s = 0; s < vectors.size(); ++s) {
    const Eigen::Matrix3d change =
        q.middleRows<3>(Eigen::Index(3 * s)) - Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, 3, 2> pull = change * vectors[s];
    const auto corners = triangles.row(gradients.selected()[s]);
    sums.row(corners[0]) -= (pull.col(0) + pull.col(1)).transpose();
    sums.row(corners[1]) += pull.col(0).transpose();
    sums.row(corners[2]) += pull.col(1).transpose();
  }
  return sums;
}

std::vector<int> every_vertex(Eigen::Index count) {
  std::vector<int> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  return rows;
}

/// Vertex `row` in frame `lane`.
Eigen::RowVector3d at(const VertexPull::Rows& rows, int row, int lane) {
  return {rows(row, lane), rows(row, VertexPull::kLanes + lane),
          rows(row, 2 * VertexPull::kLanes + lane)};
}

void expect_literal(const Shape& shape, const std::vector<int>& selected, int frames) {
  const MeshSequence take = test::shaken(shape, frames, 0.2);
  const DeformationGradients gradients(shape.positions, shape.triangles, selected);
  const std::vector<Edges> vectors = random_vectors(selected.size());
  const VertexPull pull(shape.positions, shape.triangles, shape.triangles, gradients, vectors,
                        every_vertex(shape.positions.rows()));
  const VertexPull::Rows found = pull(take.positions());
  ASSERT_EQ(found.rows(), shape.positions.rows());
  for (int lane = 0; lane < frames; ++lane) {
    const Positions expected = literal_pull(gradients, shape.triangles, vectors, take.frame(lane));
    for (int v = 0; v < expected.rows(); ++v) {
      // Sums of a dozen numbers of order 1.
      EXPECT_LT((at(found, v, lane) - expected.row(v)).norm(), 1e-13) << v << ' ' << lane;
    }
  }
}

TEST(VertexPull, AgreesWithTheGradientsWrittenOut) {
  const Shape shape = patch();
  for (const int frames : {1, 3, 16}) {
    expect_literal(shape, test::half_of(shape.triangles), frames);
  }
}

TEST(VertexPull, TakesTheStandInsOfDegenerateTriangles) {
  Shape shape = patch();
  shape.positions.row(shape.triangles(60, 2)) =
      (shape.positions.row(shape.triangles(60, 0)) + shape.positions.row(shape.triangles(60, 1))) /
      2;
  expect_literal(shape, {59, 60, 61}, 2);
}

TEST(VertexPull, PutsEachVertexWhereItIsWanted) {
  const Shape shape = patch();
  const MeshSequence take = test::shaken(shape, 2, 0.2);
  const std::vector<int> selected = {30, 31, 32};
  const DeformationGradients gradients(shape.positions, shape.triangles, selected);
  const std::vector<Edges> vectors = random_vectors(3);
  const auto pulled = [&](const std::vector<int>& rows) {
    return VertexPull(shape.positions, shape.triangles, shape.triangles, gradients, vectors,
                      rows)(take.positions());
  };
  const VertexPull::Rows all = pulled(every_vertex(81));
  const int wanted = shape.triangles(31, 1), unused = 80;
  std::vector<int> rows(81, -1);
  rows[wanted] = 1;
  rows[unused] = 0;
  const VertexPull::Rows some = pulled(rows);
  ASSERT_EQ(some.rows(), 2);
  EXPECT_EQ(some.row(1), all.row(wanted));
  EXPECT_EQ(some.row(0).norm(), 0);
}

TEST(VertexPull, AddsWhatGoesToOneRow) {
  const Shape shape = patch();
  const MeshSequence take = test::shaken(shape, 2, 0.2);
  const DeformationGradients gradients(shape.positions, shape.triangles, {30});
  const std::vector<Edges> vectors = random_vectors(1);
  const auto pulled = [&](const std::vector<int>& rows) {
    return VertexPull(shape.positions, shape.triangles, shape.triangles, gradients, vectors,
                      rows)(take.positions());
  };
  const VertexPull::Rows all = pulled(every_vertex(81));
  const int one = shape.triangles(30, 0), other = shape.triangles(30, 2);
  std::vector<int> rows(81, -1);
  rows[one] = rows[other] = 0;
  EXPECT_EQ(pulled(rows).row(0), (all.row(one) + all.row(other)).eval());
}

TEST(VertexPull, OfTheRestPoseIsExactlyZeroInEveryLane) {
  Shape shape = patch();
  shape.positions.rowwise() += Eigen::RowVector3d(1e5, 3, -1e5);
  const auto all = test::half_of(shape.triangles);
  const DeformationGradients gradients(shape.positions, shape.triangles, all);
  const VertexPull pull(shape.positions, shape.triangles, shape.triangles, gradients,
                        random_vectors(all.size()), every_vertex(81));
  EXPECT_EQ(pull(test::shaken(shape, 16, 0).positions()).norm(), 0);
}

TEST(VertexPull, GivesAFlatTriangleNoNormal) {
  const Shape shape = patch();
  const DeformationGradients gradients(shape.positions, shape.triangles, {0});
  const VertexPull pull(shape.positions, shape.triangles, shape.triangles, gradients,
                        random_vectors(1), every_vertex(81));
  EXPECT_TRUE(pull(Frames::Zero(1, 3 * 81)).allFinite());
}

}  // namespace
}  // namespace mimetra
