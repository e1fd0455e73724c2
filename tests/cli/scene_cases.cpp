#include <cstdint>
#include <limits>

#include "tests/cli/bad_input.h"

/// glTF scenes.
namespace mimetra::test {

namespace {

/// `text` with the first `old` in it replaced.
std::string with(std::string text, const std::string& old, const std::string& now) {
  const auto at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the case changes nothing: " + old);
  return text.replace(at, old.size(), now);
}

/// Four points, the same of a shape, the corners of two triangles, and two times that are the
/// shape's weights too.
struct Numbers {
  std::array<float, 12> points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  std::array<float, 12> shape = {0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0, 0};
  std::array<std::uint16_t, 6> corners = {0, 1, 2, 0, 2, 3};
  std::array<float, 2> times = {0, 1};

  std::string bytes() const {
    std::string bytes;
    for (const float x : points) append_raw(bytes, x);
    for (const float x : shape) append_raw(bytes, x);
    for (const std::uint16_t corner : corners) append_raw(bytes, corner);
    for (const float time : times) append_raw(bytes, time);
    return bytes;
  }
};

constexpr const char* kScene = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 116}],
"scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
"meshes": [{"extras": {"targetNames": ["smile"]}, "primitives": [{"attributes": {"POSITION": 0},
  "indices": 2, "targets": [{"POSITION": 1}]}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
  {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
  {"bufferView": 3, "componentType": 5126, "count": 2, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteLength": 48},
  {"buffer": 0, "byteOffset": 48, "byteLength": 48},
  {"buffer": 0, "byteOffset": 96, "byteLength": 12},
  {"buffer": 0, "byteOffset": 108, "byteLength": 8}],
"animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
  "samplers": [{"input": 3, "output": 3}]}]})";

/// A binary glTF file: its header, its JSON and its numbers.
std::string glb(std::string json, const Numbers& numbers = {}) {
  const std::string binary = numbers.bytes();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append_raw(bytes, std::uint32_t{2});
  append_raw(bytes, static_cast<std::uint32_t>(28 + json.size() + binary.size()));
  append_raw(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append_raw(bytes, static_cast<std::uint32_t>(binary.size()));
  bytes.append("BIN\0", 4);
  return bytes + binary;
}

void add_gltf_cases(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, std::function<void(const fs::path&)> make,
                          int code, std::vector<std::string> says) {
    says.push_back(code == 0 ? "frames" : "s.glb");
    add_case(all, kind, "gltf", std::move(make), "info s.glb --json", code, std::move(says));
  };
  const auto scene = [](const std::string& old, const std::string& now) {
    return file("s.glb", glb(with(kScene, old, now)));
  };
  const auto changed = [](const std::function<void(Numbers&)>& change) {
    Numbers numbers;
    change(numbers);
    return file("s.glb", glb(kScene, numbers));
  };
  const std::string good = glb(kScene);
  add("whole", file("s.glb", good), 0, {});
  add("missing", {}, 3, {"no such file"});
  add("empty", file("s.glb", ""), 3, {});
  add("other_type", file("s.glb", bytes_of(square(), "ply")), 3, {});
  add("truncated", file("s.glb", good.substr(0, good.size() / 2)), 3, {"truncated"});
  add("truncated_at_the_end", file("s.glb", good.substr(0, good.size() - 1)), 3, {"truncated"});
  add("a_billion_vertices", scene("\"count\": 4", "\"count\": 1000000000"), 3,
      {"1e+09 vertices", "cannot mean"});
  add("negative_count", scene("\"count\": 4", "\"count\": -4"), 3, {"expected a count"});
  add("other_number_of_vertices", scene("48, \"byteLength\": 48", "48, \"byteLength\": 36"), 3,
      {"accessors[1]: its 4 elements do not lie"});
  add("index_out_of_range", changed([](Numbers& n) { n.corners[4] = 4; }), 3,
      {"names vertex 4, expected 0 to 3"});
  add("not_a_number",
      changed([](Numbers& n) { n.points[4] = std::numeric_limits<float>::quiet_NaN(); }), 3,
      {"accessors[0]", "not finite"});
  add("infinity", changed([](Numbers& n) { n.shape[4] = std::numeric_limits<float>::infinity(); }),
      3, {"accessors[1]", "not finite"});
  add("falling_times", changed([](Numbers& n) { n.times = {1, 0}; }), 3, {"frame 1", "rise"});
  add("without_faces",
      scene("[{\"attributes\": {\"POSITION\": 0},",
            "[{\"mode\": 0, \"attributes\": {\"POSITION\": 0},"),
      3, {"no mesh of triangles"});
  add("unknown_extension", scene(R"("scenes")", R"("extensionsRequired": ["EXT_other"], "scenes")"),
      3, {"needs the extension EXT_other"});
  add("outside_its_folder",
      scene(R"({"byteLength": 116})", R"({"byteLength": 116, "uri": "../../etc/passwd"})"), 3,
      {"'../../etc/passwd' is not in its own folder"});
  add("nested_deeply",
      scene(R"("asset": {)", R"("asset": {"extras": )" + std::string(100000, '[') + R"(, )"), 3,
      {"nested deeper than 100"});
  add("nodes_in_a_circle", scene(R"({"mesh": 0})", R"({"mesh": 0, "children": [0]})"), 3,
      {"nodes must form a tree"});
  add("a_folder", [](const fs::path& folder) { fs::create_directory(folder / "s.glb"); }, 3,
      {"holds no PLY, OBJ, OFF, STL or OM file"});
}

/// Named for what they are, with a way out.
void add_usd_cases(std::vector<BadInput>& all) {
  const auto usda = [](const std::string& name) { return file(name, "#usda 1.0\n"); };
  add_case(all, "as_a_sequence", "usd", usda("s.usda"), "info s.usda", 3,
           {"s.usda", "a USD scene", ".glb"});
  add_case(all, "as_a_target", "usd", usda("s.usdc"), "transfer head s.usdc -o out.npy", 3,
           {"s.usdc", "a USD scene", ".glb"});
  add_case(all, "as_weights", "usd", usda("take.usda"),
           "convert head --weights take.usda -o out.npy", 3,
           {"take.usda", "a USD scene", ".csv", ".json"});
}

/// What scenes and VTKHDF cannot hold.
void add_outputs(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const std::string& subject,
                          const std::string& arguments, int code, std::vector<std::string> says) {
    add_case(all, kind, subject, {}, arguments, code, std::move(says));
  };
  for (const std::string name : {"out.usd", "out.usdc", "out.fbx", "out.abc"}) {
    add("unknown_extension_" + name.substr(4), "convert",
        "convert head --weights take.csv -o " + name, 2, {name, ".glb"});
  }
  for (const std::string name : {"out.glb", "out.gltf", "out.vtkhdf"}) {
    add_case(all, "output_exists", name.substr(4), file(name, "somebody's"),
             "convert head --weights take.csv -o " + name, 5, {name, "--force"});
  }
}

}  // namespace

std::vector<BadInput> scene_cases() {
  std::vector<BadInput> all;
  add_gltf_cases(all);
  add_usd_cases(all);
  add_outputs(all);
  return all;
}

}  // namespace mimetra::test
