#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/temporary_folder.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {

/// A tetrahedron's faces and points, for a Mesh.
inline constexpr const char* kTetrahedron = R"(
    int[] faceVertexCounts = [3, 3, 3, 3]
    int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
)";

inline Positions corners() {
  return (Positions(4, 3) << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1).finished();
}

inline std::string layer_of(const std::string& prims) {
  return "#usda 1.0\n(\n  timeCodesPerSecond = 10\n)\n" + prims;
}

/// A mesh with a shape, `smile`, and what else stands in it and beside it.
inline std::string smiling(const std::string& weights, const std::string& inside = "") {
  return layer_of(R"(def SkelRoot "face" {
  def Mesh "mesh" (
    prepend apiSchemas = ["SkelBindingAPI"]
  ) {)" + std::string(kTetrahedron) +
                  R"(    uniform token[] skel:blendShapes = ["smile"]
    rel skel:blendShapeTargets = [</face/mesh/shape>]
    rel skel:skeleton = </face/bones>
    def BlendShape "shape" {
      uniform vector3f[] offsets = [(0, 0, 0.5), (1, 0, 0)]
      uniform int[] pointIndices = [1, 3]
    })" + inside +
                  R"(
  }
  def Skeleton "bones" {
    rel skel:animationSource = </face/bones/take>
    def SkelAnimation "take" {
      uniform token[] blendShapes = ["frown", "smile"]
      float[] blendShapeWeights)" +
                  weights + "\n    }\n  }\n}\n");
}

inline Positions smile() {
  return (Positions(4, 3) << 0, 0, 0, 0, 0, 0.5, 0, 0, 0, 1, 0, 0).finished();
}

/// A mesh on the joints of a skeleton, which stands 3 to the front.
inline std::string on_joints(const std::string& of_skeleton = "") {
  std::string text = smiling(" = [0, 1]", R"(
    int[] primvars:skel:jointIndices = [0, 0, 0, 0]
    matrix4d primvars:skel:geomBindTransform = ((2, 0, 0, 0), (0, 2, 0, 0), (0, 0, 2, 0), (0, 1, 0, 1))
    double3 xformOp:translate.timeSamples = { 0: (9, 9, 9), 1: (8, 8, 8) }
    uniform token[] xformOpOrder = ["xformOp:translate"])");
  const std::string skeleton = "def Skeleton \"bones\" {";
  return text.insert(text.find(skeleton) + skeleton.size(), R"(
    double3 xformOp:translate = (0, 0, 3)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    )" + of_skeleton);
}

class UsdFiles : public testing::Test {
 protected:
  MeshSequence read(const std::string& text, const SequenceSource& source = {}) {
    write_bytes(file_, text);
    SequenceRead result = read_sequence(file_.string(), source);
    notes_ = result.notes;
    return std::move(result.sequence);
  }
  std::string error(const std::string& text) {
    write_bytes(file_, text);
    return message_of<IoError>([&] { read_sequence(file_.string()); });
  }
  /// Where a mesh stands by these steps of its parent.
  Positions placed(const std::string& steps) {
    return read(layer_of("def Xform \"a\" {\n" + steps + "\ndef Mesh \"m\" {" + kTetrahedron +
                         "}\n}\n"))
        .rest();
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "a.usda";
  std::vector<std::string> notes_;
};

}  // namespace mimetra::test
