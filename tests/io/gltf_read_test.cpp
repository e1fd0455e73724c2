#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include <gmock/gmock.h>
#include <meshoptimizer.h>
#include <Eigen/LU>
#include <Eigen/QR>

#include "tests/io/gltf_builder.h"
#include "tests/shapes.h"
#include "tests/shared_data.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/gltf_document.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/meshopt_codec.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace {

using test::GltfBuilder;
using test::GltfJson;
using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// Coordinates that single precision and 16-bit integers of a quarter hold exactly.
Positions quarters() {
  return test::octahedron().positions;
}
Triangles eight() {
  return test::octahedron().triangles;
}
/// Two vertices move.
Positions moved() {
  Positions displacements = Positions::Zero(6, 3);
  displacements.row(1) << 0.5, 0, -0.25;
  displacements.row(4) << 0, 1, 0;
  return displacements;
}

class GltfFiles : public testing::Test {
 protected:
  MeshSequence read(const std::string& bytes, const SequenceSource& source = {}) {
    write_bytes(file_, bytes);
    SequenceRead result = read_sequence(file_.string(), source);
    notes_ = result.notes;
    return std::move(result.sequence);
  }
  BlendshapeModel model(const std::string& bytes) {
    write_bytes(file_, bytes);
    return read_blendshapes(file_.string());
  }
  std::string error(const std::string& bytes) {
    write_bytes(file_, bytes);
    return message_of<IoError>([&] { read_sequence(file_.string()); });
  }
  /// One octahedron with one target, as plainly as it can be.
  static GltfBuilder plain() {
    GltfBuilder gltf;
    const int points = gltf.points(quarters()), faces = gltf.faces(eight());
    const int target = gltf.points(moved());
    gltf.primitive(points, faces)["targets"] = {{{"POSITION", target}}};
    gltf.root["meshes"][0]["extras"] = {{"targetNames", {"smile"}}};
    return gltf;
  }
  void expect_plain(const std::string& bytes) {
    const BlendshapeModel expected = model(plain().glb());
    const BlendshapeModel found = model(bytes);
    EXPECT_EQ(found.neutral(), expected.neutral());
    EXPECT_EQ(found.triangles(), expected.triangles());
    EXPECT_EQ(found.expressions().names, expected.expressions().names);
    EXPECT_EQ(found.expressions().displacements, expected.expressions().displacements);
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "a.glb";
  std::vector<std::string> notes_;
};

TEST_F(GltfFiles, AModelIsANeutralAndItsTargets) {
  const BlendshapeModel face = model(plain().glb());
  EXPECT_EQ(face.neutral(), quarters());
  EXPECT_EQ(face.triangles(), eight());
  EXPECT_THAT(face.expressions().names, ElementsAre("smile"));
  EXPECT_EQ(face.pose(Eigen::VectorXd::Ones(1)), quarters() + moved());
}

TEST_F(GltfFiles, TargetsWithoutNamesAreNumbered) {
  GltfBuilder gltf = plain();
  gltf.root["meshes"][0].erase("extras");
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("target_000"));
}

TEST_F(GltfFiles, WithoutAnAnimationASequenceIsTheNeutral) {
  const MeshSequence sequence = read(plain().glb());
  EXPECT_EQ(sequence.frames(), 1);
  EXPECT_EQ(sequence.rest(), quarters());
  EXPECT_TRUE(sequence.rest_is_known());
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

TEST_F(GltfFiles, StepsAndSplinesHaveTheirValuesAtTheirKeys) {
  GltfBuilder steps = plain(), splines = plain();
  steps.animate(0, {0, 1}, {0.25, 0.5}, "STEP");
  splines.animate(0, {0, 1}, {9, 0.25, 8, 7, 0.5, 6}, "CUBICSPLINE");
  EXPECT_EQ(read(splines.glb()).positions(), read(steps.glb()).positions());
}

TEST_F(GltfFiles, WeightsThatStayShowInOneFrame) {
  GltfBuilder gltf = plain();
  gltf.root["meshes"][0]["weights"] = {0.5};
  EXPECT_EQ(read(gltf.glb()).frame(0), quarters() + 0.5 * moved());
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

TEST_F(GltfFiles, TextureCoordinatesHaveTheirOriginBelow) {
  GltfBuilder gltf;
  std::vector<float> uv;
  for (int v = 0; v < 6; ++v) uv.insert(uv.end(), {0.125F * static_cast<float>(v), 0.25F});
  const int texture = gltf.accessor(gltf.view(GltfBuilder::bytes_of(uv)), 5126, 6, "VEC2");
  gltf.primitive(gltf.points(quarters()), gltf.faces(eight()))["attributes"]["TEXCOORD_0"] =
      texture;
  const Connectivity faces = model(gltf.glb()).connectivity();
  ASSERT_EQ(faces.texture.corners, faces.polygons.corners);
  EXPECT_EQ(faces.texture.coordinates[2], Eigen::Vector2d(0.25, 0.75));
}

/// Two nodes with the same mesh; the second one is moved by 10 and twice as large.
GltfBuilder two_nodes(GltfBuilder gltf) {
  gltf.root["nodes"] = {{{"name", "face"}, {"mesh", 0}, {"children", {1}}},
                        {{"name", "big"}, {"scale", {2, 2, 2}}, {"children", {2}}},
                        {{"mesh", 0}, {"translation", {5, 0, 0}}}};
  return gltf;
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

TEST_F(GltfFiles, WeightsOfSeveralNodesMeetByName) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 2}, {0, 1});
  gltf.animate(2, {0, 1, 2}, {0, 0.5, 1});
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.times(), Eigen::Vector3d(0, 1, 2));
  EXPECT_EQ(sequence.frame(1).topRows(6), quarters() + 0.5 * moved());
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("smile"));
}

