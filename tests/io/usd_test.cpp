#include <cmath>
#include <cstdint>
#include <string_view>
#include <tuple>

#include <gmock/gmock.h>

#include "tests/io/changed_bytes.h"
#include "tests/io/usd_fixture.h"
#include "tests/shapes.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/unit_change.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace {

using test::corners;
using test::kTetrahedron;
using test::layer_of;
using test::message_of;
using test::smile;
using test::smiling;
using test::UsdFiles;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(UsdFiles, AMeshIsItsNeutralInOneFrame) {
  const MeshSequence sequence =
      read(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) + "}"));
  EXPECT_EQ(sequence.frames(), 1);
  EXPECT_EQ(sequence.rest(), corners());
  EXPECT_EQ(sequence.connectivity().polygons.size(), 4);
}

TEST_F(UsdFiles, BlendshapesAreDrivenByTheirAnimation) {
  const MeshSequence sequence =
      read(smiling(".timeSamples = { 0: [7, 0], 5: [7, 0.5], 20: [0, 1], }"));
  EXPECT_EQ(sequence.times(), Eigen::Vector3d(0, 0.5, 2));
  EXPECT_EQ(sequence.frame(1), corners() + 0.5 * smile());
  EXPECT_EQ(sequence.frame(2), corners() + smile());
  const BlendshapeModel model = read_blendshapes(file_.string());
  EXPECT_THAT(model.expressions().names, ElementsAre("smile"));
  EXPECT_EQ(model.pose(Eigen::VectorXd::Ones(1)), corners() + smile());
  EXPECT_EQ(read(smiling(" = [0, 0.25]")).frame(0), corners() + 0.25 * smile());
}

TEST_F(UsdFiles, PointsOverTimeAreFrames) {
  const std::string samples = R"(
    point3f[] points.timeSamples = {
      10: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 2)],
      0: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
    }
)";
  const MeshSequence sequence =
      read(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) + samples + "}"));
  EXPECT_EQ(sequence.times(), Eigen::Vector2d(0, 1));
  EXPECT_EQ(sequence.frame(0), corners());
  EXPECT_EQ(sequence.frame(1)(3, 2), 2);
  EXPECT_TRUE(sequence.rest_is_known());
  EXPECT_EQ(read(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) + samples + "}"),
                 {.frames = "1:"})
                .frame(0)(3, 2),
            2);
  std::string without_rest = kTetrahedron;
  without_rest.erase(without_rest.find("    point3f[] points"));
  const MeshSequence unknown = read(layer_of("def Mesh \"m\" {" + without_rest + samples + "}"));
  EXPECT_FALSE(unknown.rest_is_known());
  EXPECT_EQ(unknown.positions(), sequence.positions());
}

TEST_F(UsdFiles, WeightsAndPointsOverTimeAddUp) {
  const MeshSequence sequence = read(smiling(".timeSamples = { 0: [0, 0], 10: [0, 1] }", R"(
    point3f[] points.timeSamples = {
      0: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)],
      5: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 3)],
    })"));
  ASSERT_EQ(sequence.frames(), 3);
  Positions expected = corners() + 0.5 * smile();
  expected(3, 2) += 2;
  EXPECT_EQ(sequence.frame(1), expected);
}

TEST_F(UsdFiles, ATransformOverTimeMovesItsMeshes) {
  const MeshSequence sequence = read(layer_of(R"(def Xform "head" {
  double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 10: (0, 4, 0) }
  double3 xformOp:scale.timeSamples = { 0: (1, 1, 1), 5: (2, 2, 2) }
  uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
  def Mesh "m" {)" + std::string(kTetrahedron) +
                                              "}\n}\n"));
  ASSERT_EQ(sequence.frames(), 3);
  EXPECT_EQ(sequence.frame(1), (2 * corners()).rowwise() + Eigen::RowVector3d(0, 2, 0));
  EXPECT_EQ(sequence.frame(2), (2 * corners()).rowwise() + Eigen::RowVector3d(0, 4, 0));
}

