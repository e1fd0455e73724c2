#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra::test {

using GltfJson = nlohmann::json;

/// Puts together a .glb by hand.
class GltfBuilder {
 public:
  GltfJson root = {{"asset", {{"version", "2.0"}}},
                   {"scene", 0},
                   {"scenes", {{{"nodes", {0}}}}},
                   {"nodes", {{{"mesh", 0}}}},
                   {"meshes", {{{"primitives", GltfJson::array()}}}},
                   {"bufferViews", GltfJson::array()},
                   {"accessors", GltfJson::array()},
                   {"buffers", GltfJson::array()}};
  std::string binary;

  template <typename Number>
  static std::string bytes_of(const std::vector<Number>& numbers) {
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    return bytes;
  }
  static std::vector<float> floats(const Eigen::Ref<const Positions>& points) {
    std::vector<float> all;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      for (int c = 0; c < 3; ++c) all.push_back(static_cast<float>(points(i, c)));
    }
    return all;
  }
  static std::vector<std::uint32_t> corners(const Triangles& triangles) {
    return {triangles.data(), triangles.data() + triangles.size()};
  }

  /// A view of `bytes`; its number.
  int view(const std::string& bytes, int stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    GltfJson view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    root["bufferViews"].push_back(view);
    binary += bytes;
    return last("bufferViews");
  }
  int accessor(GltfJson accessor) {
    root["accessors"].push_back(std::move(accessor));
    return last("accessors");
  }
  int accessor(int view, int type, std::size_t count, const char* shape) {
    return accessor(
        {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}});
  }
  int points(const Eigen::Ref<const Positions>& positions) {
    return accessor(view(bytes_of(floats(positions))), 5126,
                    static_cast<std::size_t>(positions.rows()), "VEC3");
  }
  int numbers(const std::vector<float>& numbers) {
    return accessor(view(bytes_of(numbers)), 5126, numbers.size(), "SCALAR");
  }
  int faces(const Triangles& triangles) {
    return accessor(view(bytes_of(corners(triangles))), 5125,
                    static_cast<std::size_t>(triangles.size()), "SCALAR");
  }
  GltfJson& primitive(int positions, int indices) {
    auto& primitives = root["meshes"][0]["primitives"];
    primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    return primitives.back();
  }
  /// Weights of a node's mesh over time.
  void animate(int node, const std::vector<float>& times, const std::vector<float>& weights,
               const char* interpolation = "LINEAR") {
    const int input = numbers(times), output = numbers(weights);
    root["animations"].push_back(
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}}}}});
  }

  std::string glb() {
    if (root["buffers"].empty()) root["buffers"].push_back({{"byteLength", binary.size()}});
    return glb(root.dump(), binary);
  }
  static std::string glb(std::string json, std::string bytes) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    const auto word = [](std::size_t number) {
      return bytes_of(std::vector{static_cast<std::uint32_t>(number)});
    };
    return "glTF" + word(2) + word(28 + json.size() + bytes.size()) + word(json.size()) + "JSON" +
           json + word(bytes.size()) + std::string("BIN\0", 4) + bytes;
  }

 private:
  int last(const char* list) const { return static_cast<int>(root[list].size()) - 1; }
};

}  // namespace mimetra::test