TEST_F(GltfFiles, WeightsOfOneNameThatDifferAreTwoExpressions) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 2}, {0, 1});
  const MeshSequence sequence = read(gltf.glb());
  EXPECT_EQ(sequence.frame(1).topRows(6), quarters() + moved());
  EXPECT_EQ(sequence.frame(1).bottomRows(6), sequence.rest().bottomRows(6));
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_THAT(notes_[0], HasSubstr("'smile' of 'big' is 'smile_2'"));
  EXPECT_THAT(model(gltf.glb()).expressions().names, ElementsAre("smile", "smile_2"));
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

TEST_F(GltfFiles, ASkinHoldsItsVerticesWhereItsJointsStand) {
  GltfBuilder gltf = plain();
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
                        {{"scale", {2, 2, 2}}}};
  gltf.root["scenes"][0]["nodes"] = {0, 1};
  const BlendshapeModel face = model(gltf.glb());
  const Eigen::RowVector3d up(0, 1, 0);
  EXPECT_EQ(face.neutral().topRows(3), quarters().topRows(3).rowwise() + up);
  EXPECT_EQ(face.neutral().bottomRows(3), (2 * quarters().bottomRows(3)).rowwise() + up);
  EXPECT_EQ(face.expressions().displacements(3 * 4 + 1, 0), 2);
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
  EXPECT_EQ(read_gltf_document(folder_ / "c.gltf").buffers.front(), "foobar");
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
    EXPECT_THAT(error(gltf.root.dump()), HasSubstr("is no file in its own folder")) << uri;
  }
  GltfBuilder gltf = plain();
  gltf.root["buffers"] = {{{"byteLength", 10}, {"uri", "none.bin"}}};
  EXPECT_THAT(error(gltf.root.dump()), HasSubstr("its buffer 'none.bin' is not there"));
}

/// The same values as a view that meshoptimizer compressed.
int compressed_view(GltfBuilder& gltf, const std::string& encoded, const GltfJson& how) {
  const int view = gltf.view(encoded);
  GltfJson& json = gltf.root["bufferViews"][static_cast<std::size_t>(view)];
  GltfJson extension = how;
  extension["buffer"] = 0;
  extension["byteOffset"] = how.value("byteOffset", json["byteOffset"].get<std::size_t>());
  extension["byteLength"] = encoded.size();
  const std::size_t bytes = how["count"].get<std::size_t>() * how["byteStride"].get<std::size_t>();
  json = {{"buffer", 1},
          {"byteOffset", 0},
          {"byteLength", bytes},
          {"extensions", {{"EXT_meshopt_compression", extension}}}};
  return view;
}

std::string encoded_vertices(const void* values, std::size_t count, std::size_t stride) {
  std::string bytes(meshopt_encodeVertexBufferBound(count, stride), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                          bytes.size(), values, count, stride));
  return bytes;
}

std::string encoded_points(const Positions& points) {
  const std::vector<float> values = GltfBuilder::floats(points);
  return encoded_vertices(values.data(), values.size() / 3, 12);
}

