#include <cmath>
#include <cstdint>

#include <gmock/gmock.h>
#include <Eigen/LU>
#include <Eigen/QR>

#include "tests/io/gltf_fixture.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "toolkit/formats/gltf/gltf_document.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace {

using test::eight;
using test::GltfBuilder;
using test::GltfFiles;
using test::GltfJson;
using test::message_of;
using test::moved;
using test::quarters;
using test::two_nodes;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(GltfFiles, AModelIsANeutralAndItsTargetsAndASequenceTheNeutral) {
  const BlendshapeModel face = model(plain().glb());
  EXPECT_EQ(face.neutral(), quarters());
  EXPECT_EQ(face.triangles(), eight());
  EXPECT_THAT(face.expressions().names, ElementsAre("smile"));
  EXPECT_EQ(face.pose(Eigen::VectorXd::Ones(1)), quarters() + moved());
  const MeshSequence sequence = read(plain().glb());
  EXPECT_EQ(sequence.frames(), 1);
  EXPECT_EQ(sequence.rest(), quarters());
  EXPECT_TRUE(sequence.rest_is_known());
}

TEST_F(GltfFiles, WhoseMeshesNoNodeShowsSaySo) {
  GltfBuilder gltf = plain();
  for (auto& node : gltf.root["nodes"]) node.erase("mesh");
  EXPECT_THAT(error(gltf.glb()), HasSubstr("has meshes, and no node of its scene shows one"));
}

TEST_F(GltfFiles, FramesAreAtTheKeysOfTheWeights) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0.5, 0.75, 2}, {0, 1, 0.25});
  const MeshSequence sequence = read(gltf.glb());
  ASSERT_EQ(sequence.frames(), 3);
  EXPECT_EQ(sequence.times(), Eigen::Vector3d(0.5, 0.75, 2));
  EXPECT_EQ(sequence.frame(0), quarters());
  EXPECT_EQ(sequence.frame(1), quarters() + moved());
  EXPECT_EQ(sequence.frame(2), quarters() + 0.25 * moved());
  EXPECT_EQ(read(gltf.glb(), {.frames = "1:2"}).frame(0), quarters() + moved());
}

TEST_F(GltfFiles, OtherWeightsDriveTheModelInstead) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1, 2}, {0, 1, 0});
  write_bytes(folder_ / "w.csv", "time,smile\n3,0.5\n");
  const MeshSequence sequence = read(gltf.glb(), {.weights = folder_ / "w.csv"});
  ASSERT_EQ(sequence.frames(), 1);
  EXPECT_EQ(sequence.times()[0], 3);
  EXPECT_EQ(sequence.frame(0), quarters() + 0.5 * moved());
}

TEST_F(GltfFiles, SplinesAreShownBetweenTheirKeys) {
  // The spline of w(t) = t^3 through 0 and 2, whose slopes are 3 t^2; and keys as close as frames.
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 2, 2 + 1.f / 30}, {0, 0, 0, 12, 8, 0, 0, 8, 0}, "CUBICSPLINE");
  const MeshSequence sequence = read(gltf.glb());
  ASSERT_EQ(sequence.frames(), 62);
  for (int f = 0; f <= 60; ++f) {
    const double time = f / 30.;
    ASSERT_NEAR(sequence.times()[f], time, 1e-12);
    ASSERT_LT((sequence.frame(f) - quarters() - std::pow(time, 3) * moved()).cwiseAbs().maxCoeff(),
              1e-5)
        << "frame " << f;
  }
}

TEST_F(GltfFiles, SplinesThatLastForDaysAreRefused) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1e6}, {0, 0, 0, 0, 1, 0}, "CUBICSPLINE");
  EXPECT_THAT(error(gltf.glb()), HasSubstr("on splines lasts 1000000 s"));
}

TEST_F(GltfFiles, SparseTargetsArePlainOnes) {
  GltfBuilder gltf;
  const int faces = gltf.faces(eight()), points = gltf.points(quarters());
  const int places = gltf.view(GltfBuilder::bytes_of(std::vector<std::uint16_t>{1, 4}));
  const int values =
      gltf.view(GltfBuilder::bytes_of(GltfBuilder::floats(moved()(std::vector{1, 4}, Eigen::all))));
  const int target =
      gltf.accessor({{"componentType", 5126},
                     {"count", 6},
                     {"type", "VEC3"},
                     {"sparse",
                      {{"count", 2},
                       {"indices", {{"bufferView", places}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}}}});
  gltf.primitive(points, faces)["targets"] = {{{"POSITION", target}}};
  gltf.root["meshes"][0]["extras"] = {{"targetNames", {"smile"}}};
  expect_plain(gltf.glb());
}

/// Coordinates as multiples of a quarter, with a fourth number that fills the stride.
std::vector<std::int16_t> quantised(const Positions& points) {
  std::vector<std::int16_t> all;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    for (int c = 0; c < 3; ++c) all.push_back(static_cast<std::int16_t>(4 * points(i, c)));
    all.push_back(77);
  }
  return all;
}

