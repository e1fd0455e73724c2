#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/poly_data.h"

namespace mimetra::test {
namespace {

/// The quad and the triangle, with a vertex and a line beside them.
class PolyData : public ::testing::Test {
 protected:
  void SetUp() override {
    set_polygons(*data_, faces());
    set_positions(*data_, fields_.sequence().frame(1), Precision::double_precision);
    vtkNew<vtkCellArray> vertices, lines;
    vertices->InsertNextCell({3});
    lines->InsertNextCell({0, 4});
    data_->SetVerts(vertices);
    data_->SetLines(lines);
  }

  const Connectivity& faces() const { return fields_.sequence().connectivity(); }

  FieldSequence fields_ = quad_and_triangle();
  vtkNew<vtkPolyData> data_;
};

TEST_F(PolyData, GivesBackPositionsToTheLastBit) {
  EXPECT_TRUE(positions_of(*data_, "mesh") == fields_.sequence().frame(1));
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
  const Positions positions = fields_.sequence().frame(1);
  const Positions rest = fields_.sequence().rest();
  EXPECT_FALSE(rest_of(*data_, positions, "mesh"));
  set_rest(*data_, rest);
  EXPECT_TRUE(*rest_of(*data_, positions, "mesh") == rest);
  for (const Field& field : fields_of(*data_, faces())) EXPECT_NE(field.name, kRestPose);
  set_rest(*data_, {});
  EXPECT_FALSE(data_->GetPointData()->HasArray(kRestPose));
}

TEST_F(PolyData, ReadsARestPoseThatIsFieldData) {
  const Positions rest = fields_.sequence().rest();
  set_rest(*data_, rest);
  vtkDataArray* array = data_->GetPointData()->GetArray(kRestPose);
  data_->GetFieldData()->AddArray(array);
  data_->GetPointData()->RemoveArray(kRestPose);
  EXPECT_TRUE(*rest_of(*data_, fields_.sequence().frame(1), "mesh") == rest);
  set_rest(*data_, {});
  EXPECT_FALSE(data_->GetFieldData()->HasArray(kRestPose));
}

TEST_F(PolyData, HasNoRestPoseWhereAFilterHasTakenVerticesAway) {
  set_rest(*data_, fields_.sequence().rest());
  EXPECT_FALSE(rest_of(*data_, fields_.sequence().frame(1).topRows(4), "mesh"));
}

TEST_F(PolyData, TakesTheRestPoseBack) {
  set_rest(*data_, fields_.sequence().rest());
  set_rest(*data_, {});
  EXPECT_FALSE(rest_of(*data_, fields_.sequence().frame(1), "mesh"));
}

std::string refusal_of(const std::function<void()>& read) {
  try {
    read();
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

TEST_F(PolyData, RefusesARestPoseThatIsNotFinite) {
  const Positions positions = fields_.sequence().frame(1);
  const auto read = [&] { rest_of(*data_, positions, "mesh"); };
  Positions displacement = positions - fields_.sequence().rest();
  displacement(2, 1) = std::numeric_limits<double>::quiet_NaN();
  set_rest(*data_, positions - displacement);
  EXPECT_EQ(refusal_of(read), "mesh: rest pose: vertex 2 is not finite");
}

TEST_F(PolyData, RefusesTriangleStrips) {
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({0, 1, 2, 3});
  data_->SetStrips(strips);
  EXPECT_EQ(refusal_of([this] { connectivity_of(*data_, "mesh"); }),
            "mesh: has triangle strips; apply ParaView's Triangulate first");
}

}  // namespace
}  // namespace mimetra::test
