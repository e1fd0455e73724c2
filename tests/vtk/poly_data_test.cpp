#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIdTypeArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTypeUInt64Array.h>

#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/vtk/poly_data.h"

namespace mimetra::test {
namespace {

using ::testing::HasSubstr;

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

TEST_F(PolyData, HasTheWholeNumbersOfAllIntegerArrays) {
  const auto add = [this](vtkDataArray& array, const char* name) {
    array.SetName(name);
    for (int v = 0; v < 5; ++v) array.InsertNextTuple1(5e9 + v);
    data_->GetPointData()->AddArray(&array);
  };
  add(*vtkNew<vtkIdTypeArray>(), "ids");
  add(*vtkNew<vtkTypeUInt64Array>(), "hashes");
  const std::vector<Field> fields = fields_of(*data_, faces());
  ASSERT_EQ(fields.size(), 2u);
  for (const Field& field : fields) {
    EXPECT_TRUE(field.values == Eigen::VectorXd::LinSpaced(5, 5e9, 5e9 + 4)) << field.name;
    EXPECT_TRUE(field.integer) << field.name;
  }
}

TEST_F(PolyData, CarriesTheRestPoseToTheLastBit) {
  const Positions positions = fields_.sequence().frame(1);
  const Positions rest = fields_.sequence().rest();
  EXPECT_FALSE(rest_of(*data_, positions, "mesh"));
  set_rest(*data_, rest);
  EXPECT_TRUE(rest_of(*data_, positions, "mesh")->positions == rest);
  EXPECT_TRUE(fields_of(*data_, faces()).empty());
  set_rest(*data_, {});
  EXPECT_FALSE(data_->GetPointData()->HasArray(kRestPose));
  EXPECT_FALSE(data_->GetPointData()->HasArray(kPlaced));
}

TEST_F(PolyData, KeepsTheRestPoseWhereNewPositionsAreSet) {
  const Positions rest = fields_.sequence().rest();
  set_rest(*data_, rest);
  set_positions(*data_, fields_.sequence().frame(2), Precision::single_precision);
  const auto found = rest_of(*data_, positions_of(*data_, "mesh"), "mesh");
  EXPECT_TRUE(found->positions == rest);
  EXPECT_EQ(found->note, "");
}

/// A mesh as filters leave that move its points: the vectors on them may be turned and scaled, too.
class MovedPolyData : public PolyData {
 protected:
  /// Data with a rest pose that is not in the plane of the points.
  void SetUp() override {
    PolyData::SetUp();
    rest_ = positions_ + Positions::Random(5, 3);
    set_rest(*data_, rest_);
  }

  void set_vectors(const char* name, const Positions& values) {
    vtkDataArray* array = data_->GetPointData()->GetArray(name);
    vtkNew<vtkDoubleArray> moved;
    moved->SetName(name);
    moved->SetNumberOfComponents(3);
    for (const auto row : values.rowwise()) moved->InsertNextTuple3(row[0], row[1], row[2]);
    ASSERT_EQ(array->GetNumberOfTuples(), moved->GetNumberOfTuples());
    data_->GetPointData()->AddArray(moved);
  }

  Positions positions_ = fields_.sequence().frame(1);
  Positions rest_;
};

TEST_F(MovedPolyData, MovesTheRestPoseByTheShiftOfThePoints) {
  // To any size: a five-hundredth of the head's is seen, and so is much less.
  for (const double length : {1e-5, 0.01, 300.0}) {
    const Eigen::RowVector3d shift = length * Eigen::RowVector3d(1, -0.5, 0.25);
    const auto found = rest_of(*data_, positions_.rowwise() + shift, "mesh");
    EXPECT_LT((found->positions - (rest_.rowwise() + shift)).norm(), 1e-12 * (1 + length));
    EXPECT_EQ(found->note, "");
  }
}

TEST_F(MovedPolyData, MovesTheRestPoseWhereVectorsWereTurnedWithThePoints) {
  const Eigen::Matrix3d map =
      2 * Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Eigen::RowVector3d shift(3, 4, 5);
  set_vectors(kRestPose, rest_ * map);
  set_vectors(kPlaced, positions_ * map);
  const auto found = rest_of(*data_, (positions_ * map).rowwise() + shift, "mesh");
  EXPECT_LT((found->positions - ((rest_ * map).rowwise() + shift)).norm(), 1e-12);
  EXPECT_EQ(found->note, "");
}

TEST_F(MovedPolyData, TurnsTheRestPoseWithThePointsAlone) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const Positions solid = positions_ + Positions::Random(5, 3);
  set_positions(*data_, solid, Precision::double_precision);
  const Eigen::RowVector3d shift(3, 4, 5);
  const auto found = rest_of(*data_, (solid * turn).rowwise() + shift, "mesh");
  EXPECT_LT((found->positions - ((rest_ * turn).rowwise() + shift)).norm(), 1e-10);
  EXPECT_EQ(found->note, "");
}

TEST_F(MovedPolyData, LeavesTheRestPoseAndSaysSoWhereThePointsAreBent) {
  Positions bent = positions_;
  bent(2, 2) += 0.01;
  const auto found = rest_of(*data_, bent, "mesh");
  EXPECT_TRUE(found->positions == rest_);
  EXPECT_THAT(found->note, HasSubstr("not as a whole"));
  EXPECT_THAT(found->note, HasSubstr("mimetra_rest"));
  EXPECT_THAT(found->note, HasSubstr("Pass Arrays"));
}

TEST_F(MovedPolyData, LeavesTheRestPoseOfEarlierVersionsWhereItIs) {
  data_->GetPointData()->RemoveArray(kPlaced);
  const auto found = rest_of(*data_, positions_.rowwise() + Eigen::RowVector3d(1, 0, 0), "mesh");
  EXPECT_TRUE(found->positions == rest_);
  EXPECT_EQ(found->note, "");
}

TEST_F(PolyData, ReadsARestPoseThatIsFieldData) {
  const Positions rest = fields_.sequence().rest();
  set_rest(*data_, rest);
  vtkDataArray* array = data_->GetPointData()->GetArray(kRestPose);
  data_->GetFieldData()->AddArray(array);
  data_->GetPointData()->RemoveArray(kRestPose);
  EXPECT_TRUE(rest_of(*data_, fields_.sequence().frame(1), "mesh")->positions == rest);
  set_rest(*data_, {});
  EXPECT_FALSE(data_->GetFieldData()->HasArray(kRestPose));
}

TEST_F(PolyData, HasNoRestPoseWhereAFilterHasTakenVerticesAway) {
  set_rest(*data_, fields_.sequence().rest());
  EXPECT_FALSE(rest_of(*data_, fields_.sequence().frame(1).topRows(4), "mesh"));
}

TEST_F(PolyData, RefusesARestPoseThatIsNotFinite) {
  Positions rest = fields_.sequence().rest();
  rest(2, 1) = std::numeric_limits<double>::quiet_NaN();
  set_rest(*data_, rest);
  EXPECT_EQ(message_of<IoError>([&] { rest_of(*data_, fields_.sequence().frame(1), "mesh"); }),
            "mesh: rest pose: vertex 2 has no usable position");
}

TEST_F(PolyData, RefusesTriangleStrips) {
  vtkNew<vtkCellArray> strips;
  strips->InsertNextCell({0, 1, 2, 3});
  data_->SetStrips(strips);
  EXPECT_EQ(message_of<IoError>([this] { connectivity_of(*data_, "mesh"); }),
            "mesh: has triangle strips; apply ParaView's Triangulate first");
}

}  // namespace
}  // namespace mimetra::test
