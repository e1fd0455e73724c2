#include <gmock/gmock.h>

#include "tests/io/hdf5_library.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/hdf5/vtkhdf_file.h"
#include "toolkit/io/whole_file.h"

namespace mimetra {
namespace {

using test::library_shape;
using test::library_values;
using testing::Each;
using testing::ElementsAre;
using testing::SizeIs;

/// A quad and a triangle in 9 steps, with a field on vertices and one on triangles.
FieldSequence moving_quad() {
  Polygons polygons;
  polygons.corners = {0, 1, 2, 3, 1, 4, 2};
  polygons.offsets = {0, 4, 7};
  Eigen::VectorXd times = Eigen::VectorXd::LinSpaced(9, 1, 3);
  const Frames poses = Eigen::MatrixXf::Random(9, 15).cast<double>();
  MeshSequence sequence(
      std::make_shared<const Connectivity>(Connectivity::from_polygons(5, polygons)), poses, times,
      Positions(Eigen::Map<const Positions>(poses.row(3).data(), 5, 3)));
  return {std::move(sequence),
          {{"region", Field::Location::vertices, Eigen::VectorXd::LinSpaced(5, -1, 3), true},
           {"in_L", Field::Location::triangles, Eigen::Vector3d(0, 1, 0), true}},
          true};
}

class Vtkhdf : public testing::Test {
 protected:
  void SetUp() override { write_vtkhdf(sequence_, file_); }

