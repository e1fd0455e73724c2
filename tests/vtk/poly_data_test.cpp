#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <mimetra/vtk/poly_data.h>

#include "vtp_fixture.h"

namespace mimetra::test {
namespace {

/// The quad and the triangle, with a vertex and a line beside them.
class PolyData : public ::testing::Test {
 protected:
  void SetUp() override {
    set_polygons(*data_, faces());
    set_positions(*data_, fields_.sequence.frame(1), Precision::double_precision);
    vtkNew<vtkCellArray> vertices, lines;
    vertices->InsertNextCell({3});
    lines->InsertNextCell({0, 4});
    data_->SetVerts(vertices);
    data_->SetLines(lines);
  }

  const Connectivity& faces() const { return fields_.sequence.connectivity(); }

  FieldSequence fields_ = quad_and_triangle();
  vtkNew<vtkPolyData> data_;
};

TEST_F(PolyData, GivesBackPositionsToTheLastBit) {
  EXPECT_TRUE(positions_of(*data_, "mesh") == fields_.sequence.frame(1));
}

TEST_F(PolyData, LeavesCellsOfOtherKindsOut) {
  EXPECT_TRUE(same_faces(connectivity_of(*data_, "mesh"), faces()));
}

TEST_F(PolyData, HoldsZeroOnCellsOfOtherKinds) {
  const Field& in_l = fields_.fields[2];
  add_field(*data_, in_l, faces());
  vtkDataArray& array = *data_->GetCellData()->GetArray("in_L");
  ASSERT_EQ(array.GetNumberOfTuples(), 4);
  EXPECT_EQ(array.GetTuple1(0), 0);
  EXPECT_EQ(array.GetTuple1(1), 0);
  // The quad is the largest of its two triangles, 0 and 1.
  EXPECT_EQ(array.GetTuple1(2), 1);
  EXPECT_EQ(array.GetTuple1(3), 0);
  EXPECT_TRUE(fields_of(*data_, faces()).front().values == Eigen::Vector3d(1, 1, 0));
}

TEST_F(PolyData, CarriesTheRestPoseToTheLastBit) {
  const Positions positions = fields_.sequence.frame(1);
  const Positions rest = fields_.sequence.rest();
  EXPECT_FALSE(rest_of(*data_, positions));
  add_displacement(*data_, positions - rest);
  EXPECT_TRUE(rest_of(*data_, positions)->isApprox(rest, 1e-6));  // in single precision
  set_rest(*data_, rest);
  EXPECT_TRUE(*rest_of(*data_, positions) == rest);
}

TEST_F(PolyData, HasNoRestPoseWhereAFilterHasTakenVerticesAway) {
  set_rest(*data_, fields_.sequence.rest());
  EXPECT_FALSE(rest_of(*data_, fields_.sequence.frame(1).topRows(4)));
}

TEST_F(PolyData, TakesTheRestPoseBack) {
  set_rest(*data_, fields_.sequence.rest());
  set_rest(*data_, {});
  EXPECT_FALSE(rest_of(*data_, fields_.sequence.frame(1)));
}

}  // namespace
}  // namespace mimetra::test
