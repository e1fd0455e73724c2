#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/correspondence/face_openings.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

constexpr int kColumns = 41, kRows = 31, kMiddle = 15;

/// A sheet with a mouth from column 8 to 32: landmarks on row 15 above, where y grows, and below.
LandmarkVertices mouth() {
  const auto at = [](int x, int y) { return y * kColumns + x; };
  return {{48, at(8, kMiddle)},      {54, at(32, kMiddle)},     {50, at(15, kMiddle + 4)},
          {51, at(20, kMiddle + 4)}, {52, at(25, kMiddle + 4)}, {58, at(15, kMiddle - 3)},
          {57, at(20, kMiddle - 3)}, {56, at(25, kMiddle - 3)}};
}

/// The sheet; with a cut between its corners along the middle row, whose vertices there are two:
/// the upper triangles have the further ones, `gap` higher.
TriMesh sheet(bool is_cut, double gap) {
  test::Shape shape = test::grid(kColumns, kRows);
  if (is_cut) {
    const int further = kColumns * kRows, first = kMiddle * kColumns + 9, count = 23;
    shape.positions.conservativeResize(further + count, 3);
    shape.positions.bottomRows(count) = shape.positions.middleRows(first, count);
    shape.positions.bottomRows(count).col(1).array() += gap;
    for (auto triangle : shape.triangles.rowwise()) {
      if (shape.positions(triangle.maxCoeff(), 1) <= kMiddle) continue;
      for (VertexIndex& corner : triangle) {
        if (corner >= first && corner < first + count) corner += further - first;
      }
    }
  }
  return {shape.positions,
          Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles)};
}

MeshSequence one_frame(const TriMesh& mesh) {
  return MeshSequence(mesh.connectivity,
                      Frames(mesh.positions.reshaped<Eigen::RowMajor>().transpose()));
}

TEST(FaceOpenings, OfACutSheetAreAsWideAsTheirCornersAreApart) {
  const auto found = face_openings(sheet(true, 0.5), mouth());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "mouth");
  EXPECT_DOUBLE_EQ(found[0].width, 24);
}

TEST(FaceOpenings, OpenAsFarAsTheirEdgesPart) {
  const TriMesh rest = sheet(true, 0.5);
  const auto found = face_openings(rest, mouth());
  ASSERT_EQ(found.size(), 1u);
  for (const double gap : {0.0, 0.5, 0.9}) {
    EXPECT_NEAR(openness(one_frame(sheet(true, gap)), found)(0, 0), gap / 24, 1e-12) << gap;
  }
}

TEST(FaceOpenings, AreNoneWhereTheSkinHasNoCut) {
  EXPECT_TRUE(face_openings(sheet(false, 0), mouth()).empty());
}

TEST(FaceOpenings, AreNoneWithoutAllTheirLandmarks) {
  LandmarkVertices landmarks = mouth();
  landmarks.pop_back();
  EXPECT_TRUE(face_openings(sheet(true, 0.5), landmarks).empty());
}

TEST(FaceOpenings, RefuseALandmarkThatIsNoVertex) {
  EXPECT_THROW(face_openings(sheet(false, 0), {{48, -1}}), std::invalid_argument);
  EXPECT_THROW(face_openings(sheet(false, 0), {{48, kColumns * kRows}}), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
