#include <gmock/gmock.h>
#include <Eigen/LU>

#include "tests/io/draco_octahedron.h"
#include "tests/io/gltf_builder.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::draco_octahedron;
using test::GltfBuilder;
using test::GltfJson;
using testing::HasSubstr;

std::string draco_glb(const std::string& encoded) {
  GltfBuilder gltf;
  const int view = gltf.view(encoded);
  const int points = gltf.accessor({{"componentType", 5126}, {"count", 6}, {"type", "VEC3"}});
  const int faces = gltf.accessor({{"componentType", 5125}, {"count", 24}, {"type", "SCALAR"}});
  gltf.primitive(points, faces)["extensions"] = {
      {"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}}}};
  gltf.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return gltf.glb();
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

TEST(Draco, EveryTruncatedPrefixIsAnError) {
  test::TemporaryFolder folder;
  const std::string encoded = draco_octahedron();
  for (std::size_t bytes = 0; bytes < encoded.size(); ++bytes) {
    write_bytes(folder / "a.glb", draco_glb(encoded.substr(0, bytes)));
    EXPECT_THAT(test::message_of<IoError>([&] { read_blendshapes((folder / "a.glb").string()); }),
                HasSubstr("a.glb: 'mesh_000'"))
        << bytes;
  }
}

TEST(Draco, TruthValuesAreNoPositions) {
  test::TemporaryFolder folder;
  std::string encoded = draco_octahedron();
  const std::string positions("\x01\x00\x09\x03", 4);  // one attribute: positions, float32, 3 each
  const auto at = encoded.find(positions);
  ASSERT_NE(at, std::string::npos);
  encoded[at + 2] = 11;
  write_bytes(folder / "a.glb", draco_glb(encoded));
  EXPECT_THAT(test::message_of<IoError>([&] { read_blendshapes((folder / "a.glb").string()); }),
              HasSubstr("its compressed mesh has no number for a vertex"));
}

}  // namespace
}  // namespace mimetra
