#include <limits>

#include "tests/io/changed_bytes.h"
#include "tests/io/gltf_fixture.h"

namespace mimetra {
namespace {

using test::eight;
using test::GltfBuilder;
using test::GltfFiles;
using test::GltfJson;
using test::quarters;
using test::two_nodes;
using testing::HasSubstr;

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

TEST_F(GltfFiles, NoChangedByteDoesHarm) {
  GltfBuilder gltf = two_nodes(plain());
  gltf.animate(0, {0, 1}, {0, 1});
  test::expect_harmless_changes(gltf.glb(), file_);
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
  EXPECT_THAT(wrong("/accessors/0/count", 0),
              HasSubstr("accessors[0].count: is 0, which is too few"));
  EXPECT_THAT(wrong("/accessors/0/byteOffset", 9e15), HasSubstr("do not lie within"));
  EXPECT_THAT(wrong("/accessors/0/type", "VEC2"),
              HasSubstr("has 2 numbers an element, expected 3"));
  EXPECT_THAT(wrong("/accessors/0/componentType", 5124),
              HasSubstr("is 5124, which is not a component type"));
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
  EXPECT_THAT(wrong("/meshes/0/weights", "x"), HasSubstr("type must be array"));
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
  GltfBuilder far = plain();
  far.root["nodes"][0]["scale"] = {1e308, 1, 1};
  EXPECT_THAT(error(far.glb()), HasSubstr("vertex 0 has no usable position"));
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

}  // namespace
}  // namespace mimetra
