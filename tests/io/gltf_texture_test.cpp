#include <cstdint>

#include <gmock/gmock.h>

#include "tests/io/gltf_fixture.h"

namespace mimetra {
namespace {

using test::eight;
using test::GltfBuilder;
using test::GltfFiles;
using test::GltfJson;
using test::quarters;

/// A mesh with shares of 65535 as texture coordinates, whose material has `transform`.
GltfBuilder textured(const std::vector<std::uint16_t>& stored, const GltfJson& transform) {
  GltfBuilder gltf;
  const int view = gltf.view(GltfBuilder::bytes_of(stored));
  GltfJson& primitive = gltf.primitive(gltf.points(quarters()), gltf.faces(eight()));
  primitive["attributes"]["TEXCOORD_0"] = gltf.accessor({{"bufferView", view},
                                                         {"componentType", 5123},
                                                         {"count", 6},
                                                         {"type", "VEC2"},
                                                         {"normalized", true}});
  primitive["material"] = 0;
  gltf.root["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}}};
  return gltf;
}

TEST_F(GltfFiles, ATransformThatUndoesQuantisationMakesTextureCoordinates) {
  // Vertex 2 stands at (1/4, 1/2) of what its bits can say.
  const std::vector<std::uint16_t> stored = {0, 0, 4, 8, 1023, 2047, 0, 0, 4095, 4095, 0, 0};
  const auto of_2 = [&](const GltfBuilder& gltf) -> Eigen::Vector2d {
    return model(GltfBuilder(gltf).glb()).connectivity().texture.coordinates[2];
  };
  const double scale = 65535. / 4095;
  const Eigen::Vector2d quarter(1023. / 4095, 1 - 2047. / 4095);
  EXPECT_LT((of_2(textured(stored, {{"scale", {scale, scale}}})) - quarter).norm(), 1e-12);
  // One that repeats a picture says nothing of where its coordinates are.
  const Eigen::Vector2d as_stored(1023. / 65535, 1 - 2047. / 65535);
  EXPECT_LT((of_2(textured(stored, {{"scale", {2, 2}}})) - as_stored).norm(), 1e-12);
  EXPECT_LT((of_2(textured(stored, {{"scale", {scale, 1}}})) - as_stored).norm(), 1e-12);
  EXPECT_LT((of_2(textured(stored, {{"scale", {scale * 1.1, scale}}})) - as_stored).norm(), 1e-12);
  EXPECT_LT((of_2(textured(stored, {{"scale", {4, 4}}, {"rotation", 0.1}})) - as_stored).norm(),
            1e-12);
  std::vector<std::uint16_t> whole = stored;
  whole[0] = 20000;
  EXPECT_LT((of_2(textured(whole, {{"scale", {3, 3}}})) - as_stored).norm(), 1e-12);
  // gltfpack scales to the range of the coordinates, here half of the picture from its middle; so
  // it does where another program wrote its file again.
  const GltfJson to_range = {{"scale", {scale / 2, scale}}, {"offset", {0.5, 0}}};
  const Eigen::Vector2d in_range(0.5 + quarter.x() / 2, quarter.y());
  for (const char* generator : {"gltfpack 0.20", "another"}) {
    GltfBuilder packed = textured(stored, to_range);
    packed.root["asset"]["generator"] = generator;
    EXPECT_LT((of_2(packed) - in_range).norm(), 1e-12) << generator;
  }
}

TEST_F(GltfFiles, ATransformOfAnyPictureUndoesQuantisationWhereThereIsNoBaseColour) {
  const std::vector<std::uint16_t> stored = {0, 0, 4, 8, 1023, 2047, 0, 0, 4095, 4095, 0, 0};
  const double scale = 65535. / 4095;
  const GltfJson transform = {{"KHR_texture_transform", {{"scale", {scale, scale}}}}};
  const GltfJson picture = {{"index", 0}, {"extensions", transform}};
  const auto of_2 = [&](const GltfJson& material) -> Eigen::Vector2d {
    GltfBuilder gltf = textured(stored, {});
    gltf.root["materials"] = GltfJson::array({material});
    return model(gltf.glb()).connectivity().texture.coordinates[2];
  };
  const Eigen::Vector2d quarter(1023. / 4095, 1 - 2047. / 4095);
  const Eigen::Vector2d as_stored(1023. / 65535, 1 - 2047. / 65535);
  for (const char* name : {"normalTexture", "occlusionTexture", "emissiveTexture"}) {
    EXPECT_LT((of_2({{name, picture}}) - quarter).norm(), 1e-12) << name;
  }
  EXPECT_LT(
      (of_2({{"pbrMetallicRoughness", {{"metallicRoughnessTexture", picture}}}}) - quarter).norm(),
      1e-12);
  const GltfJson glossy = {
      {"extensions", {{"KHR_materials_pbrSpecularGlossiness", {{"diffuseTexture", picture}}}}}};
  EXPECT_LT((of_2(glossy) - quarter).norm(), 1e-12);
  // The base colour is shown as stored.
  EXPECT_LT((of_2({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                   {"normalTexture", picture}}) -
             as_stored)
                .norm(),
            1e-12);
  // That is a picture on other coordinates.
  GltfJson elsewhere = picture;
  elsewhere["texCoord"] = 1;
  EXPECT_LT((of_2({{"normalTexture", elsewhere}}) - as_stored).norm(), 1e-12);
  EXPECT_LT((of_2({{"normalTexture", elsewhere}, {"emissiveTexture", picture}}) - quarter).norm(),
            1e-12);
}

}  // namespace
}  // namespace mimetra