TEST_F(GltfFiles, CompressedViewsArePlainOnes) {
  for (const std::string mode : {"TRIANGLES", "INDICES"}) {
    GltfBuilder gltf;
    const std::vector<std::uint32_t> corners = GltfBuilder::corners(eight());
    std::string indices(meshopt_encodeIndexBufferBound(corners.size(), 6) +
                            meshopt_encodeIndexSequenceBound(corners.size(), 6),
                        '\0');
    using Encode = std::size_t (*)(unsigned char*, std::size_t, const unsigned int*, std::size_t);
    const Encode encode =
        mode == "INDICES" ? Encode(meshopt_encodeIndexSequence) : Encode(meshopt_encodeIndexBuffer);
    indices.resize(encode(reinterpret_cast<unsigned char*>(indices.data()), indices.size(),
                          corners.data(), corners.size()));
    const int faces = gltf.accessor(
        compressed_view(gltf, indices, {{"count", 24}, {"byteStride", 4}, {"mode", mode}}), 5125,
        24, "SCALAR");
    const GltfJson attributes = {{"count", 6}, {"byteStride", 12}, {"mode", "ATTRIBUTES"}};
    const int points = gltf.accessor(compressed_view(gltf, encoded_points(quarters()), attributes),
                                     5126, 6, "VEC3");
    const int target =
        gltf.accessor(compressed_view(gltf, encoded_points(moved()), attributes), 5126, 6, "VEC3");
    gltf.primitive(points, faces)["targets"] = {{{"POSITION", target}}};
    gltf.root["meshes"][0]["extras"] = {{"targetNames", {"smile"}}};
    gltf.root["extensionsRequired"] = {"EXT_meshopt_compression"};
    gltf.root["buffers"] = {{{"byteLength", gltf.binary.size()}},
                            {{"byteLength", 9999},
                             {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    const BlendshapeModel found = model(gltf.glb());
    EXPECT_EQ(found.neutral(), quarters());
    EXPECT_EQ(found.pose(Eigen::VectorXd::Ones(1)), quarters() + moved());
    // The codec of triangles may begin each with another of its corners.
    EXPECT_TRUE(same_faces(found.connectivity(), Connectivity::from_triangles(6, eight())));
  }
}

TEST_F(GltfFiles, FiltersOfCompressedViewsAreUndone) {
  const Positions points = test::sphere(1).positions;
  const auto count = static_cast<std::size_t>(points.rows());
  const auto view = [&](std::size_t stride, GltfCompression::Filter filter) {
    return GltfCompression{0, 0, 0, stride, count, GltfCompression::Mode::attributes, filter};
  };
  std::vector<float> four;
  for (std::size_t v = 0; v < count; ++v) {
    for (int c = 0; c < 3; ++c) four.push_back(static_cast<float>(points(Eigen::Index(v), c)));
    four.push_back(0);
  }
  const auto largest_error = [&](const std::string& values, auto number, double one, int stride) {
    double largest = 0;
    for (std::size_t v = 0; v < count; ++v) {
      for (int c = 0; c < 3; ++c) {
        const std::size_t at =
            v * static_cast<std::size_t>(stride) + static_cast<std::size_t>(c) * sizeof number;
        std::memcpy(&number, values.data() + at, sizeof number);
        largest = std::max(
            largest, std::abs(static_cast<double>(number) / one - points(Eigen::Index(v), c)));
      }
    }
    return largest;
  };
  std::string stored(count * 16, '\0');
  meshopt_encodeFilterOct(stored.data(), count, 8, 16, four.data());
  const std::string normals = decompressed("a", "a", view(8, GltfCompression::Filter::octahedral),
                                           encoded_vertices(stored.data(), count, 8));
  EXPECT_LT(largest_error(normals, std::int16_t{}, 32767, 8), 1e-4);  // 16 bits of a unit vector

  meshopt_encodeFilterExp(stored.data(), count, 16, 20, four.data());
  const std::string numbers = decompressed("a", "a", view(16, GltfCompression::Filter::exponential),
                                           encoded_vertices(stored.data(), count, 16));
  EXPECT_LT(largest_error(numbers, float{}, 1, 16), 1e-5);  // 20 bits, less the sign

  meshopt_encodeFilterQuat(stored.data(), count, 8, 16, four.data());
  const std::string turns = decompressed("a", "a", view(8, GltfCompression::Filter::quaternion),
                                         encoded_vertices(stored.data(), count, 8));
  std::array<std::int16_t, 4> turn{};
  std::memcpy(turn.data(), turns.data() + 8 * (count - 1), sizeof turn);
  double cosine = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    cosine += turn[c] / 32767. * static_cast<double>(four[4 * (count - 1) + c]);
  }
  EXPECT_NEAR(std::abs(cosine), 1, 1e-4);  // a turn and its negative are one
}

TEST_F(GltfFiles, DamagedCompressionIsAnError) {
  const std::string points = encoded_points(quarters());
  const auto with = [&](const std::string& encoded, GltfJson how) {
    GltfBuilder gltf;
    const int view = compressed_view(gltf, encoded, how);
    gltf.primitive(gltf.accessor(view, 5126, 6, "VEC3"), gltf.faces(eight()));
    gltf.root["buffers"] = {
        {{"byteLength", gltf.binary.size()}},
        {{"byteLength", 9999}, {"extensions", {{"EXT_meshopt_compression", GltfJson::object()}}}}};
    return error(gltf.glb());
  };
  const GltfJson sound = {{"count", 6}, {"byteStride", 12}, {"mode", "ATTRIBUTES"}};
  const auto other = [&](const char* key, const GltfJson& value) {
    GltfJson how = sound;
    how[key] = value;
    return how;
  };
  for (std::size_t bytes = 0; bytes < points.size(); ++bytes) {
    EXPECT_THAT(with(points.substr(0, bytes), sound), HasSubstr("bufferViews[0]"));
  }
  EXPECT_THAT(with(points, other("byteStride", 10)), HasSubstr("no compressed view has 6"));
  EXPECT_THAT(with(points, other("byteStride", 0)), HasSubstr("no compressed view has 6"));
  EXPECT_THAT(with(points, other("count", 1U << 31)), HasSubstr("cannot hold 2147483648 elements"));
  EXPECT_THAT(with(points, other("mode", "TRIANGLES")), HasSubstr("no compressed view"));
  EXPECT_THAT(with(points, other("mode", "ZIP")), HasSubstr("has mode 'ZIP'"));
  EXPECT_THAT(with(points, other("filter", "QUATERNION")), HasSubstr("no compressed view"));
  EXPECT_THAT(with(points, other("byteOffset", 1U << 30)), HasSubstr("of a buffer of"));
}

TEST_F(GltfFiles, EveryTruncatedPrefixIsAnError) {
  GltfBuilder gltf = plain();
  gltf.animate(0, {0, 1}, {0, 1});
  const std::string whole = gltf.glb();
  for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
    EXPECT_THAT(error(whole.substr(0, bytes)), HasSubstr("a.glb")) << bytes;
  }
}

TEST_F(GltfFiles, TextThatEndsEarlyIsAnError) {
  GltfBuilder gltf = plain();
  gltf.root["buffers"] = {{{"byteLength", gltf.binary.size()}}};
  const std::string json = gltf.root.dump();
  for (std::size_t bytes = 0; bytes < json.size(); bytes += 3) {
    EXPECT_THAT(error(GltfBuilder::glb(json.substr(0, bytes), gltf.binary)), HasSubstr("a.glb"));
  }
}

TEST_F(GltfFiles, NestingHasAnEnd) {
  const std::string deep(200000, '[');
  EXPECT_THAT(error(R"({"asset":{"version":"2.0"},"extras":)" + deep), HasSubstr("nested deeper"));
}

/// Whatever bytes are changed, the file is read, or refused by an error that names it.
TEST_F(GltfFiles, NoChangedByteDoesHarm) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 1}, {0, 1});
  const std::string sound = gltf.glb();
  std::uint32_t random = 1;
  const auto next = [&random](std::size_t below) {
    random = 1664525 * random + 1013904223;  // Numerical Recipes
    return static_cast<std::size_t>(random >> 8) % below;
  };
  constexpr std::string_view kTelling = "0123456789-.,:[]{}()\"e ";
  for (int trial = 0; trial < 3000; ++trial) {
    std::string bytes = sound;
    for (std::size_t change = next(4) + 1; change > 0; --change) {
      const bool is_text = next(2) == 0;
      bytes[next(bytes.size())] =
          is_text ? kTelling[next(kTelling.size())] : static_cast<char>(next(256));
    }
    write_bytes(file_, bytes);
    try {
      read_sequence(file_.string());
    } catch (const IoError& error) {
      EXPECT_THAT(error.what(), HasSubstr(file_.filename().string()));
    }
  }
}

