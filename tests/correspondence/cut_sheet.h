#pragma once

#include "tests/shapes.h"
#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/mesh/mesh_sequence.h"

/// A sheet of skin with a mouth.
namespace mimetra::test {

inline constexpr int kColumns = 41, kRows = 31, kMiddle = 15;

/// Landmarks of a mouth from column 8 to 32 of the middle row: lips above, where y grows, and
/// below.
inline LandmarkVertices mouth() {
  const auto at = [](int x, int y) { return y * kColumns + x; };
  return {{48, at(8, kMiddle)},      {54, at(32, kMiddle)},     {50, at(15, kMiddle + 4)},
          {51, at(20, kMiddle + 4)}, {52, at(25, kMiddle + 4)}, {58, at(15, kMiddle - 3)},
          {57, at(20, kMiddle - 3)}, {56, at(25, kMiddle - 3)}};
}

/// The sheet; with a cut between its corners along the middle row, whose vertices there are two:
/// the upper triangles have the further ones, `gap` higher.
inline TriMesh sheet(bool is_cut, double gap) {
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

inline MeshSequence one_frame(const TriMesh& mesh) {
  return MeshSequence(mesh.connectivity,
                      Frames(mesh.positions.reshaped<Eigen::RowMajor>().transpose()));
}

}  // namespace mimetra::test