TEST_F(GltfFiles, QuantisedPositionsArePlainOnesWhereTheirNodeScalesThem) {
  GltfBuilder gltf;
  const int faces = gltf.faces(eight());
  const int points =
      gltf.accessor(gltf.view(GltfBuilder::bytes_of(quantised(quarters())), 8), 5122, 6, "VEC3");
  const int target =
      gltf.accessor(gltf.view(GltfBuilder::bytes_of(quantised(moved())), 8), 5122, 6, "VEC3");
  gltf.primitive(points, faces)["targets"] = {{{"POSITION", target}}};
  gltf.root["meshes"][0]["extras"] = {{"targetNames", {"smile"}}};
  gltf.root["nodes"][0]["scale"] = {0.25, 0.25, 0.25};
  gltf.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  expect_plain(gltf.glb());
}

TEST_F(GltfFiles, NormalisedIntegersAreSharesOfTheLargestOne) {
  GltfBuilder gltf;
  std::vector<std::int8_t> bytes;
  const Positions wanted = quarters();
  for (const double value : wanted.reshaped<Eigen::RowMajor>()) {
    bytes.push_back(static_cast<std::int8_t>(value < 0 ? -128 : 127 * value));
  }
  GltfJson points = {{"bufferView", gltf.view(GltfBuilder::bytes_of(bytes))},
                     {"componentType", 5120},
                     {"count", 6},
                     {"type", "VEC3"},
                     {"normalized", true}};
  gltf.primitive(gltf.accessor(points), gltf.faces(eight()));
  EXPECT_EQ(model(gltf.glb()).neutral(), quarters());
}

TEST_F(GltfFiles, InterleavedViewsArePlainOnes) {
  GltfBuilder gltf;
  std::vector<float> both;
  for (int v = 0; v < 6; ++v) {
    for (int c = 0; c < 3; ++c) both.push_back(static_cast<float>(quarters()(v, c)));
    for (int c = 0; c < 3; ++c) both.push_back(static_cast<float>(moved()(v, c)));
  }
  const int view = gltf.view(GltfBuilder::bytes_of(both), 24);
  const auto part = [&](int offset) {
    return gltf.accessor({{"bufferView", view},
                          {"byteOffset", offset},
                          {"componentType", 5126},
                          {"count", 6},
                          {"type", "VEC3"}});
  };
  const int points = part(0), target = part(12);
  gltf.primitive(points, gltf.faces(eight()))["targets"] = {{{"POSITION", target}}};
  gltf.root["meshes"][0]["extras"] = {{"targetNames", {"smile"}}};
  expect_plain(gltf.glb());
}

TEST_F(GltfFiles, PrimitivesOnTheSameVerticesAreOneMesh) {
  GltfBuilder gltf;
  const int points = gltf.points(quarters()), target = gltf.points(moved());
  const int upper = gltf.faces(eight().topRows(4)), lower = gltf.faces(eight().bottomRows(4));
  gltf.root["materials"] = {{{"name", "skin"}}, {{"name", "lips"}}};
  for (const auto& [faces, material] : {std::pair(upper, 0), std::pair(lower, 1)}) {
    GltfJson& primitive = gltf.primitive(points, faces);
    primitive["targets"] = {{{"POSITION", target}}};
    primitive["material"] = material;
  }
  gltf.root["meshes"][0]["extras"] = {{"targetNames", {"smile"}}};
  expect_plain(gltf.glb());
  const std::vector<FaceGroup> groups = model(gltf.glb()).connectivity().groups;
  ASSERT_EQ(groups.size(), 2U);
  EXPECT_EQ(groups[1].statement, "usemtl lips");
  EXPECT_EQ(groups[1].first_face, 4);
}

TEST_F(GltfFiles, StripsAndFansAreTriangles) {
  for (const auto& [mode, expected] :
       {std::pair(5, std::vector{0, 1, 2, 1, 3, 2}), std::pair(6, std::vector{1, 2, 0, 2, 3, 0})}) {
    GltfBuilder gltf;
    const int four = gltf.accessor(
        gltf.view(GltfBuilder::bytes_of(std::vector<std::uint8_t>{0, 1, 2, 3})), 5121, 4, "SCALAR");
    gltf.primitive(gltf.points(quarters()), four)["mode"] = mode;
    const Triangles triangles = model(gltf.glb()).triangles();
    EXPECT_EQ(std::vector<int>(triangles.data(), triangles.data() + triangles.size()), expected);
  }
}

