#include <gmock/gmock.h>

#include "tests/io/usd_fixture.h"

namespace mimetra {
namespace {

using test::corners;
using test::kTetrahedron;
using test::layer_of;
using test::on_joints;
using test::smile;
using test::smiling;
using test::UsdFiles;
using testing::AllOf;
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

/// `text` with `with` instead of the first `what`.
std::string changed(std::string text, const std::string& what, const std::string& with) {
  return text.replace(text.find(what), what.size(), with);
}

TEST_F(UsdFiles, AMeshWhoseSkeletonIsNotThereStandsByItsOwnTransformAndSaysSo) {
  const std::string named = "rel skel:skeleton = </face/bones>";
  const Positions own = corners().rowwise() + Eigen::RowVector3d(9, 9, 9);
  const auto starts_as = [&](const std::string& text) {
    return Positions(read(text).frame(0)) - smile() == own;
  };
  EXPECT_TRUE(starts_as(changed(on_joints(), named, "rel skel:skeleton = </face/none>")));
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("'mesh' has joints and there is no Skeleton "
                                            "</face/none>: its own transform places it")));
  EXPECT_TRUE(starts_as(changed(on_joints(), named, "")));
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("'mesh' has joints and names no skeleton: its own")));
}

TEST_F(UsdFiles, ARelativePathStartsFromThePrimThatHasIt) {
  const Positions expected = read(on_joints()).rest();
  const std::string named = "rel skel:skeleton = </face/bones>";
  EXPECT_EQ(read(changed(on_joints(), named, "rel skel:skeleton = <../bones>")).rest(), expected);
  const std::string above = changed(changed(on_joints(), named, ""), "def SkelRoot \"face\" {",
                                    "def SkelRoot \"face\" { rel skel:skeleton = <bones>\n");
  EXPECT_EQ(read(above).rest(), expected);
  const std::string source = "rel skel:animationSource = </face/bones/take>";
  EXPECT_EQ(read(changed(above, source, "rel skel:animationSource = <take>")).frame(0),
            expected + 2 * smile());
  EXPECT_THAT(error(changed(on_joints(), source, "rel skel:animationSource = <../../..>")),
              HasSubstr("there is no SkelAnimation <../../..>"));
}

/// Three joints, each 1 above the one before, as bound; at rest the last one is 4 to the side.
constexpr const char* kChain = R"(
    uniform token[] joints = ["root", "root/neck", "root/neck/jaw"]
    uniform matrix4d[] bindTransforms = [
      ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),
      ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 1, 0, 1)),
      ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 2, 0, 1))]
    uniform matrix4d[] restTransforms = [
      ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)),
      ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 1, 0, 1)),
      ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (4, 1, 0, 1))])";

TEST_F(UsdFiles, JointsThatHoldTheirVerticesElsewhereAreNamed) {
  const auto hanging = [&](const std::string& on) {
    return read(changed(on_joints(kChain), "jointIndices = [0, 0, 0, 0]", "jointIndices = " + on))
        .rest();
  };
  const Positions bound = hanging("[0, 0, 0, 0]");
  EXPECT_EQ(notes_.size(), 1U);
  EXPECT_EQ(hanging("[0, 1, 1, 0]"), bound);
  EXPECT_EQ(notes_.size(), 1U) << "the neck is where it was";
  EXPECT_EQ(hanging("[0, 1, 2, 0]"), bound);
  EXPECT_THAT(notes_, testing::Contains(AllOf(
                          HasSubstr("'mesh' stands as a whole where joint 'root' holds it at rest"),
                          HasSubstr("elsewhere: 'root/neck/jaw'"))));
  EXPECT_EQ(hanging("[2, 2, 2, 2]"), bound.rowwise() + Eigen::RowVector3d(4, 0, 0));
  EXPECT_EQ(notes_.size(), 1U) << "all of it is where its joint is";
}