/// What each kind of step does to the point (1, 0, 0), which is vertex 1.
TEST_F(UsdFiles, StepsOfATransformApplyFromTheLastOne) {
  const auto first = [&](const std::string& steps) -> Eigen::RowVector3d {
    return placed(steps).row(1);
  };
  constexpr double kRounding = 1e-15;
  EXPECT_EQ(
      first("float3 xformOp:scale = (2, 3, 4)\ndouble3 xformOp:translate:pivot = (5, 0, 0)\n"
            "uniform token[] xformOpOrder = [\"xformOp:translate:pivot\", \"xformOp:scale\"]"),
      Eigen::RowVector3d(7, 0, 0));
  EXPECT_EQ(first("double3 xformOp:translate = (5, 0, 0)\n"
                  "token[] xformOpOrder = [\"!invert!xformOp:translate\"]"),
            Eigen::RowVector3d(-4, 0, 0));
  EXPECT_EQ(first("double3 xformOp:translate = (5, 0, 0)"), Eigen::RowVector3d(1, 0, 0))
      << "what no order names does nothing";
  EXPECT_TRUE(first("float xformOp:rotateZ = 90\ntoken[] xformOpOrder = [\"xformOp:rotateZ\"]")
                  .isApprox(Eigen::RowVector3d(0, 1, 0), kRounding));
  // About z, which takes x to y, and then about x, which takes y to z.
  EXPECT_TRUE(first("float3 xformOp:rotateZXY = (90, 0, 90)\n"
                    "token[] xformOpOrder = [\"xformOp:rotateZXY\"]")
                  .isApprox(Eigen::RowVector3d(0, 0, 1), kRounding));
  EXPECT_TRUE(first("quatf xformOp:orient = (0.70710678118654757, 0, 0, 0.70710678118654757)\n"
                    "token[] xformOpOrder = [\"xformOp:orient\"]")
                  .isApprox(Eigen::RowVector3d(0, 1, 0), kRounding));
  EXPECT_EQ(first("matrix4d xformOp:transform = ((0, 2, 0, 0), (-1, 0, 0, 0), (0, 0, 1, 0), "
                  "(7, 8, 9, 1))\ntoken[] xformOpOrder = [\"xformOp:transform\"]"),
            Eigen::RowVector3d(7, 10, 9));
  EXPECT_THAT(error(layer_of("def Xform \"a\" {\nfloat3 xformOp:shear = (1, 0, 0)\n"
                             "token[] xformOpOrder = [\"xformOp:shear\"]\ndef Mesh \"m\" {" +
                             std::string(kTetrahedron) + "}\n}\n")),
              HasSubstr("line 6: 'xformOp:shear' is not read; use a matrix"));
  EXPECT_THAT(error(layer_of("def Xform \"a\" {\ndouble x = 1\ntoken[] xformOpOrder = [\"x\"]\n"
                             "def Mesh \"m\" {" +
                             std::string(kTetrahedron) + "}\n}\n")),
              HasSubstr("'x' is not read; use a matrix"));
}

TEST_F(UsdFiles, LeftHandedFacesAreTurned) {
  const MeshSequence sequence =
      read(layer_of("def Mesh \"m\" { uniform token orientation = \"leftHanded\"\n" +
                    std::string(kTetrahedron) + "}"));
  EXPECT_EQ(sequence.triangles().row(0), Eigen::RowVector3i(0, 1, 2));
}

TEST_F(UsdFiles, TextureCoordinatesAreOfPointsOrOfCorners) {
  const auto texture = [&](const std::string& st) {
    return read(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) + st + "}"))
        .connectivity()
        .texture;
  };
  const TextureCoordinates points = texture(
      "texCoord2f[] primvars:st = [(0, 0), (1, 0), (0, 1), (1, 1)] ( interpolation = \"vertex\" "
      ")\n");
  EXPECT_THAT(points.corners, ElementsAre(0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3));
  const TextureCoordinates corners = texture(
      "texCoord2f[] primvars:map1 = [(0, 0.5), (1, 0)] (\n interpolation = \"faceVarying\"\n)\n"
      "int[] primvars:map1:indices = [0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1, 1]\n");
  ASSERT_EQ(corners.corners.size(), 12U);
  EXPECT_EQ(corners.coordinates[0], Eigen::Vector2d(0, 0.5));
  EXPECT_EQ(corners.corners[3], 0);
}

