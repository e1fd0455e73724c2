#include <limits>

#include "tests/cli/bad_input.h"

/// Folders and patterns of frames: what later frames may not do.
namespace mimetra::test {

namespace {

using Change = std::function<void(RawMesh&)>;

/// Three frames of the moving square; `change` works on the third.
std::function<void(const fs::path&)> take(const std::string& format, const Change& change) {
  return [format, change](const fs::path& folder) {
    for (int frame = 0; frame < 3; ++frame) {
      RawMesh mesh = square(0.1 * frame);
      if (change && frame == 2) change(mesh);
      const std::string name = "f" + std::to_string(frame) + "." + extension_of(format);
      write_bytes_to(folder / "take" / name, bytes_of(mesh, format));
    }
  };
}

void add_frames(std::vector<BadInput>& all, const std::string& format) {
  const std::string third = "f2." + extension_of(format), first = "f0." + extension_of(format);
  const bool is_stl = extension_of(format) == "stl";
  const auto add = [&](const std::string& kind, const Change& change, int code,
                       std::vector<std::string> says) {
    add_case(all, kind, "frames_" + format, take(format, change), "info take --json", code,
             std::move(says));
  };
  add("one_vertex_more_later",
      [](RawMesh& mesh) {
        mesh.vertices.push_back({2, 2, 2});
        mesh.faces.push_back({1, 4, 2});
      },
      4, {third, is_stl ? "3 triangles, expected 2" : "5 vertices, expected 4", first});
  add("flipped_faces_later",
      [](RawMesh& mesh) {
        for (auto& face : mesh.faces) std::swap(face[1], face[2]);
      },
      4, {third, first});
  add("truncated_later",
      [](RawMesh& mesh) { mesh.vertices[3][2] = std::numeric_limits<double>::quiet_NaN(); }, 3,
      {third});
  if (is_stl) return;
  add("other_faces_later",
      [](RawMesh& mesh) {
        mesh.faces = {{0, 1, 3}, {1, 2, 3}};
      },
      4, {third, "expected 1 2 3 as in", first});
  all.back().says[1] = format == "obj" ? "expected 1 2 3 as in" : "expected 0 1 2 as in";
  add("crossed_polygon_instead_later",
      [](RawMesh& mesh) {
        mesh.faces = {{0, 2, 1, 3}};
      },
      4, {third, "1 faces, expected 2", first});
}

void add_stray_files(std::vector<BadInput>& all) {
  const auto with = [](const std::string& name, const std::string& bytes) {
    return [name, bytes](const fs::path& folder) {
      take("obj", {})(folder);
      write_bytes_to(folder / "take" / name, bytes);
    };
  };
  add_case(all, "temporary_file_of_a_killed_run", "frames_obj", with(".f3.obj.123-0.tmp", "half"),
           "info take --json", 0, {"\"frames\": 3"});
  add_case(all, "hidden_mesh", "frames_obj", with("._f3.obj", "resource fork"), "info take --json",
           0, {"\"frames\": 3"});
  add_case(all, "text_beside", "frames_obj", with("notes.txt", "hello"), "info take --json", 0,
           {"\"frames\": 3"});
  add_case(all, "two_formats", "frames_obj", with("f3.ply", bytes_of(square(), "ply")), "info take",
           3, {"take", "several formats", "pattern"});
  add_case(all, "neutral_among_frames", "frames_obj",
           with("neutral.obj", bytes_of(square(), "obj")), "check take --json", 0,
           {"neutral.obj: is taken for the rest pose of the other 3 files"});
  RawMesh other = square();
  other.faces.pop_back();
  add_case(all, "neutral_of_other_faces", "frames_obj", with("neutral.obj", bytes_of(other, "obj")),
           "info take", 4, {"neutral.obj", "1 faces, expected 2"});
  add_case(all, "stranger_of_other_faces", "frames_obj", with("teeth.obj", bytes_of(other, "obj")),
           "check take --json", 0, {"teeth.obj is left out of the 3 frames f*.obj"});
  add_case(all, "missing_number", "frames_obj", with("f5.obj", bytes_of(square(), "obj")),
           "check take --json", 0, {"no file has these numbers: 3 to 4"});
  add_case(all, "two_files_of_one_number", "frames_obj", with("f02.obj", bytes_of(square(), "obj")),
           "info take", 3, {"take/f", "has the number of f", ", 2;"});
  add_case(all, "link_that_leads_nowhere", "frames_obj",
           [](const fs::path& folder) {
             take("obj", {})(folder);
             fs::create_symlink("gone.obj", folder / "take/f3.obj");
           },
           "info take", 3, {"take/f3.obj", "leads nowhere, to gone.obj"});
  add_case(all, "padded_pattern_for_unpadded_files", "frames_obj", take("obj", {}),
           "info take/f%04d.obj", 3,
           {"take/f%04d.obj: matches no file; 'take/f%d.obj' matches f0.obj to f"});
  add_case(all, "rest_of_other_faces", "frames_obj",
           [](const fs::path& folder) {
             take("obj", {})(folder);
             RawMesh rest = square();
             rest.faces.pop_back();
             write_bytes_to(folder / "take.rest.ply", bytes_of(rest, "ply"));
           },
           "info take", 4, {"take.rest.ply", "1 faces, expected 2"});
}

}  // namespace

std::vector<BadInput> sequence_cases() {
  std::vector<BadInput> all;
  for (const std::string format : {"obj", "ply", "ply_binary", "off", "stl", "stl_binary"}) {
    add_frames(all, format);
  }
  add_stray_files(all);
  const auto empty_folder = [](const fs::path& folder) { fs::create_directory(folder / "none"); };
  add_case(all, "empty_folder", "frames", empty_folder, "info none", 3,
           {"none: holds no PLY, OBJ, OFF, STL or OM file"});
  add_case(all, "missing", "frames", {}, "info nowhere", 3, {"nowhere", "no such"});
  add_case(all, "pattern_without_match", "frames", {}, "info 'no_%04d.obj'", 3,
           {"no_%04d.obj: matches no"});
  add_case(all, "unknown_format", "frames", file("take.fbx", "x"), "info take.fbx", 3,
           {"take.fbx", ".npz, .pc2, .mdd", " or a folder"});
  add_case(all, "video", "frames", file("take.mp4", "x"), "info take.mp4", 3,
           {"take.mp4: is a video", "mimetra fit VIDEO"});
  add_case(all, "beyond_single_precision", "frames",
           file("huge.obj", "v 0 0 0\nv 1e39 0 0\nv 0 1e39 0\nf 1 2 3\n"),
           "convert huge.obj -o huge.stl", 4,
           {"huge.stl: vertex 1 is at 1e+39", "double precision"});
  add_case(all, "index_beyond_an_int", "frames",
           file("far.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2147483648\n"), "info far.obj", 3,
           {"far.obj: line 4: index 2147483648"});
  add_case(all, "frames_beyond_the_end", "frames", take("obj", {}), "info take --frames 1:9", 4,
           {"1:9", "3 frames"});
  add_case(all, "weights_for_meshes", "frames", take("obj", {}), "info take --weights take.csv", 4,
           {"take", "no model"});
  return all;
}

}  // namespace mimetra::test
