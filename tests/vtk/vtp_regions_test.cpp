// Region sets in .vtp files, through the table of formats.

#include <gmock/gmock.h>

#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/vtk_formats.h"

namespace mimetra::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class VtpRegions : public VtpTest {
 protected:
  VtpRegions() { add_vtp(table_); }

  /// Writes regions as `--regions-out` does, and reads them as `--regions` does.
  Regions again(const Regions& regions) const {
    FieldSequence shown = mesh_;
    shown.fields = fields_of(regions);
    return read(shown);
  }
  Regions read(const FieldSequence& shown) const {
    const std::filesystem::path path = in_folder("r.vtp");
    write_vtp_series(shown, path, {.overwrite = true});
    const ReadOptions options{.vertices = mesh_.frames->vertices(),
                              .triangles = &mesh_.frames->triangles()};
    const ReadValue value = table_.reader(DataKind::regions, path).read(path, options, {});
    return std::get<RegionData>(value.value.data).regions;
  }

  OperationTable table_;
  FieldSequence mesh_ = quad_and_triangle();
};

TEST_F(VtpRegions, ComeBackWithTheWeightsOfTheirBorder) {
  Eigen::VectorXd weights(5);
  weights << 0, 0, 0.25, 0, 1;
  const Regions painted = painted_region(weights, mesh_.frames->triangles());
  const Regions read = again(painted);
  EXPECT_EQ(read.weights, weights);
  EXPECT_EQ(read.inside, painted.inside);
  EXPECT_EQ(read.triangles, painted.triangles);
}

TEST_F(VtpRegions, WithoutWeightsStayHard) {
  const Regions hard = regions_from_vertices(5, mesh_.frames->triangles(), {{3}});
  const Regions read = again(hard);
  EXPECT_EQ(read.weights.size(), 0);
  EXPECT_EQ(read.inside, hard.inside);
}

TEST_F(VtpRegions, AreRefusedWithOtherWeights) {
  const Regions hard = regions_from_vertices(5, mesh_.frames->triangles(), {{3}});
  FieldSequence shown = mesh_;
  shown.fields = fields_of(hard);
  shown.fields.push_back({"weight", Field::Location::vertices, Eigen::VectorXd::Constant(5, 50)});
  EXPECT_THAT([&] { read(shown); },
              ThrowsMessage<IoError>(HasSubstr(
                  "r.vtp: field 'weight': vertex 0 has the weight 50, expected 0 to 1; divide")));
  shown.fields.back().values = Eigen::MatrixXd::Ones(5, 3);
  EXPECT_THAT([&] { read(shown); },
              ThrowsMessage<MismatchError>(HasSubstr("holds 3 numbers for each vertex")));
}

}  // namespace
}  // namespace mimetra::test
