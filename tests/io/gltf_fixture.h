#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "tests/io/gltf_builder.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {

/// Coordinates that single precision and 16-bit integers of a quarter hold exactly.
inline Positions quarters() {
  return octahedron().positions;
}
inline Triangles eight() {
  return octahedron().triangles;
}
/// Two vertices move.
inline Positions moved() {
  Positions displacements = Positions::Zero(6, 3);
  displacements.row(1) << 0.5, 0, -0.25;
  displacements.row(4) << 0, 1, 0;
  return displacements;
}

class GltfFiles : public testing::Test {
 protected:
  MeshSequence read(const std::string& bytes, const ReadOptions& options = {}) {
    write_bytes(file_, bytes);
    SequenceRead result = read_sequence(file_.string(), options);
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

/// Two nodes with the same mesh; the second one is moved by 10 and twice as large.
inline GltfBuilder two_nodes(GltfBuilder gltf) {
  gltf.root["nodes"] = {{{"name", "face"}, {"mesh", 0}, {"children", {1}}},
                        {{"name", "big"}, {"scale", {2, 2, 2}}, {"children", {2}}},
                        {{"mesh", 0}, {"translation", {5, 0, 0}}}};
  return gltf;
}

}  // namespace mimetra::test
