#include "tests/cli/bad_input.h"
#include "tests/image_bytes.h"

/// Paintings of a mesh of 225 vertices, which has no texture coordinates.
namespace mimetra::test {

namespace {

std::string weights_of(int count, const std::string& weight) {
  std::string text;
  for (int i = 0; i < count; ++i) text += weight + '\n';
  return text;
}

class PaintCases {
 public:
  void add(const std::string& extension, const std::string& kind, const std::string& bytes,
           int code, std::vector<std::string> says) {
    add_made(extension, kind, file("p." + extension, bytes), code, std::move(says));
  }
  void add_made(const std::string& extension, const std::string& kind,
                std::function<void(const fs::path&)> make, int code,
                std::vector<std::string> says) {
    const std::string name = "p." + extension;
    if (code != 0) says.push_back(name);
    add_case(all, kind, "paint_" + extension, std::move(make),
             "transfer head --weights take.csv head --paint " + name + " -o x.npy --json", code,
             std::move(says));
  }
  std::vector<BadInput> all;
};

/// The same picture for a patch whose texture is all of it.
BadInput on_textured_patch(const std::string& kind, const std::string& bytes, int code,
                           std::vector<std::string> says) {
  const auto make = [bytes](const fs::path& folder) {
    write_bytes_to(folder / "p.png", bytes);
    for (const char* const height : {"0", "1"}) {
      write_bytes_to(folder / "patch" / (std::string(height) + ".obj"),
                     "v 0 0 0\nv 1 0 0\nv 1 1 " + std::string(height) +
                         "\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 "
                         "4/4\n");
    }
  };
  return {kind, "paint_png",    make, "transfer patch patch/0.obj --paint p.png -o x.npy --json",
          code, std::move(says)};
}

void add_lists(PaintCases& cases) {
  cases.add("txt", "other_type", "\x89PNG\r\n", 3, {"line 1", "a weight"});
  cases.add("txt", "other_vertex_count", weights_of(224, "1"), 4,
            {"weights of 224 vertices, expected 225"});
  cases.add("txt", "not_a_number", weights_of(224, "1") + "nan\n", 3, {"vertex 224", "nan"});
  cases.add("txt", "all_zero", weights_of(225, "0"), 3, {"no vertex has a weight above 0"});
  cases.add("txt", "in_percent", weights_of(225, "80"), 3, {"vertex 0", "80", "by 100"});
  cases.add("txt", "in_bytes", weights_of(225, "128"), 3, {"vertex 0", "128", "by 255"});
  cases.add("txt", "negative", weights_of(225, "-0.5"), 3, {"vertex 0", "-0.5", "0 to 1"});
  cases.add("txt", "windows_lines_and_bom", "\xEF\xBB\xBF# all\r\n" + weights_of(225, "1\r"), 0,
            {"\"targets\""});
  cases.add("csv", "other_type", bytes_of(square(), "stl_binary"), 3, {});
  cases.add("csv", "ragged_rows", "vertex,weight\n3\n", 3, {"line 2"});
  cases.add("csv", "names_only", "vertex,weight\n", 3, {"no vertex has a weight above 0"});
  cases.add("csv", "other_columns", "vertex,region\n3,0\n", 3, {"vertex,weight"});
  cases.add("csv", "index_out_of_range", "vertex,weight\n225,1\n", 4, {"vertex 225", "0 to 224"});
  cases.add("csv", "negative_index", "vertex,weight\n-1,1\n", 4, {"vertex -1"});
  cases.add("csv", "twice", "vertex,weight\n3,1\n3,1\n", 3, {"line 3", "occurs twice"});
  cases.add("csv", "decimal_commas", "vertex,weight\n3,0,5\n", 3, {"line 2"});
  cases.add("csv", "windows_lines_and_bom", "\xEF\xBB\xBFvertex,weight\r\n48,1\r\n49,0.5\r\n", 0,
            {"\"targets\""});
}

}  // namespace

std::vector<BadInput> paint_cases() {
  PaintCases cases;
  for (const std::string extension : {"txt", "csv", "png"}) {
    cases.add_made(extension, "missing", {}, 3, {"no such file"});
  }
  cases.add("txt", "empty", "", 4, {"weights of 0 vertices"});
  cases.add("csv", "empty", "", 3, {});
  add_lists(cases);
  cases.add("tga", "unknown_format", "x", 3, {".png", ".jpg", ".csv", ".txt"});
  const std::string white = png_bytes(4, 4, PNG_FORMAT_GRAY, std::vector<std::uint8_t>(16, 255));
  cases.add("png", "without_texture", white, 4, {"no texture coordinates", "vertex field"});
  cases.all.push_back(on_textured_patch("whole", white, 0, {"\"targets\""}));
  cases.all.push_back(
      on_textured_patch("truncated", white.substr(0, white.size() / 2), 3, {"p.png", "truncated"}));
  cases.all.push_back(on_textured_patch("other_type", "v 0 0 0\n", 3, {"p.png", "PNG or JPEG"}));
  cases.all.push_back(on_textured_patch(
      "all_black", png_bytes(4, 4, PNG_FORMAT_GRAY, std::vector<std::uint8_t>(16, 0)), 3,
      {"p.png", "no vertex has a weight above 0"}));
  return cases.all;
}

}  // namespace mimetra::test
