#include "tests/cli/bad_input.h"
#include "tests/cli/matched_patch.h"

/// Markers and correspondences for a target of other faces.
namespace mimetra::test {

namespace {

constexpr const char* kTransfer = "transfer head --weights take.csv small.obj --full -o x.npy ";

/// Writes the target, and markers.
std::function<void(const fs::path&)> markers(const std::string& text) {
  return [text](const fs::path& folder) {
    write_bytes_to(folder / "small.obj", small_patch());
    write_bytes_to(folder / "m.txt", text);
  };
}

/// Each marker of the source with its mirror image: a patch is as good as flat, and only a lifted
/// corner tells.
std::string exchanged_sides() {
  std::string text;
  for (const int y : {0, 3, 7}) {
    for (const int x : {0, 3, 7}) {
      text += std::to_string(30 * y + 2 * x) + ' ' + std::to_string(8 * y + 7 - x) + '\n';
    }
  }
  return text;
}

std::function<void(const fs::path&)> correspondence(const std::string& text) {
  return [text](const fs::path& folder) {
    write_bytes_to(folder / "small.obj", small_patch());
    write_bytes_to(folder / "c.json", text);
  };
}

}  // namespace

std::vector<BadInput> match_cases() {
  const std::string by_markers = std::string(kTransfer) + "--markers m.txt";
  const std::string by_pairs = std::string(kTransfer) + "--correspondence c.json";
  const auto refused = [&](const std::string& kind, const std::string& text, int code,
                           std::vector<std::string> says, const std::string& more = "") {
    return BadInput{kind, "transfer", markers(text), by_markers + more, code, std::move(says)};
  };
  const std::string right = patch_markers(0);
  return {
      refused("marker_out_of_range", right + "20 64\n", 4,
              {"small: marker 10: vertex 64 of the target", "vertices 0 to 63"}),
      refused("marker_twice", right + "0 20\n", 4,
              {"marker 10: vertex 0 of the source is in marker 1 too"}),
      refused("markers_too_few", "0 0\n14 7\n210 56\n", 4, {"3 markers, expected at least 4"}),
      refused("markers_in_a_plane", "0 0\n4 2\n8 4\n14 7\n", 4, {"in one plane of the source"}),
      refused("markers_from_1_as_from_0", patch_markers(1), 4,
              {"vertex 225 of the source", "counted from 1", "--index-base 1"}),
      refused("markers_from_0_as_from_1", right, 3, {"m.txt", "line 1"}, " --index-base 1"),
      refused("markers_with_left_and_right_exchanged", exchanged_sides(), 4,
              {"small: the markers fit a mirror image of the source", "exchange them"}),
      refused("ignored_files_of_given_markers", right, 2,
              {"--ignore-files: nothing is looked for with --markers"}, " --ignore-files"),
      refused("markers_without_pairs", "# nothing\n", 3, {"m.txt"}),
      refused(
          "marker_files_of_too_many_targets", right, 2,
          {"--markers: 2 files or words (auto), expected one for all targets or one for each of 1"},
          ",m.txt"),
      refused("index_base_2", right, 2, {"index-base"}, " --index-base 2"),
      refused("markers_and_correspondence", right, 2, {"--markers: --correspondence tells"},
              " --correspondence m.txt"),
      {"index_base_alone",
       "transfer",
       markers(right),
       std::string(kTransfer) + "--index-base 1",
       2,
       {"--index-base", "without --markers"}},
      {"other_faces_without_markers",
       "transfer",
       markers(right),
       kTransfer,
       4,
       {"small: 64 vertices, expected 225 as in the source", "--markers FILE",
        "--correspondence FILE"}},
      {"other_faces_without_markers",
       "evaluate",
       markers(right),
       "evaluate head --weights take.csv small.obj -k 2",
       4,
       {"--markers FILE"}},
      {"no_face",
       "markers",
       markers(right),
       "markers head small.obj -o x.markers",
       4,
       {"head: no face was found", "pair vertices of both heads by hand"}},
      {"correspondence_of_another_mesh",
       "transfer",
       correspondence(R"({"source": {"vertices": 3, "triangles": 1, "faces": "0"},
                          "target": {"vertices": 3, "triangles": 1, "faces": "0"},
                          "partners": [[0, 1]], "residuals": [0]})"),
       by_pairs,
       4,
       {"c.json: made for a source of 3 vertices and 1 triangles"}},
      {"correspondence_truncated",
       "transfer",
       correspondence(R"({"source": {"vert)"),
       by_pairs,
       3,
       {"c.json"}},
      {"correspondence_missing", "transfer", markers(right), by_pairs, 3, {"c.json"}},
  };
}

}  // namespace mimetra::test