TEST_F(UsdFiles, JointsAreThoseWithWeightsInTheOrderOfTheMesh) {
  const auto hanging = [&](const std::string& of_mesh) {
    return read(changed(on_joints(kChain), "int[] primvars:skel:jointIndices = [0, 0, 0, 0]",
                        of_mesh))
        .rest();
  };
  const Positions bound = read(on_joints(kChain)).rest();
  const Positions aside = bound.rowwise() + Eigen::RowVector3d(4, 0, 0);
  EXPECT_EQ(hanging("uniform token[] skel:joints = [\"root/neck/jaw\", \"root\"]\n"
                    "int[] primvars:skel:jointIndices = [0, 0, 0, 0]"),
            aside);
  EXPECT_EQ(hanging("int[] primvars:skel:jointIndices = [0, 2, 0, 2, 0, 2, 0, 2]\n"
                    "float[] primvars:skel:jointWeights = [0, 1, 0, 1, 0, 1, 0, 1]"),
            aside);
  EXPECT_EQ(notes_.size(), 1U);
  EXPECT_THAT(error(changed(on_joints(kChain), "jointIndices = [0, 0, 0, 0]",
                            "jointIndices = [0, 3, 0, 0]")),
              HasSubstr("joint 3 of 3, which count from 0"));
}

/// Points and a weight at every code: z of the last point is 1 + a hundredth of the code, and moved
/// by the weight, which is the same.
std::string sampled(int rate, int codes) {
  std::string points = "\n    point3f[] points.timeSamples = {\n", weights = ".timeSamples = {\n";
  for (int code = 0; code < codes; ++code) {
    const std::string share = std::to_string(0.01 * code);
    points += "      " + std::to_string(code) + ": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, " +
              std::to_string(1 + 0.01 * code) + ")],\n";
    weights += "      " + std::to_string(code) + ": [0, " + share + "],\n";
  }
  return changed(smiling(weights + "    }", points + "    }"), "timeCodesPerSecond = 10",
                 "timeCodesPerSecond = " + std::to_string(rate));
}

TEST_F(UsdFiles, PointsAndWeightsAtOneCodeAreOneFrame) {
  constexpr int kCodes = 400;
  for (const int rate : {24, 25, 30, 48, 50, 60, 120}) {
    const MeshSequence sequence = read(sampled(rate, kCodes));
    ASSERT_EQ(sequence.frames(), kCodes) << rate;
    for (int code = 0; code < kCodes; ++code) {
      ASSERT_EQ(sequence.times()[code], static_cast<double>(code) / rate);
      // The shape moves the last point by 1 along x.
      ASSERT_NEAR(sequence.frame(code)(3, 0), 0.01 * code, 1e-12) << rate;
      ASSERT_NEAR(sequence.frame(code)(3, 2), 1 + 0.01 * code, 1e-12) << rate;
    }
  }
}

TEST_F(UsdFiles, CodesOfATimeOfDayAreTimesOfTheirOwn) {
  for (const int rate : {24, 60}) {
    const int noon = 12 * 3600 * rate;
    std::string points, weights = ".timeSamples = { ";
    for (int code = noon; code < noon + 5; ++code) {
      points += std::to_string(code) + ": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],\n";
    }
    for (const int at : {0, 2, 4}) {
      weights += std::to_string(noon + at) + (at == 2 ? ": [0, 1], " : ": [0, 0], ");
    }
    const MeshSequence sequence = read(
        changed(smiling(weights + '}', "\n    point3f[] points.timeSamples = {" + points + "    }"),
                "timeCodesPerSecond = 10", "timeCodesPerSecond = " + std::to_string(rate)));
    ASSERT_EQ(sequence.frames(), 5);
    std::vector<double> moved;
    moved.reserve(5);
    for (int f = 0; f < 5; ++f) moved.push_back(sequence.frame(f)(3, 0));
    // Seconds since midnight in double precision leave a billionth of a frame.
    constexpr double kRounding = 1e-8;
    EXPECT_THAT(moved,
                testing::Pointwise(testing::DoubleNear(kRounding), {0.0, 0.5, 1.0, 0.5, 0.0}))
        << rate;
  }
}

TEST_F(UsdFiles, AnotherUnitThanMetresIsSaid) {
  const auto with_unit = [](const std::string& unit) {
    return changed(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) + "}"),
                   "timeCodesPerSecond = 10", "metersPerUnit = " + unit);
  };
  EXPECT_EQ(read(with_unit("0.01")).rest(), corners());
  EXPECT_THAT(notes_, ElementsAre(AllOf(HasSubstr("its unit is 0.01 m (metersPerUnit)"),
                                        HasSubstr("'scale' 0.01 makes metres"))));
  read(with_unit("1"));
  EXPECT_TRUE(notes_.empty());
  read(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) + "}"));
  EXPECT_TRUE(notes_.empty());
}

}  // namespace
}  // namespace mimetra
