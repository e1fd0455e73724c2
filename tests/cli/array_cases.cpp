#include <limits>

#include "tests/cli/bad_input.h"

/// NumPy arrays and the mesh that gives them faces.
namespace mimetra::test {

namespace {

std::string header(const std::string& type, const std::string& shape,
                   const std::string& order = "False") {
  std::string text =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
  std::string bytes = "\x93NUMPY\x01";
  bytes += '\0';
  append_raw(bytes, static_cast<std::uint16_t>(text.size()));
  return bytes + text;
}

/// `frames` frames of the square.
std::string values(int frames) {
  std::string bytes;
  for (int frame = 0; frame < frames; ++frame) {
    for (const auto& point : square(0.1 * frame).vertices) {
      for (const double coordinate : point) append_raw(bytes, coordinate);
    }
  }
  return bytes;
}

std::string with_value(std::string bytes, std::size_t index, double value) {
  std::string raw;
  append_raw(raw, value);
  return bytes.replace(index * sizeof value, sizeof value, raw);
}

std::function<void(const fs::path&)> array(const std::string& bytes,
                                           const RawMesh& topology = square()) {
  return [bytes, topology](const fs::path& folder) {
    write_bytes_to(folder / "a.npy", bytes);
    write_bytes_to(folder / "a.topology.ply", bytes_of(topology, "ply"));
  };
}

}  // namespace

std::vector<BadInput> array_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& kind, std::function<void(const fs::path&)> make,
                          int code, std::vector<std::string> says) {
    says.push_back(code == 0 ? "frames" : "a.npy");
    add_case(all, kind, "npy", std::move(make), "info a.npy --json", code, std::move(says));
  };
  const std::string good = header("<f8", "(2, 4, 3)");
  add("missing", {}, 3, {"no such file"});
  add("empty", array(""), 3, {"is no NumPy array"});
  add("truncated", array(good + values(1)), 3, {"is truncated", "2 x 4 x 3"});
  add("truncated_header", array(good.substr(0, 30)), 3, {"truncated in its header"});
  add("other_type", array(bytes_of(square(), "stl_binary")), 3, {"is no NumPy array"});
  add("more_than_the_header_says", array(good + values(3)), 3, {"96 bytes follow"});
  add("a_billion_frames", array(header("<f8", "(1000000000, 4, 3)") + values(2)), 3, {"truncated"});
  add("negative_count", array(header("<f8", "(-2, 4, 3)") + values(2)), 3, {"shape"});
  add("no_frames", array(header("<f8", "(0, 4, 3)")), 3, {"is empty"});
  add("two_coordinates", array(header("<f8", "(3, 4, 2)") + values(2)), 3,
      {"3 x 4 x 2", "expected frames x vertices x 3"});
  add("integers", array(header("<i8", "(2, 4, 3)") + values(2)), 3, {"integers", "float"});
  add("objects", array(header("|O", "(2, 4, 3)") + values(2)), 3, {"|O"});
  add("not_a_number",
      array(good + with_value(values(2), 14, std::numeric_limits<double>::quiet_NaN())), 3,
      {"frame 1: vertex 0"});
  add("infinity", array(good + with_value(values(2), 14, std::numeric_limits<double>::infinity())),
      3, {"frame 1: vertex 0"});
  add("without_topology", file("a.npy", good + values(2)), 3, {"--topology"});
  RawMesh five = square();
  five.vertices.push_back({2, 2, 2});
  add("topology_of_other_count", array(good + values(2), five), 4,
      {"4 vertices, expected 5", "a.topology.ply"});
  RawMesh bare = square();
  bare.faces.clear();
  add_case(all, "topology_without_faces", "npy", array(good + values(2), bare), "info a.npy", 3,
           {"a.topology.ply", "has no faces"});
  add_case(all, "missing_topology", "npy", array(good + values(2)), "info a.npy --topology no.obj",
           3, {"no.obj", "no such file"});
  return all;
}

}  // namespace mimetra::test