TEST_F(GltfFiles, VerticesWithoutIndicesAreTrianglesInTurn) {
  GltfBuilder gltf;
  gltf.primitive(gltf.points(quarters()), 0).erase("indices");
  EXPECT_EQ(model(gltf.glb()).triangles(), (Triangles(2, 3) << 0, 1, 2, 3, 4, 5).finished());
}

TEST_F(GltfFiles, ColoursAndFurtherTexturesAreSaidToBeLeftOut) {
  GltfBuilder gltf;
  const int colours = gltf.points(quarters());
  GltfJson& attributes = gltf.primitive(gltf.points(quarters()), gltf.faces(eight()))["attributes"];
  attributes["COLOR_0"] = colours;
  read(gltf.glb());
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("are left out: COLOR_0")));
}

TEST_F(GltfFiles, NodesAreJoinedWhereTheyStand) {
  const BlendshapeModel face = model(two_nodes(plain()).glb());
  ASSERT_EQ(face.vertices(), 12);
  const Positions second = (2 * quarters()).rowwise() + Eigen::RowVector3d(10, 0, 0);
  EXPECT_EQ(face.neutral().topRows(6), quarters());
  EXPECT_EQ(face.neutral().bottomRows(6), second);
  EXPECT_EQ(face.triangles().bottomRows(8), (eight().array() + 6).matrix());
  EXPECT_THAT(face.expressions().names, ElementsAre("smile"));
  EXPECT_EQ(face.pose(Eigen::VectorXd::Ones(1)).bottomRows(6), second + 2 * moved());
  EXPECT_EQ(face.connectivity().groups[1].statement, "g big");
}

TEST_F(GltfFiles, AMirroredNodeTurnsItsFaces) {
  GltfBuilder gltf = plain();
  gltf.root["nodes"][0]["scale"] = {-1, 1, 1};
  EXPECT_EQ(model(gltf.glb()).triangles().row(0), Eigen::RowVector3i(0, 4, 2));
}

TEST_F(GltfFiles, MovementOfNodesIsSaidToBeLeftOut) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 1}, {0, 0});
  gltf.root["animations"][0]["channels"][0]["target"] = {{"node", 1}, {"path", "rotation"}};
  read(gltf.glb());
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_THAT(notes_[0], HasSubstr("the movement of nodes is left out"));
  EXPECT_THAT(notes_[0], HasSubstr("'big'"));
}

/// The first three vertices on joint 0, 1 higher; the others on joint 1, which `scale` makes
/// larger.
GltfBuilder skinned(GltfBuilder gltf, const GltfJson& scale) {
  const int joints = gltf.accessor(
      gltf.view(std::string(12, '\0') + GltfBuilder::bytes_of(std::vector<std::uint32_t>{1, 1, 1})),
      5121, 6, "VEC4");
  std::vector<float> weights;
  for (int v = 0; v < 6; ++v) weights.insert(weights.end(), {1, 0, 0, 0});
  auto& attributes = gltf.root["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = joints;
  attributes["WEIGHTS_0"] =
      gltf.accessor(gltf.view(GltfBuilder::bytes_of(weights)), 5126, 6, "VEC4");
  gltf.root["skins"] = {{{"joints", {1, 2}}}};
  gltf.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {9, 9, 9}}},
                        {{"translation", {0, 1, 0}}, {"children", {2}}},
                        {{"scale", scale}}};
  gltf.root["scenes"][0]["nodes"] = {0, 1};
  return gltf;
}

TEST_F(GltfFiles, ASkinHoldsItsVerticesWhereItsJointsStand) {
  const BlendshapeModel face = model(skinned(plain(), {2, 2, 2}).glb());
  const Eigen::RowVector3d up(0, 1, 0);
  EXPECT_EQ(face.neutral().topRows(3), quarters().topRows(3).rowwise() + up);
  EXPECT_EQ(face.neutral().bottomRows(3), (2 * quarters().bottomRows(3)).rowwise() + up);
  EXPECT_EQ(face.expressions().displacements(3 * 4 + 1, 0), 2);
}

TEST_F(GltfFiles, AVertexOnAJointThatItsSkinDoesNotHaveIsAnError) {
  GltfBuilder gltf = skinned(plain(), {2, 2, 2});
  gltf.root["skins"][0]["joints"] = {1};
  EXPECT_THAT(error(gltf.glb()), HasSubstr("vertex 3 hangs on joint 1 of 1, which count from 0"));
}

