#include <limits>

#include "tests/cli/bad_input.h"

/// The pair of files in which eos keeps a morphable model.
namespace mimetra::test {

namespace {

using Floats = std::vector<float>;

std::string matrix(int rows, int columns, const Floats& values) {
  std::string bytes;
  append_raw(bytes, std::int32_t{rows});
  append_raw(bytes, std::int32_t{columns});
  for (const float value : values) append_raw(bytes, value);
  return bytes;
}

Floats coordinates() {
  Floats values;
  for (const auto& point : square().vertices) {
    for (const double coordinate : point) values.push_back(static_cast<float>(coordinate));
  }
  return values;
}

std::string shape(const Floats& mean = coordinates(), int last_vertex = 3, unsigned version = 1) {
  std::string bytes;
  append_raw(bytes, std::uint32_t{version});
  bytes += matrix(12, 1, mean) + matrix(12, 1, Floats(12, 0.1F)) + matrix(1, 1, {4});
  append_raw(bytes, std::uint64_t{2});
  for (const int vertex : {0, 1, 2, 0, 2, last_vertex}) append_raw(bytes, std::int32_t{vertex});
  bytes += matrix(0, 0, {}) + matrix(0, 0, {}) + matrix(0, 0, {});
  append_raw(bytes, std::uint64_t{0});  // triangles of the colour model
  append_raw(bytes, std::uint64_t{0});  // texture coordinates
  return bytes;
}

std::string expressions(std::uint64_t count = 1, int rows = 12) {
  std::string bytes;
  append_raw(bytes, count);
  append_raw(bytes, std::uint64_t{4});
  return bytes + "lift" + matrix(rows, 1, Floats(static_cast<std::size_t>(rows), 0.5F));
}

std::function<void(const fs::path&)> pair(const std::string& shape_bytes,
                                          const std::string& expression_bytes) {
  return [=](const fs::path& folder) {
    write_bytes_to(folder / "e/sfm_shape_4.bin", shape_bytes);
    write_bytes_to(folder / "e/expression_blendshapes_4.bin", expression_bytes);
  };
}

}  // namespace

std::vector<BadInput> eos_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& kind, const std::string& shape_bytes,
                          const std::string& expression_bytes, int code,
                          std::vector<std::string> says) {
    add_case(all, kind, "eos", pair(shape_bytes, expression_bytes), "info e --json", code,
             std::move(says));
  };
  const std::string broken = "sfm_shape_4.bin", faces = "expression_blendshapes_4.bin";
  Floats mean = coordinates();
  add("whole", shape(), expressions(), 0, {"\"vertices\": 4"});
  add("empty", "", expressions(), 3, {broken, "ends within the version"});
  add("empty_expressions", shape(), "", 3, {faces, "ends within the number of blendshapes"});
  add("truncated", shape().substr(0, 100), expressions(), 3, {broken, "ends within the basis"});
  add("truncated_expressions", shape(), expressions().substr(0, 40), 3, {faces, "a blendshape"});
  add("other_type", bytes_of(square(), "ply"), expressions(), 3, {broken});
  add("other_version", shape(mean, 3, 4), expressions(), 3, {broken, "version 4", "eos"});
  add("index_out_of_range", shape(mean, 4), expressions(), 3, {broken, "face 1", "vertex 4"});
  add("negative_index", shape(mean, -1), expressions(), 3, {broken, "face 1", "vertex -1"});
  add("a_billion_expressions", shape(), expressions(1'000'000'000), 3, {faces});
  add("negative_count", shape().replace(4, 4, std::string(4, '\xff')), expressions(), 3,
      {broken, "negative size"});
  add("expression_of_other_count", shape(), expressions(1, 9), 3,
      {faces, "'lift' has 3 vertices, expected 4"});
  mean[4] = std::numeric_limits<float>::quiet_NaN();
  add("not_a_number", shape(mean), expressions(), 3, {broken, "the mean", "not finite"});
  mean[4] = std::numeric_limits<float>::infinity();
  add("infinity", shape(mean), expressions(), 3, {broken, "the mean", "not finite"});
  add_case(all, "without_expressions", "eos",
           [](const fs::path& folder) {
             write_bytes_to(folder / "e/sfm_shape_4.bin", shape());
             write_bytes_to(folder / "e/model.json", R"({"shape": "sfm_shape_4.bin"})");
           },
           "info e", 3, {"expression_blendshapes_*.bin"});
  return all;
}

}  // namespace mimetra::test