TEST_F(UsdFiles, FacesThatAreHolesAreLeftOutWithTheirCorners) {
  const MeshSequence sequence = read(layer_of(
      "def Mesh \"m\" {" + std::string(kTetrahedron) +
      "texCoord2f[] primvars:st = [(0, 0), (1, 0)] (\n interpolation = \"faceVarying\"\n)\n"
      "int[] primvars:st:indices = [0, 0, 0, 1, 1, 1, 0, 0, 1, 0, 1, 0]\n"
      "int[] holeIndices = [2, 0]\n}"));
  const Connectivity& faces = sequence.connectivity();
  EXPECT_THAT(faces.polygons.corners, ElementsAre(0, 1, 3, 2, 0, 3));
  EXPECT_THAT(faces.polygons.offsets, ElementsAre(0, 3, 6));
  EXPECT_THAT(faces.texture.corners, ElementsAre(1, 1, 1, 0, 1, 0));
  EXPECT_EQ(sequence.vertices(), 4);
  EXPECT_THAT(error(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) +
                             "int[] holeIndices = [4]\n}")),
              HasSubstr("face 4 of 4 is no hole"));
}

TEST_F(UsdFiles, WhatIsNoMeshIsSaidToBeLeftOut) {
  const MeshSequence sequence = read(layer_of(R"(
class "pattern" { def Mesh "m" { } }
over "other" { def Mesh "m" { } }
def Sphere "ball" { double radius = 1 }
def Mesh "hidden" { token visibility = "invisible"
)" + std::string(kTetrahedron) + "}\ndef Mesh \"m\" {" +
                                              kTetrahedron + "}"));
  EXPECT_EQ(sequence.vertices(), 4);
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_THAT(notes_[0], HasSubstr("Mesh 'hidden', which is not shown, Sphere 'ball'"));
}

TEST_F(UsdFiles, WhatBringsInOtherLayersIsRefusedByNameAndLine) {
  const auto refused = [&](const std::string& settings, const std::string& body = "") {
    return error("#usda 1.0\ndef Xform \"a\" (\n" + settings + "\n) {\n" + body + "\n}\n");
  };
  const std::string remedy = " is not read; write the stage flattened";
  EXPECT_THAT(error("#usda 1.0\n(\n subLayers = [@a.usda@]\n)\n"),
              HasSubstr("line 3: 'subLayers'" + remedy));
  EXPECT_THAT(refused("prepend references = @a.usda@</x>"),
              HasSubstr("line 3: 'references'" + remedy));
  EXPECT_THAT(refused("payload = [@a.usd@]"), HasSubstr("line 3: 'payload'" + remedy));
  EXPECT_THAT(refused("inherits = </c>"), HasSubstr("'inherits'" + remedy));
  EXPECT_THAT(refused("specializes = </c>"), HasSubstr("'specializes'" + remedy));
  EXPECT_THAT(refused("instanceable = true"), HasSubstr("'instanceable'" + remedy));
  EXPECT_THAT(refused("clips = { dictionary default = { } }"), HasSubstr("'clips'" + remedy));
  EXPECT_THAT(refused("prepend variantSets = \"look\""), HasSubstr("'variantSets'" + remedy));
  EXPECT_THAT(refused("", "variantSet \"look\" = { \"a\" { } }"),
              HasSubstr("line 5: 'variantSet'" + remedy));
  EXPECT_THAT(refused("", "def PointInstancer \"p\" { }"), HasSubstr("instances are not read"));
}