TEST_F(GltfFiles, AMirroredJointTurnsTheFacesThatItHolds) {
  const int both = 2;
  for (int primitives = 1; primitives <= both; ++primitives) {
    GltfBuilder gltf = skinned(plain(), {-1, 1, 1});
    GltfJson& list = gltf.root["meshes"][0]["primitives"];
    list[0]["indices"] = gltf.faces((Triangles(2, 3) << 0, 1, 2, 3, 4, 5).finished());
    if (primitives == both) list.push_back(list[0]);  // on the same vertices
    const Triangles triangles = model(gltf.glb()).triangles();
    ASSERT_EQ(triangles.rows(), 2 * primitives);
    for (int t = 0; t < triangles.rows(); t += 2) {
      EXPECT_EQ(triangles.row(t), Eigen::RowVector3i(0, 1, 2));
      EXPECT_EQ(triangles.row(t + 1), Eigen::RowVector3i(3, 5, 4));
    }
  }
}

TEST_F(GltfFiles, PointsAndLinesAreSaidToBeLeftOut) {
  GltfBuilder gltf = plain();
  gltf.primitive(0, 1)["mode"] = 1;
  EXPECT_EQ(read(gltf.glb()).vertices(), 6);
  EXPECT_THAT(notes_, ElementsAre(HasSubstr("primitives that are no triangles are left out")));
  gltf.root["meshes"][0]["primitives"].erase(0);
  EXPECT_THAT(error(gltf.glb()), HasSubstr("holds no mesh of triangles"));
}

TEST_F(GltfFiles, BuffersStandInTheFileOrBesideIt) {
  GltfBuilder gltf = plain();
  const BlendshapeModel expected = model(gltf.glb());
  gltf.root["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "my%20data.bin"}}};
  write_bytes(folder_ / "my data.bin", gltf.binary);
  write_bytes(folder_ / "b.gltf", gltf.root.dump());
  EXPECT_EQ(read_blendshapes((folder_ / "b.gltf").string()).neutral(), expected.neutral());
  EXPECT_EQ(open_sequence((folder_ / "b.gltf").string()).files.back(), folder_ / "my data.bin");

  // "abcd" and so on: RFC 4648's test of every length.
  GltfBuilder small;
  small.root["buffers"] = {
      {{"byteLength", 6}, {"uri", "data:application/octet-stream;base64,Zm9vYmFy"}}};
  write_bytes(folder_ / "c.gltf", small.root.dump());
  EXPECT_EQ(read_gltf_document(folder_ / "c.gltf").buffers.front().bytes, "foobar");
}

TEST_F(GltfFiles, DataMayBeWrittenAsAnyUriMay) {
  for (const std::string uri :
       {"data:application/gltf-buffer;BASE64,Zm9vYmE=", "data:;base64,Zm9vYmE%3D",
        "data:application/octet-stream;base64,%5am9vYmE%3d"}) {
    GltfBuilder gltf;
    gltf.root["buffers"] = {{{"byteLength", 5}, {"uri", uri}}};
    write_bytes(folder_ / "c.gltf", gltf.root.dump());
    EXPECT_EQ(read_gltf_document(folder_ / "c.gltf").buffers.front().bytes, "fooba") << uri;
  }
}

TEST_F(GltfFiles, NamesThatAreNoneAreNotThere) {
  for (const GltfJson& names : {GltfJson(), GltfJson("smile"), GltfJson({{"a", 1}}),
                                GltfJson::array({nullptr}), GltfJson::array({7})}) {
    GltfBuilder gltf = plain();
    gltf.root["meshes"][0]["extras"]["targetNames"] = names;
    EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("target_000")) << names;
  }
}

TEST_F(GltfFiles, AnAvatarIsGltf) {
  file_ = folder_ / "avatar.VRM";
  expect_plain(plain().glb());
}

TEST_F(GltfFiles, AnotherNamesBytesAreKnownForGltf) {
  file_ = folder_ / "avatar.pkg";
  EXPECT_THAT(
      error(plain().glb()),
      HasSubstr("avatar.pkg: is glTF by its first bytes; give it a name that ends in .glb"));
  EXPECT_THAT(error("gl"), HasSubstr("avatar.pkg: is no sequence"));
}

