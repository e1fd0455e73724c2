#include <limits>

#include "tests/cli/bad_input.h"

/// Every class of a bad mesh in every mesh format.
namespace mimetra::test {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool has_indices(const std::string& format) {
  return extension_of(format) != "stl";
}

bool has_counts(const std::string& format) {
  return format != "obj" && format != "stl";
}

class MeshCases {
 public:
  explicit MeshCases(std::string format)
      : format_(std::move(format)), name_("bad." + extension_of(format_)) {}

  std::vector<BadInput> all() {
    add("missing", {}, 3, {"no such file"});
    add_bytes("empty", "", 3, {});
    add_bytes("truncated", truncated(), 3, {});
    add_bytes("other_type", "\x89PNG\r\n\x1a\n" + std::string(200, '\0'), 3, {});
    add_positions();
    add_faces();
    if (has_counts(format_)) add_counts();
    if (has_indices(format_)) add_indices();
    return std::move(cases_);
  }

 private:
  void add(const std::string& kind, std::function<void(const fs::path&)> make, int code,
           std::vector<std::string> says) {
    if (code != 0) says.push_back(name_);
    add_case(cases_, kind, format_, std::move(make), "info " + name_ + " --json", code,
             std::move(says));
  }
  void add_bytes(const std::string& kind, const std::string& bytes, int code,
                 std::vector<std::string> says) {
    add(kind, file(name_, bytes), code, std::move(says));
  }
  void add_mesh(const std::string& kind, const RawMesh& mesh, int code,
                std::vector<std::string> says) {
    add_bytes(kind, bytes_of(mesh, format_), code, std::move(says));
  }

  /// Within the vertices: what follows them is lost in any case.
  std::string truncated() const {
    const std::string whole = bytes_of(square(), format_);
    if (format_ == "obj") return whole.substr(0, 20);
    return whole.substr(0, whole.size() - (format_ == "stl_binary" ? 10 : 30));
  }

  void add_positions() {
    RawMesh mesh = square();
    mesh.vertices[2][1] = kNan;
    add_mesh("not_a_number", mesh, 3, {"no usable position", "y is"});
    mesh.vertices[2][1] = kInfinity;
    add_mesh("infinity", mesh, 3, {"no usable position", "y is inf"});
  }

  void add_faces() {
    RawMesh mesh = square();
    mesh.faces.clear();
    add_mesh("no_faces", mesh, 3, {"has no faces"});
    mesh.faces = {{0, 1, 2}, {0, 2}};
    // A binary STL has room for three corners and no others.
    if (format_ != "stl_binary") add_mesh("two_corners", mesh, 3, {});
    mesh = square();
    for (auto& point : mesh.vertices) point[1] = point[2] = 0;
    for (std::size_t i = 0; i < 4; ++i) mesh.vertices[i][0] = static_cast<double>(i);
    if (has_indices(format_)) mesh.faces = {{0, 1, 2, 3}};
    add_mesh("all_on_one_line", mesh, 0, {"\"degenerate_triangles\": 2", "\"vertices\": 4"});
    mesh = square();
    mesh.faces = {{0, 1, 2}, {0, 2, 3}, {1, 1, 2}};
    add_mesh("repeated_index", mesh, 0, {"\"degenerate_triangles\": 1", "\"vertices\": 4"});
  }

  void add_counts() {
    RawMesh mesh = square();
    mesh.more_faces = 1;
    add_mesh("one_face_too_many", mesh, 3, {});
    mesh.more_faces = -1;
    add_mesh("one_face_too_few", mesh, 3, {});
    mesh.more_faces = 1'000'000'000;
    add_mesh("a_billion_faces", mesh, 3, {"1000000002"});
    if (!has_indices(format_)) return;
    mesh.more_faces = 0;
    mesh.more_vertices = 1;
    add_mesh("one_vertex_too_many", mesh, 3, {});
    mesh.more_vertices = -1;
    add_mesh("one_vertex_too_few", mesh, 3, {});
    mesh.more_vertices = -5;
    add_mesh("negative_count", mesh, 3, {});
  }

  void add_indices() {
    const bool from_one = format_ == "obj";
    RawMesh mesh = square();
    mesh.faces[1][2] = 4;
    add_mesh(
        "index_out_of_range", mesh, 3,
        {"face", from_one ? "uses vertex 5, expected 1 to 4" : "uses vertex 4, expected 0 to 3"});
    mesh.faces[1][2] = -99;
    add_mesh("negative_index", mesh, 3, {"-99"});
    mesh = square();
    mesh.vertices.push_back({5, 5, 5});
    add_mesh("vertex_without_face", mesh, 0, {"\"vertices\": 5", "\"vertices_without_face\": 1"});
  }

  std::string format_;
  std::string name_;
  std::vector<BadInput> cases_;
};

std::string with_windows_lines(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return result;
}

}  // namespace

std::vector<BadInput> mesh_cases() {
  std::vector<BadInput> all;
  for (const std::string format : {"obj", "ply", "ply_binary", "off", "stl", "stl_binary"}) {
    for (BadInput& bad : MeshCases(format).all()) all.push_back(std::move(bad));
  }
  for (const std::string format : {"obj", "ply", "off", "stl"}) {
    const std::string name = "windows." + format;
    add_case(all, "windows_lines_and_bom", format,
             file(name, "\xEF\xBB\xBF" + with_windows_lines(bytes_of(square(), format))),
             "info " + name + " --json", 0, {"\"vertices\": 4", "\"triangles\": 2"});
  }
  return all;
}

}  // namespace mimetra::test