TEST_F(UsdFiles, OtherKindsOfUsdAreRefusedByWhatTheyAre) {
  for (const auto& [name, start, what] :
       {std::tuple("b.usdc", "PXR-USDC", "is binary USD, which is not read; export .usda"),
        std::tuple("b.usd", "PXR-USDC", "is binary USD"),
        std::tuple("b.usdz", "PK\x03\x04", "is a package of USD")}) {
    write_bytes(folder_ / name, std::string(start) + std::string(100, '\0'));
    EXPECT_THAT(message_of<IoError>([&, path = folder_ / name] { open_sequence(path.string()); }),
                HasSubstr(what));
  }
  write_bytes(folder_ / "text.usd", layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) + "}"));
  EXPECT_EQ(read_sequence((folder_ / "text.usd").string()).sequence.vertices(), 4);
}

TEST_F(UsdFiles, OtherWritersLayersAreReadToo) {
  const std::string mesh = "def Mesh \"m\" {" + std::string(kTetrahedron) + R"(
    asset info:file = @@@./head@2x.png@@@
    normal3f[] normals.timeSamples = { 0: None, 1: [(0, 0, 1)] }
    bool glows.timeSamples = { 0: None }
  })";
  EXPECT_EQ(read("#usda 1.1\n" + mesh).rest(), corners());
  EXPECT_EQ(read("\xEF\xBB\xBF#usda 1.0\n" + mesh).rest(), corners());
  EXPECT_THAT(error("#usda 1.0\ndef A \"a\" {\n asset b = @@@no@end@@\n}"),
              HasSubstr("line 3: '@@@' has no end"));
}

TEST_F(UsdFiles, ASampleOfNothingIsRefusedWhereItIsNeeded) {
  EXPECT_THAT(error(smiling(".timeSamples = { 0: [0, 0],\n 5: None }")),
              HasSubstr("a time sample of nothing is not read"));
  EXPECT_THAT(error(layer_of("def Mesh \"m\" {" + std::string(kTetrahedron) +
                             "point3f[] points.timeSamples = { 0: None }\n}")),
              HasSubstr("line 9: a time sample of nothing is not read"));
}

TEST_F(UsdFiles, WhatCannotBeIsNamedWithItsLine) {
  const auto mesh = [&](const std::string& body) {
    return error("#usda 1.0\ndef Mesh \"m\" {\n" + body + "\n}\n");
  };
  EXPECT_THAT(error("solid stl"), HasSubstr("line 1: expected '#usda 1.0'"));
  EXPECT_THAT(error("#usda 1.0\n"), HasSubstr("holds no mesh"));
  EXPECT_THAT(mesh("int[] faceVertexCounts = [3]"), HasSubstr("line 2: Mesh 'm' has no points"));
  EXPECT_THAT(mesh("point3f[] points = [(0, 0, 0), (1, 0)]"),
              HasSubstr("line 3: 5 numbers, expected x, y and z of each point"));
  EXPECT_THAT(mesh("point3f[] points = [(0, 0, 0)]\nint[] faceVertexCounts = [3]\n"
                   "int[] faceVertexIndices = [0, 0, 1]"),
              HasSubstr("line 5: a face uses point 1 of 1"));
  EXPECT_THAT(mesh("point3f[] points = [(0, 0, 0)]\nint[] faceVertexCounts = [2147483647, 9]\n"
                   "int[] faceVertexIndices = [0, 0, 0]"),
              HasSubstr("line 4: the faces have other corners than the 3"));
  EXPECT_THAT(mesh("point3f[] points = [(0, 0, 0)]\nint[] faceVertexCounts = [3.5]\n"
                   "int[] faceVertexIndices = [0, 0, 0]"),
              HasSubstr("3.5 is no count"));
  EXPECT_THAT(mesh("point3f[] points = [(0, 0, 0), (1, -inf, 0)]\nint[] faceVertexCounts = [3]"),
              HasSubstr("line 3: holds a number that is not finite"));
  EXPECT_THAT(mesh("int[] a = [1, 2"), HasSubstr("line 4: expected ',' or ']', found '}'"));
  EXPECT_THAT(mesh("string a = \"no end"), HasSubstr("line 3: text in quotes has no end"));
  EXPECT_THAT(mesh("rel a = </no"), HasSubstr("line 3: '<' has no end"));
  EXPECT_THAT(error(smiling(".timeSamples = { 0: [1], 5: [1] }")),
              HasSubstr("1 weights for 2 blendshapes"));
  EXPECT_THAT(error(smiling(".timeSamples = { 5: [1, 1], 5: [1, 1] }")),
              HasSubstr("two time samples at 5"));
  EXPECT_THAT(error(smiling(" = [0, 0]", "rel skel:animationSource = </nowhere>")),
              HasSubstr("there is no SkelAnimation </nowhere>"));
}

