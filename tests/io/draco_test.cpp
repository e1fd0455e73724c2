#include <gmock/gmock.h>
#include <Eigen/LU>

#include "tests/io/draco_octahedron.h"
#include "tests/io/gltf_builder.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::draco_octahedron;
using test::GltfBuilder;
using test::GltfJson;
using test::quantised_draco_octahedron;
using testing::HasSubstr;

GltfBuilder draco_gltf(const std::string& encoded) {
  GltfBuilder gltf;
  const int view = gltf.view(encoded);
  const int points = gltf.accessor({{"componentType", 5126}, {"count", 6}, {"type", "VEC3"}});
  const int faces = gltf.accessor({{"componentType", 5125}, {"count", 24}, {"type", "SCALAR"}});
  gltf.primitive(points, faces)["extensions"] = {
      {"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}};
  gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return gltf;
}

std::string draco_glb(const std::string& encoded) {
  return draco_gltf(encoded).glb();
}

TEST(Draco, ACompressedMeshIsItsTriangles) {
  test::TemporaryFolder folder;
  write_bytes(folder / "a.glb", draco_glb(draco_octahedron()));
  const BlendshapeModel found = read_blendshapes((folder / "a.glb").string());
  const test::Shape shape = test::octahedron();
  ASSERT_EQ(found.vertices(), 6);
  ASSERT_EQ(found.triangles().rows(), 8);
  // Draco puts vertices and faces in an order of its own: the solid is the same.
  double volume = 0;
  for (int t = 0; t < 8; ++t) {
    Eigen::Matrix3d corners;
    for (int k = 0; k < 3; ++k) corners.row(k) = found.neutral().row(found.triangles()(t, k));
    volume += corners.determinant() / 6;
  }
  EXPECT_NEAR(volume, 4.0 / 3, 1e-12);
}

/// A compressed mesh on two joints, the second of which stands 5 higher.
GltfBuilder hanging_gltf() {
  GltfBuilder gltf = draco_gltf(draco_octahedron(true));
  GltfJson& primitive = gltf.root["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"] = {
      {"POSITION", 0}, {"JOINTS_0", 1}, {"WEIGHTS_0", 2}};
  primitive["attributes"]["JOINTS_0"] =
      gltf.accessor({{"componentType", 5121}, {"count", 6}, {"type", "VEC4"}});
  primitive["attributes"]["WEIGHTS_0"] =
      gltf.accessor({{"componentType", 5126}, {"count", 6}, {"type", "VEC4"}});
  gltf.root["skins"] = {{{"joints", {1, 2}}}};
  gltf.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {9, 9, 9}}},
                        {{"name", "root"}, {"children", {2}}},
                        {{"name", "up"}, {"translation", {0, 5, 0}}}};
  gltf.root["scenes"][0]["nodes"] = {0, 1};
  return gltf;
}

/// Expects what lies at x > 0 to hang on the joint above.
void expect_hanging(GltfBuilder gltf) {
  test::TemporaryFolder folder;
  write_bytes(folder / "a.glb", gltf.glb());
  const Positions found = read_blendshapes((folder / "a.glb").string()).neutral();
  std::vector<std::vector<double>> points, expected;
  for (const auto& point : found.rowwise()) points.emplace_back(point.begin(), point.end());
  const Positions bound = test::octahedron().positions;
  for (Eigen::RowVector3d point : bound.rowwise()) {
    if (point.x() > 0) point.y() += 5;
    expected.emplace_back(point.begin(), point.end());
  }
  EXPECT_THAT(points, testing::UnorderedElementsAreArray(expected));
}

TEST(Draco, ASkinHoldsTheVerticesOfACompressedMesh) {
  expect_hanging(hanging_gltf());
}