/// Each way in which one value of a sound file is wrong, and what is said of it.
TEST_F(GltfFiles, WhatCannotBeIsNamed) {
  const auto wrong = [&](const char* pointer, const GltfJson& value) {
    GltfBuilder gltf = plain();
    gltf.animate(0, {0, 1}, {0, 1});
    gltf.glb();
    gltf.root[GltfJson::json_pointer(pointer)] = value;
    return error(gltf.glb());
  };
  EXPECT_THAT(wrong("/asset/version", "1.0"), HasSubstr("is glTF 1.0"));
  EXPECT_THAT(wrong("/extensionsRequired", {"EXT_other"}),
              HasSubstr("needs the extension EXT_other, which is not read"));
  EXPECT_THAT(wrong("/accessors/0/count", 7), HasSubstr("accessors[0]: its 7 elements do not lie"));
  EXPECT_THAT(wrong("/accessors/0/count", 1e15), HasSubstr("a.glb: "));
  EXPECT_THAT(wrong("/accessors/0/count", 1e300), HasSubstr("expected a count"));
  EXPECT_THAT(wrong("/accessors/0/count", -1), HasSubstr("expected a count"));
  EXPECT_THAT(wrong("/accessors/0/count", 0), HasSubstr("has no elements"));
  EXPECT_THAT(wrong("/accessors/0/byteOffset", 9e15), HasSubstr("do not lie within"));
  EXPECT_THAT(wrong("/accessors/0/type", "VEC2"),
              HasSubstr("has 2 numbers an element, expected 3"));
  EXPECT_THAT(wrong("/accessors/0/componentType", 5124), HasSubstr("component type 5124"));
  EXPECT_THAT(wrong("/accessors/0/bufferView", 9), HasSubstr("is 9, but there are"));
  EXPECT_THAT(wrong("/accessors/0", {{"count", 1e9}, {"type", "VEC3"}, {"componentType", 5126}}),
              HasSubstr("bytes cannot mean"));
  EXPECT_THAT(wrong("/bufferViews/0/byteLength", 9e15), HasSubstr("of a buffer of"));
  EXPECT_THAT(wrong("/bufferViews/0/byteStride", 4), HasSubstr("stand 4 apart"));
  EXPECT_THAT(wrong("/buffers/0/byteLength", 1e12), HasSubstr("is truncated"));
  EXPECT_THAT(wrong("/nodes/0/children", {0}), HasSubstr("nodes must form a tree"));
  EXPECT_THAT(wrong("/nodes/0/matrix", {1, 2}), HasSubstr("has 2 numbers, expected 16"));
  EXPECT_THAT(wrong("/nodes/0/mesh", 3), HasSubstr("nodes[0].mesh: is 3, but there are 1"));
  EXPECT_THAT(wrong("/scenes/0/nodes", {4}), HasSubstr("is 4, but there are 1"));
  EXPECT_THAT(wrong("/meshes/0/primitives/0/targets/0/POSITION", 99), HasSubstr("is 99"));
  EXPECT_THAT(wrong("/meshes/0/primitives/0/indices", 0), HasSubstr("holds no indices"));
  EXPECT_THAT(wrong("/meshes/0/extras/targetNames", "x"), HasSubstr("expected an array"));
  EXPECT_THAT(wrong("/animations/0/samplers/0/interpolation", "BEZIER"), HasSubstr("BEZIER"));
  EXPECT_THAT(wrong("/animations/0/samplers/0/output", 1), HasSubstr("expected 2"));
  EXPECT_THAT(wrong("/scenes", GltfJson::object()), HasSubstr("expected an array"));
}