TEST_F(UsdFiles, ShapesInBetweenAreRefused) {
  std::string text = smiling(" = [0, 0]");
  const std::string indices = "uniform int[] pointIndices = [1, 3]";
  text.insert(text.find(indices), "uniform vector3f[] inbetweens:half = [(0, 0, 1)]\n");
  EXPECT_THAT(error(text), HasSubstr("'inbetweens:half': shapes in between are not read"));
}

TEST_F(UsdFiles, NestingHasAnEnd) {
  std::string prims = "#usda 1.0\n", lists = "#usda 1.0\ndef A \"a\" { int[] b = ";
  for (int i = 0; i < 100000; ++i) prims += "def A \"a\" {";
  EXPECT_THAT(error(prims), HasSubstr("prims nest deeper than 100 levels"));
  EXPECT_THAT(error(lists + std::string(100000, '[')), HasSubstr("nested deeper than 16 levels"));
}

TEST_F(UsdFiles, EveryTruncatedPrefixIsAnError) {
  const std::string whole = smiling(".timeSamples = { 0: [0, 0], 5: [0, 1] }");
  // The last line break may be missing.
  for (std::size_t bytes = 0; bytes + 1 < whole.size(); ++bytes) {
    EXPECT_THAT(error(whole.substr(0, bytes)), HasSubstr("a.usda")) << bytes;
  }
}

TEST_F(UsdFiles, NoChangedByteDoesHarm) {
  test::expect_harmless_changes(smiling(".timeSamples = { 0: [0, 0], 5: [0, 1] }"), file_);
}