  std::vector<double> values(const std::string& path) const {
    return library_values(file_, "VTKHDF/" + path);
  }
  std::vector<hsize_t> shape(const std::string& path) const {
    return library_shape(file_, "VTKHDF/" + path);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "a.vtkhdf";
  FieldSequence sequence_ = moving_quad();
};

// What follows is the specification's: "VTKHDF file format", PolyData and temporal data.

TEST_F(Vtkhdf, SaysItsVersionAndType) {
  const hid_t file = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t version = H5Aopen_by_name(file, "VTKHDF", "Version", H5P_DEFAULT, H5P_DEFAULT);
  std::int64_t numbers[2] = {};
  EXPECT_GE(H5Aread(version, H5T_NATIVE_INT64, numbers), 0);
  EXPECT_THAT(numbers, ElementsAre(2, 0));
  const hid_t type = H5Aopen_by_name(file, "VTKHDF", "Type", H5P_DEFAULT, H5P_DEFAULT);
  const hid_t text = H5Aget_type(type);
  // Readers take no other than text of ASCII characters whose length is fixed.
  EXPECT_EQ(H5Tget_class(text), H5T_STRING);
  EXPECT_EQ(H5Tis_variable_str(text), 0);
  EXPECT_EQ(H5Tget_cset(text), H5T_CSET_ASCII);
  std::string name(H5Tget_size(text), '\0');
  EXPECT_GE(H5Aread(type, text, name.data()), 0);
  EXPECT_EQ(name, "PolyData");
  const hid_t steps = H5Aopen_by_name(file, "VTKHDF/Steps", "NSteps", H5P_DEFAULT, H5P_DEFAULT);
  int count = 0;
  EXPECT_GE(H5Aread(steps, H5T_NATIVE_INT, &count), 0);
  EXPECT_EQ(count, 9);
  H5Tclose(text);
  for (const hid_t attribute : {version, type, steps}) H5Aclose(attribute);
  H5Fclose(file);
}

TEST_F(Vtkhdf, HoldsTheFacesOnce) {
  EXPECT_THAT(values("NumberOfPoints"), ElementsAre(5));
  EXPECT_THAT(values("Polygons/NumberOfCells"), ElementsAre(2));
  EXPECT_THAT(values("Polygons/NumberOfConnectivityIds"), ElementsAre(7));
  EXPECT_THAT(values("Polygons/Offsets"), ElementsAre(0, 4, 7));
  EXPECT_THAT(values("Polygons/Connectivity"), ElementsAre(0, 1, 2, 3, 1, 4, 2));
  for (const std::string kind : {"Vertices", "Lines", "Strips"}) {
    EXPECT_THAT(values(kind + "/NumberOfCells"), ElementsAre(0));
    EXPECT_THAT(values(kind + "/NumberOfConnectivityIds"), ElementsAre(0));
    EXPECT_THAT(values(kind + "/Offsets"), ElementsAre(0));
    EXPECT_THAT(shape(kind + "/Connectivity"), ElementsAre(0));
  }
}

TEST_F(Vtkhdf, HoldsTheTimesAndWhereEachStepIs) {
  const Eigen::VectorXd& times = sequence_.frames->times();
  EXPECT_THAT(values("Steps/Values"), testing::ElementsAreArray(times.begin(), times.end()));
  EXPECT_THAT(values("Steps/PartOffsets"), testing::AllOf(SizeIs(9), Each(0)));
  EXPECT_THAT(values("Steps/NumberOfParts"), testing::AllOf(SizeIs(9), Each(1)));
  EXPECT_THAT(values("Steps/PointOffsets"), ElementsAre(0, 5, 10, 15, 20, 25, 30, 35, 40));
  for (const std::string name : {"Steps/CellOffsets", "Steps/ConnectivityIdOffsets"}) {
    EXPECT_THAT(shape(name), ElementsAre(9, 4));
    EXPECT_THAT(values(name), Each(0));
  }
}

TEST_F(Vtkhdf, HoldsThePositionsOfAllSteps) {
  EXPECT_THAT(shape("Points"), ElementsAre(45, 3));
  const auto points = values("Points");
  EXPECT_TRUE(std::equal(points.begin(), points.end(), sequence_.sequence().in_memory()->data()));
}

TEST_F(Vtkhdf, HoldsFieldsOnceAndDisplacementsForEachStep) {
  EXPECT_THAT(values("PointData/region"), ElementsAre(-1, 0, 1, 2, 3));
  // A polygon is what the largest of its triangles is.
  EXPECT_THAT(values("CellData/in_L"), ElementsAre(1, 0));
  EXPECT_THAT(values("Steps/PointDataOffsets/region"), testing::AllOf(SizeIs(9), Each(0)));
  EXPECT_THAT(values("Steps/CellDataOffsets/in_L"), testing::AllOf(SizeIs(9), Each(0)));
  EXPECT_THAT(shape("PointData/displacement"), ElementsAre(45, 3));
  EXPECT_THAT(shape("PointData/displacement_length"), ElementsAre(45));
  EXPECT_EQ(values("Steps/PointDataOffsets/displacement"), values("Steps/PointOffsets"));
  const auto lengths = values("PointData/displacement_length");
  EXPECT_THAT(std::vector(lengths.begin() + 15, lengths.begin() + 20), Each(0));
  const auto ways = values("PointData/displacement"), points = values("Points");
  for (std::size_t i = 0; i < ways.size(); ++i) {
    // Differences of numbers up to 1, rounded to single precision.
    EXPECT_NEAR(ways[i], points[i] - points[45 + i % 15], 2e-7);
  }
}

TEST_F(Vtkhdf, KeepsWholeNumbersThatAnIntDoesNotHold) {
  sequence_.fields = {{"id", Field::Location::vertices, Eigen::VectorXd::Constant(5, 5e9), true}};
  write_vtkhdf(sequence_, folder_ / "b.vtkhdf");
  EXPECT_THAT(library_values(folder_ / "b.vtkhdf", "VTKHDF/PointData/id"), Each(5e9));
}

TEST_F(Vtkhdf, IsTheSameBytesEveryTime) {
  write_vtkhdf(sequence_, folder_ / "b.vtkhdf", {}, Context().with_threads(1));
  EXPECT_TRUE(read_file(file_) == read_file(folder_ / "b.vtkhdf"));
}

TEST_F(Vtkhdf, RefusesFieldsThatDoNotFit) {
  FieldSequence twice = moving_quad();
  twice.fields[1] = twice.fields[0];
  EXPECT_THROW(write_vtkhdf(twice, folder_ / "b.vtkhdf"), std::invalid_argument);
  FieldSequence shorter = moving_quad();
  shorter.fields[0].values.conservativeResize(4, 1);
  EXPECT_THROW(write_vtkhdf(shorter, folder_ / "b.vtkhdf"), std::invalid_argument);
  EXPECT_THAT(folder_.names(), ElementsAre("a.vtkhdf"));
}

}  // namespace
}  // namespace mimetra