TEST_F(GltfFiles, BadNumbersAreNamed) {
  GltfBuilder times = plain();
  times.animate(0, {1, 1}, {0, 1});
  EXPECT_THAT(error(times.glb()), HasSubstr("frame 1 is at 1 s, expected times that rise"));
  GltfBuilder infinite;
  Positions points = quarters();
  points(2, 1) = std::numeric_limits<double>::infinity();
  const int there = infinite.points(points);
  infinite.primitive(there, infinite.faces(eight()));
  EXPECT_THAT(error(infinite.glb()), HasSubstr("accessors[0]: holds a number that is not finite"));
  GltfBuilder corner;
  Triangles faces = eight();
  faces(3, 1) = 6;
  corner.primitive(corner.points(quarters()), corner.faces(faces));
  EXPECT_THAT(error(corner.glb()), HasSubstr("names vertex 6, expected 0 to 5"));
}

TEST_F(GltfFiles, CountsThatAFileCannotMeanAreRefusedBeforeTheyAreMade) {
  GltfBuilder gltf = plain();
  GltfJson target = gltf.root["meshes"][0]["primitives"][0]["targets"][0];
  for (int t = 0; t < 20000; ++t) {
    gltf.root["meshes"][0]["primitives"][0]["targets"].push_back(target);
  }
  GltfJson nodes = GltfJson::array();
  GltfJson roots = GltfJson::array();
  for (int n = 0; n < 5000; ++n) {
    nodes.push_back({{"mesh", 0}});
    roots.push_back(n);
  }
  gltf.root["nodes"] = nodes;
  gltf.root["scenes"][0]["nodes"] = roots;
  EXPECT_THAT(error(gltf.glb()), HasSubstr("bytes cannot mean"));
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