MeshSequence turning_grid(int frames) {
  const test::Shape grid = test::grid(3, 3);
  Polygons polygons{{0, 1, 4, 3, 1, 2, 5, 4, 3, 4, 7, 6, 4, 5, 8}, {0, 4, 8, 12, 15}};
  Connectivity faces = Connectivity::from_polygons(9, polygons);
  for (int i = 0; i < 15; ++i) faces.texture.coordinates.emplace_back(0.0625 * i, 0.5);
  for (int i = 0; i < 15; ++i) faces.texture.corners.push_back(14 - i);
  Frames poses(frames, 27);
  for (int f = 0; f < frames; ++f) {
    Positions pose = grid.positions;
    for (int v = 0; v < 9; ++v) pose(v, 2) = std::sin(0.1 * f + v);
    poses.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return {std::move(faces), std::move(poses)};
}

/// Of single precision, of positions about 2.
constexpr double kRounded = 2e-7;

TEST_F(UsdFiles, PosesComeBack) {
  const MeshSequence given = turning_grid(500);
  write_sequence(given, file_);
  const MeshSequence found = read_sequence(file_.string()).sequence;
  EXPECT_LT((found.positions() - given.positions()).cwiseAbs().maxCoeff(), kRounded);
  EXPECT_EQ(found.times(), given.times());
  EXPECT_FALSE(found.rest_is_known());
  EXPECT_TRUE(same_faces(found.connectivity(), given.connectivity()));
  EXPECT_EQ(found.connectivity().texture.corners, given.connectivity().texture.corners);
  EXPECT_EQ(found.connectivity().texture.coordinates, given.connectivity().texture.coordinates);

  const Positions rest = test::grid(3, 3).positions;
  const Eigen::VectorXd uneven = given.times().array().square() + 0.3;
  write_sequence(MeshSequence(given.connectivity(), given.positions(), uneven, rest), file_,
                 {.overwrite = true});
  const MeshSequence rested = read_sequence(file_.string()).sequence;
  EXPECT_EQ(rested.rest(), rest);
  EXPECT_TRUE(rested.rest_is_known());
  EXPECT_TRUE(rested.times().isApprox(uneven, 1e-15));
}

TEST_F(UsdFiles, AModelAndItsWeightsComeBackAsSuch) {
  const MeshSequence grid = turning_grid(1);
  ShapeBasis basis{{"smi\"le", "blink"}, Eigen::MatrixXd::Zero(27, 2)};
  basis.displacements.col(0) = Eigen::VectorXd::LinSpaced(27, -0.1, 0.2);
  basis.displacements(7, 1) = 0.3;
  const auto model = std::make_shared<const BlendshapeModel>(grid.shared_connectivity(),
                                                             Positions(grid.frame(0)), basis);
  Eigen::MatrixXd weights(3, 2);
  weights << 0, 0, 0.3, 0, 1, 0.7;
  const Animation given(model, weights, Eigen::Vector3d(0.25, 0.75, 2));
  write_sequence(given, file_);
  const OpenSequence open = open_sequence(file_.string());
  const auto& found = dynamic_cast<const Animation&>(*open.frames);
  EXPECT_EQ(found.model().expressions().names, basis.names);
  EXPECT_LT((found.model().expressions().displacements - basis.displacements).cwiseAbs().maxCoeff(),
            kRounded);
  EXPECT_LT((found.weights() - weights).cwiseAbs().maxCoeff(), kRounded);
  EXPECT_EQ(found.times(), given.times());
  EXPECT_LT((found.read(0, 3) - given.read(0, 3)).cwiseAbs().maxCoeff(), kRounded);
}

TEST_F(UsdFiles, WhatIsUpIsSaid) {
  for (const bool turned : {false, true}) {
    const auto grid = std::make_shared<const MeshSequence>(turning_grid(2));
    const UpTurn up = turned ? UpTurn::y_to_z : UpTurn::keep;
    write_sequence(*with_units(grid, {.up = up}), file_, {.overwrite = true});
    EXPECT_THAT(read_file(file_), HasSubstr(turned ? "upAxis = \"Z\"" : "upAxis = \"Y\""));
    const std::vector<std::string> notes = open_sequence(file_.string()).notes;
    if (turned) {
      EXPECT_THAT(notes, ElementsAre(HasSubstr("its up axis is z; convert with option 'up'")));
    } else {
      EXPECT_TRUE(notes.empty());
    }
  }
}

TEST_F(UsdFiles, ZStaysUpWhenAFileIsWrittenAgain) {
  const auto grid = std::make_shared<const MeshSequence>(turning_grid(2));
  ShapeBasis basis{{"smile"}, Eigen::MatrixXd::Constant(27, 1, 0.1)};
  const auto model = std::make_shared<const BlendshapeModel>(grid->shared_connectivity(),
                                                             Positions(grid->frame(0)), basis);
  const auto driven = std::make_shared<const Animation>(model, Eigen::MatrixXd::Ones(2, 1));
  for (const std::shared_ptr<const FrameSource>& given :
       {std::shared_ptr<const FrameSource>(grid), std::shared_ptr<const FrameSource>(driven)}) {
    write_sequence(*in_units(given, {.up = UpTurn::y_to_z}), file_, {.overwrite = true});
    const auto read = open_sequence(file_.string()).frames;
    const fs::path again = file_.parent_path() / "again.usda";
    write_sequence(*read, again, {.overwrite = true});
    EXPECT_THAT(read_file(again), HasSubstr("upAxis = \"Z\""));
    EXPECT_EQ(read->read(0, 2), open_sequence(again.string()).frames->read(0, 2));
    EXPECT_EQ(dynamic_cast<const Animation*>(read.get()) != nullptr, given == driven);
  }
}

TEST_F(UsdFiles, PosesFarFromTheOriginAreRefused) {
  const MeshSequence near = turning_grid(2);
  const Frames far = near.positions().array() + 1e6;
  EXPECT_THAT(message_of<MismatchError>(
                  [&] { write_sequence(MeshSequence(near.connectivity(), far), file_); }),
              HasSubstr("holds single precision only"));
  EXPECT_TRUE(folder_.names().empty());
}

}  // namespace
}  // namespace mimetra