TEST(Draco, AttributesThatTheCompressedMeshLeavesToTheirAccessorsAreReadThere) {
  GltfBuilder gltf = hanging_gltf();
  GltfJson& primitive = gltf.root["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("WEIGHTS_0");
  std::vector<float> all, uv;
  for (int v = 0; v < 6; ++v) {
    all.insert(all.end(), {1, 0, 0, 0});
    uv.insert(uv.end(), {0.125F * static_cast<float>(v), 0.25F});
  }
  primitive["attributes"]["WEIGHTS_0"] =
      gltf.accessor(gltf.view(GltfBuilder::bytes_of(all)), 5126, 6, "VEC4");
  primitive["attributes"]["TEXCOORD_0"] =
      gltf.accessor(gltf.view(GltfBuilder::bytes_of(uv)), 5126, 6, "VEC2");
  expect_hanging(gltf);
  test::TemporaryFolder folder;
  write_bytes(folder / "a.glb", gltf.glb());
  const BlendshapeModel found = read_blendshapes((folder / "a.glb").string());
  const TextureCoordinates& texture = found.connectivity().texture;
  ASSERT_EQ(texture.corners, found.connectivity().polygons.corners);
  for (int v = 0; v < 6; ++v) {
    EXPECT_EQ(texture.coordinates[static_cast<std::size_t>(v)], Eigen::Vector2d(0.125 * v, 0.75));
  }
}

TEST(Draco, IntegersAreWhatTheirAccessorsNormaliseThemTo) {
  test::TemporaryFolder folder;
  for (const bool is_normalized : {true, false}) {
    GltfBuilder gltf = draco_gltf(quantised_draco_octahedron());
    GltfJson& primitive = gltf.root["meshes"][0]["primitives"][0];
    primitive["extensions"]["KHR_draco_mesh_compression"]["attributes"] = {{"POSITION", 0},
                                                                           {"TEXCOORD_0", 1}};
    primitive["attributes"] = {
        {"POSITION", gltf.accessor({{"componentType", 5122},
                                    {"count", 6},
                                    {"type", "VEC3"},
                                    {"normalized", is_normalized}})},
        {"TEXCOORD_0",
         gltf.accessor(
             {{"componentType", 5123}, {"count", 6}, {"type", "VEC2"}, {"normalized", true}})}};
    write_bytes(folder / "a.glb", gltf.glb());
    const BlendshapeModel found = read_blendshapes((folder / "a.glb").string());
    std::vector<std::vector<double>> points, expected;
    for (const auto& point : found.neutral().rowwise()) {
      points.emplace_back(point.begin(), point.end());
    }
    const double scale = is_normalized ? 1 : 32767;
    const Positions shown = scale * test::octahedron().positions;
    for (const auto& point : shown.rowwise()) expected.emplace_back(point.begin(), point.end());
    EXPECT_THAT(points, testing::UnorderedElementsAreArray(expected));
    // Upside down.
    const auto& texture = found.connectivity().texture.coordinates;
    ASSERT_EQ(texture.size(), 6U);
    for (int v = 0; v < 6; ++v) {
      EXPECT_EQ(texture[static_cast<std::size_t>(v)].y(), found.neutral()(v, 1) > 0 ? 0 : 1);
    }
  }
}

/// What reading says of a file.
std::string refusal(const std::string& glb) {
  test::TemporaryFolder folder;
  write_bytes(folder / "a.glb", glb);
  return test::message_of<IoError>([&] { read_blendshapes((folder / "a.glb").string()); });
}

TEST(Draco, AMeshWithoutTheJointsThatItsFileNamesSaysSo) {
  GltfBuilder gltf = hanging_gltf();
  gltf.root["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]
           ["WEIGHTS_0"] = 7;
  EXPECT_THAT(refusal(gltf.glb()), HasSubstr("its compressed mesh has no weights of joints"));
}

TEST(Draco, AttributesThatThePrimitiveItselfDoesNotNameAreRefused) {
  for (const char* name : {"JOINTS_0", "WEIGHTS_0"}) {
    GltfBuilder gltf = hanging_gltf();
    gltf.root["meshes"][0]["primitives"][0]["attributes"].erase(name);
    EXPECT_THAT(
        refusal(gltf.glb()),
        HasSubstr(name + std::string(": is compressed, but the primitive does not have it")));
  }
}

TEST(Draco, EveryTruncatedPrefixIsAnError) {
  const std::string encoded = draco_octahedron();
  for (std::size_t bytes = 0; bytes < encoded.size(); ++bytes) {
    EXPECT_THAT(refusal(draco_glb(encoded.substr(0, bytes))), HasSubstr("a.glb: 'mesh_000'"))
        << bytes;
  }
}

TEST(Draco, VersionsFromBeforeGltfAreRefused) {
  std::string encoded = draco_octahedron();
  encoded[5] = encoded[6] = 1;
  EXPECT_THAT(refusal(draco_glb(encoded)),
              HasSubstr("it has version 1.1 of Draco's stream, expected 2.2"));
}

TEST(Draco, MoreFacesThanAFileCanMeanAreRefusedBeforeTheyTakeMemory) {
  std::string encoded = draco_octahedron();
  // Behind the header, the kind of traversal and the number of vertices, if it has these.
  const std::size_t faces = encoded[8] == 1 ? 13 : 11;
  ASSERT_EQ(encoded[faces], 8);
  encoded.replace(faces, 1, "\xff\xff\xff\x7f");  // 2^28 - 1
  EXPECT_THAT(refusal(draco_glb(encoded)), HasSubstr("bytes cannot mean"));
}

TEST(Draco, TruthValuesAreNoPositions) {
  std::string encoded = draco_octahedron();
  const std::string positions("\x01\x00\x09\x03", 4);  // one attribute: positions, float32, 3 each
  const auto at = encoded.find(positions);
  ASSERT_NE(at, std::string::npos);
  encoded[at + 2] = 11;
  EXPECT_THAT(refusal(draco_glb(encoded)),
              HasSubstr("its compressed mesh has no number for a vertex"));
}

}  // namespace
}  // namespace mimetra