TEST_F(GltfFiles, NothingOutsideItsOwnFolderIsRead) {
  write_bytes(folder_ / "secret.bin", std::string(1000, 'x'));
  std::filesystem::create_directory(folder_ / "inside");
  file_ = folder_ / "inside" / "a.gltf";
  std::filesystem::create_symlink("../secret.bin", folder_ / "inside" / "link.bin");
  for (const std::string uri : {"../secret.bin", "/etc/passwd", "http://localhost/a.bin",
                                "file:///etc/passwd", "%2e%2e/secret.bin", "link.bin", ""}) {
    GltfBuilder gltf = plain();
    gltf.root["buffers"] = {{{"byteLength", 10}, {"uri", uri}}};
    EXPECT_THAT(error(gltf.root.dump()), HasSubstr("is not in its own folder")) << uri;
  }
  GltfBuilder gltf = plain();
  gltf.root["buffers"] = {{{"byteLength", 10}, {"uri", "none.bin"}}};
  EXPECT_THAT(error(gltf.root.dump()), HasSubstr("its buffer 'none.bin' is not there"));
}

TEST_F(GltfFiles, LinksLeadToTheFolderThatHoldsWhatTheFileItselfLinksTo) {
  GltfBuilder gltf = plain();
  gltf.root["buffers"] = {{{"byteLength", gltf.binary.size()}, {"uri", "a.bin"}}};
  std::filesystem::create_directories(folder_ / "store");
  std::filesystem::create_directories(folder_ / "shown");
  write_bytes(folder_ / "store/1", gltf.root.dump());
  write_bytes(folder_ / "store/2", gltf.binary);
  std::filesystem::create_symlink("../store/1", folder_ / "shown/a.gltf");
  std::filesystem::create_symlink("../store/2", folder_ / "shown/a.bin");
  EXPECT_EQ(read_blendshapes((folder_ / "shown/a.gltf").string()).neutral(), quarters());
}

TEST_F(GltfFiles, BuffersThatNoMeshNeedsMayBeMissing) {
  GltfBuilder gltf = plain();
  gltf.root["buffers"] = {{{"byteLength", gltf.binary.size()}},
                          {{"byteLength", 10}, {"uri", "pictures.bin"}}};
  gltf.root["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 10}});
  expect_plain(gltf.glb());
  gltf.root["bufferViews"][0]["buffer"] = 1;
  EXPECT_THAT(error(gltf.glb()), HasSubstr("its buffer 'pictures.bin' is not there"));
}

/// Vertices `v` of an OBJ file.
Positions obj_points(const std::filesystem::path& path) {
  return read_mesh(path).positions;
}

TEST(Facecap, TheCompressedHeadIsItsDecodedFiles) {
  const auto data = test::shared_path("data/facecap");
  MIMETRA_SKIP_WITHOUT(data / "facecap.glb");
  const BlendshapeModel all = read_blendshapes((data / "facecap.glb").string());
  const WeightTrack track = read_weights(data / "weights.csv");
  EXPECT_EQ(all.expressions().names, track.names);
  const Positions neutral = obj_points(data / "neutral.obj");
  // Eyes come before the head, teeth after it, and its parents turn and scale it.
  constexpr Eigen::Index kFirst = 1060;
  const Eigen::Index count = neutral.rows();
  const Positions head = all.neutral().middleRows(kFirst, count);
  Eigen::MatrixXd ones(count, 4);
  ones << neutral, Eigen::VectorXd::Ones(count);
  const Eigen::MatrixXd placed = ones.colPivHouseholderQr().solve(head);
  const Eigen::Matrix3d back = placed.topRows<3>().inverse();
  // The decoded files have six decimals.
  constexpr double kRounding = 2e-6;
  EXPECT_LT(((head.rowwise() - placed.row(3)) * back - neutral).cwiseAbs().maxCoeff(), kRounding);
  for (int j = 0; j < all.expressions().size(); ++j) {
    const Positions target =
        obj_points(data / "targets" / (track.names[static_cast<std::size_t>(j)] + ".obj"));
    const Eigen::VectorXd field = all.expressions().displacements.col(j);
    const Positions moves =
        Eigen::Map<const Positions>(field.data(), all.vertices(), 3).middleRows(kFirst, count);
    EXPECT_LT((moves * back - (target - neutral)).cwiseAbs().maxCoeff(), kRounding);
  }
  const OpenSequence take = open_sequence((data / "facecap.glb").string());
  const auto& animation = dynamic_cast<const Animation&>(*take.frames);
  ASSERT_EQ(animation.frames(), track.weights.rows());
  EXPECT_LT((animation.weights() - track.weights).cwiseAbs().maxCoeff(), kRounding);
  EXPECT_LT((animation.times() - track.times).cwiseAbs().maxCoeff(), 1e-4);  // four decimals
}

}  // namespace
}  // namespace mimetra
