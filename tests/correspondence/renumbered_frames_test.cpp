#include <memory>

#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/correspondence/renumbered_frames.h"

namespace mimetra {
namespace {

/// Two frames of four vertices; vertex v is at x = v, in the second frame at x = 10 + v.
std::shared_ptr<const FrameSource> two_frames() {
  const test::Shape shape = test::grid(4, 1);
  Frames frames(2, 12);
  frames.row(0) = shape.positions.reshaped<Eigen::RowMajor>().transpose();
  frames.row(1) = frames.row(0).array() + 10;
  Triangles triangles(2, 3);
  triangles << 0, 1, 2, 0, 2, 3;
  return std::make_shared<const MeshSequence>(Connectivity::from_triangles(4, triangles), frames);
}

TEST(RenumberedFrames, HaveTheVerticesOfTheReference) {
  Triangles triangles(2, 3);
  triangles << 3, 2, 1, 3, 1, 0;
  const auto reference =
      std::make_shared<const Connectivity>(Connectivity::from_triangles(4, triangles));
  const Renumbering found = renumbering(*reference, two_frames()->connectivity());
  ASSERT_EQ(found.vertices, (std::vector<VertexIndex>{3, 2, 1, 0}));
  const auto frames = renumbered(two_frames(), reference, found.vertices);
  EXPECT_EQ(frames->triangles(), triangles);
  EXPECT_EQ(frames->frames(), 2);
  for (int v = 0; v < 4; ++v) {
    EXPECT_EQ(frames->rest()(v, 0), 3 - v);
    EXPECT_EQ(frames->read(1, 1)(0, 3 * v), 13 - v);
  }
}

TEST(RenumberedFrames, MayHaveAVertexTwice) {
  const auto seamed = std::make_shared<const Connectivity>(
      Connectivity::from_triangles(5, two_frames()->triangles()));
  EXPECT_EQ(renumbered(two_frames(), seamed, {0, 1, 2, 3, 1})->read(0, 1)(0, 12), 1);
}

TEST(RenumberedFrames, CarryFieldsOfVertices) {
  const Field field{"roi", Field::Location::vertices, Eigen::Vector3d(5, 6, 7)};
  EXPECT_EQ(renumbered(field, {2, 0, 0}).values, Eigen::Vector3d(7, 5, 5));
}

TEST(RenumberedFrames, NeedAVertexForEach) {
  const auto connectivity = two_frames()->shared_connectivity();
  EXPECT_THROW(renumbered(two_frames(), connectivity, {0, 1, 2}), std::invalid_argument);
  EXPECT_THROW(renumbered(two_frames(), connectivity, {0, 1, 2, 4}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
