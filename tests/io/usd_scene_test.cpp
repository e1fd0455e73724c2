#include <gmock/gmock.h>

#include "tests/io/usd_fixture.h"

namespace mimetra {
namespace {

using test::corners;
using test::on_joints;
using test::smile;
using test::UsdFiles;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(UsdFiles, AMeshOnJointsStandsWhereTheyHoldIt) {
  const MeshSequence sequence = read(on_joints());
  const Positions rest = (2 * corners()).rowwise() + Eigen::RowVector3d(0, 1, 3);
  EXPECT_EQ(sequence.rest(), rest);
  ASSERT_EQ(sequence.frames(), 1);
  EXPECT_EQ(sequence.frame(0), rest + 2 * smile());
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("the skeleton of 'mesh': it stands as it is bound")));
  // Bound in the world, where the skeleton stands now.
  const std::string joints = R"(
    uniform matrix4d[] bindTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 5, 3, 1))]
    uniform matrix4d[] restTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 5, 0, 1))])";
  EXPECT_EQ(read(on_joints(joints)).rest(), rest.rowwise() - Eigen::RowVector3d(0, 0, 3));
}

TEST_F(UsdFiles, MatricesOfABindingHaveToBeSome) {
  std::string text = on_joints();
  const std::string matrix = "(0, 1, 0, 1))";
  text.replace(text.find(matrix), matrix.size(), "(0, 1, 0))");
  EXPECT_THAT(error(text), HasSubstr("15 numbers, expected 16 of each matrix"));
  EXPECT_THAT(error(on_joints("matrix4d[] restTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), "
                              "(0, 0, 1, 0), (0, 0, 0, 1))]\nmatrix4d[] bindTransforms = "
                              "[((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 0), (0, 0, 0, 1))]\n")),
              HasSubstr("the first of bindTransforms has no inverse"));
}

}  // namespace
}  // namespace mimetra
