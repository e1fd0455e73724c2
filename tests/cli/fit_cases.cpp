#include "tests/cli/bad_input.h"
#include "toolkit/model/blendshape_model.h"

/// Landmarks, mappings, and the coefficients that were fitted to them.
namespace mimetra::test {

namespace {

/// Vertices of the patch, on which the landmarks of these cases lie.
constexpr std::array kVertices = {0, 7, 14, 48, 95, 105, 176, 210, 217, 224};

/// "x,y" of a landmark in frame 0, seen from the side, in an image, whose y points down.
std::array<double, 2> landmark(std::size_t i) {
  static const Positions mean = Patch::model().mean();
  const auto point = mean.row(kVertices.at(i));
  return {30 * point[0] + 10 * point[2], 100 - 30 * point[1] - 20 * point[2]};
}

std::string header(std::size_t count, const std::string& before = "") {
  std::string line = before;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = std::to_string(i);
    line += std::string(line.empty() ? "" : ",") + "x" + number + ",y" + number;
  }
  return line + "\n";
}

std::string row(std::size_t count, const std::string& before = "") {
  std::string line = before;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, y] = landmark(i);
    line += std::string(line.empty() ? "" : ",") + std::to_string(x) + "," + std::to_string(y);
  }
  return line + "\n";
}

const std::string& sound_track() {
  static const std::string text = header(10) + row(10) + row(10);
  return text;
}

std::string sound_mapping() {
  std::string text;
  for (const int vertex : kVertices) text += std::to_string(vertex) + "\n";
  return text;
}

std::string points(std::size_t count, const std::string& claimed) {
  std::string text = "version: 1\nn_points: " + claimed + "\n{\n";
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, y] = landmark(i);
    text += std::to_string(x) + " " + std::to_string(y) + "\n";
  }
  return text + "}\n";
}

using Files = std::vector<std::pair<std::string, std::string>>;

/// The patch with a mapping of its landmarks, and files beside it.
std::function<void(const fs::path&)> mapped(const Files& files,
                                            const std::string& mapping = sound_mapping()) {
  return [=](const fs::path& folder) {
    if (!mapping.empty()) write_bytes_to(folder / "head/landmarks68.txt", mapping);
    for (const auto& [name, bytes] : files) write_bytes_to(folder / name, bytes);
  };
}

constexpr const char* kTrack = "fit t.csv --model head -o o.npy --json";

void add_tracks(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const std::string& text, int code,
                          std::vector<std::string> says,
                          const std::string& mapping = sound_mapping()) {
    if (code != 0) says.push_back("t.csv");
    add_case(all, kind, "landmarks_csv", mapped({{"t.csv", text}}, mapping), kTrack, code, says);
  };
  add_case(all, "missing", "landmarks_csv", mapped({}), kTrack, 3, {"t.csv", "no such file"});
  add("whole", sound_track(), 0, {"\"rms_px\""});
  add("empty", "", 3, {"is empty"});
  add("names_only", header(10), 3, {"no frame"});
  add("truncated", sound_track().substr(0, sound_track().rfind(',')), 3, {"line 3", "fields"});
  add("other_type", bytes_of(square(), "stl_binary"), 3, {});
  add("x_without_y", "x0,x1,y0\n1,2,3\n", 3, {"no column 'y' for 'x1'"});
  add("text_for_a_number", header(1) + "1,high\n", 3, {"line 2", "'y0'", "'high'"});
  add("infinity", header(1) + "1,inf\n", 3, {"line 2", "'y0'", "finite"});
  add("times_fall", header(10, "time") + row(10, "1") + row(10, "0.5"), 3, {"line 3", "ascend"});
  add("windows_lines_and_bom", "\xEF\xBB\xBF" + header(10) + row(10) + "\r\n", 0, {"\"alpha\""});
  add("too_few", header(3) + row(3), 4, {"frame 0", "at least 4"}, "0\n7\n14\n");
  add("all_at_one_place", header(4) + "1,1,1,1,1,1,1,1\n", 4, {"frame 0", "at one place"},
      "0\n7\n14\n48\n");
  add("nothing_seen", header(2) + ",,,\n", 4, {"no frame has landmarks"}, "0\n7\n");
  add("fewer_than_the_mapping", header(9) + row(9), 4,
      {"landmark '10'", "only 1 to 9", "another set of landmarks"});
  add("frames_that_repeat", header(10, "frame") + row(10, "5") + row(10, "5"), 3,
      {"line 3", "frame 5 follows 5", "a column 'time'"});
  add("frames_that_jump", header(10, "frame") + row(10, "0") + row(10, "1") + row(10, "5"), 0,
      {"no row has these frames: 2 to 4"});
  add("confidence_in_percent", header(10, "confidence") + row(10, "95"), 3,
      {"line 2", "outside [0, 1]"});
  add("nothing_trusted", header(10, "confidence") + row(10, "0.01"), 4, {"no frame has landmarks"});
  add("one_frame_unseen", sound_track() + std::string(19, ',') + "\n", 0, {"\"rms_px\": null"});
}

void add_points(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const Files& files, const std::string& name,
                          int code, std::vector<std::string> says) {
    add_case(all, kind, "landmarks_pts", mapped(files),
             "fit " + name + " --model head -o o.npy --json", code, std::move(says));
  };
  add("missing", {}, "p.pts", 3, {"p.pts", "no such file"});
  add("whole", {{"p.pts", points(10, "10")}}, "p.pts", 0, {"\"rms_px\""});
  add("empty", {{"p.pts", ""}}, "p.pts", 3, {"p.pts", "'version:'"});
  add("truncated", {{"p.pts", points(10, "10").substr(0, 90)}}, "p.pts", 3, {"p.pts"});
  add("other_type", {{"p.pts", bytes_of(square(), "ply")}}, "p.pts", 3, {"p.pts", "'version:'"});
  add("negative_count", {{"p.pts", points(10, "-10")}}, "p.pts", 3, {"p.pts", "n_points is -10"});
  add("a_billion_points", {{"p.pts", points(10, "1000000000")}}, "p.pts", 3, {"n_points"});
  add("other_count", {{"p/1.pts", points(10, "10")}, {"p/2.pts", points(9, "9")}}, "p", 4,
      {"p/2.pts: 9 landmarks, expected 10", "p/1.pts"});
  add("empty_folder", {{"p/readme.txt", ""}}, "p", 3, {"p: holds no .pts file and no image"});
  add("nothing_matches", {}, "p_%03d.pts", 3, {"p_%03d.pts: matches no .pts file"});
  add("other_extension", {{"p.txt", points(10, "10")}}, "p.txt", 3,
      {"landmarks can be read from .png", ".pts, .csv, .json or a folder"});
  add("beyond_the_last", {{"p/1.pts", points(10, "10")}}, "p --frames 0:2", 4, {"has 1 frame"});
  add("beside_images", {{"p/1.pts", points(10, "10")}, {"p/1.png", "not read"}}, "p", 0,
      {"\"rms_px\""});
}

void add_json(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const std::string& text, int code,
                          std::vector<std::string> says) {
    add_case(all, kind, "landmarks_json", mapped({{"t.json", text}}),
             "fit t.json --model head -o o.npy --json", code, std::move(says));
  };
  add("empty", "", 3, {"t.json", "JSON"});
  add("truncated", R"({"points": [[1, 2], [3)", 3, {"t.json", "JSON"});
  add("other_type", "[1, 2]", 3, {"t.json: /0: expected a list of points"});
  add("text_for_a_number", R"({"points": [[1, "2"]]})", 3, {"/points/0: expected a finite number"});
  add("four_coordinates", R"({"points": [[1, 2, 3, 4]]})", 3, {"/points/0: expected [x, y]"});
  add("other_count", R"({"frames": [{"points": [null]}, {"points": [null, null]}]})", 3,
      {"/frames/1/points", "expected 1"});
  add("unknown_names", R"({"names": ["a"], "frames": [{"points": [[1, 2]]}]})", 4,
      {"none of the 1 landmarks", "'a'"});
}

void add_videos(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const std::string& bytes) {
    add_case(all, kind, "landmarks_video", mapped({{"v.mp4", bytes}}),
             "fit v.mp4 --model head -o o.npy", 3, {"v.mp4: "});
  };
  add_case(all, "missing", "landmarks_video", mapped({}), "fit v.mp4 --model head -o o.npy", 3,
           {"v.mp4: no such file"});
  add("empty", "");
  add("other_type", bytes_of(square(), "ply"));
  add("list_of_files", "#EXTM3U\n#EXT-X-TARGETDURATION:1\n#EXTINF:1,\nfile:///etc/hostname\n");
}

void add_mappings(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const std::string& text, int code,
                          std::vector<std::string> says) {
    add_case(all, kind, "mapping", mapped({{"t.csv", sound_track()}, {"m.txt", text}}, ""),
             "fit t.csv --model head --mapping m.txt -o o.npy --json", code, std::move(says));
  };
  add_case(all, "missing", "mapping", mapped({{"t.csv", sound_track()}}, ""),
           "fit t.csv --model head --mapping m.txt -o o.npy", 3, {"m.txt", "no such file"});
  add_case(all, "missing_in_the_model", "mapping", mapped({{"t.csv", sound_track()}}, ""), kTrack,
           3, {"head", "no landmark mapping", "ibug_to_*.txt or landmarks68.txt", "--mapping"});
  add_case(all, "several", "mapping",
           mapped({{"t.csv", sound_track()}, {"head/ibug_to_head.txt", sound_mapping()}}), kTrack,
           3, {"several landmark mappings", "--mapping"});
  add("whole", sound_mapping(), 0, {"\"rms_px\""});
  add("empty", "", 3, {"m.txt", "maps no landmark"});
  add("text_for_a_number", "1\nnose\n", 3, {"m.txt", "line 2", "nose"});
  add("negative_index", "1\n-2\n", 3, {"m.txt", "line 2", "-2"});
  add("index_out_of_range", "225\n" + sound_mapping().substr(2), 4, {"vertex 225", "0 to 224"});
  add("coplanar", "0\n14\n105\n119\n210\n224\n30\n44\n60\n", 4, {"frame 0", "coplanar"});
}

/// A fit of one frame, as `fit` would have written it.
std::string fitted(const std::string& identity = "wide", const std::string& alpha = "0.5",
                   const std::string& beta = "0.1, 0, 1") {
  return "{\"identities\": [\"" + identity +
         "\"], \"expressions\": [\"left\", \"right\", \"top\"],\n\"frames\": [{\"time\": 0, "
         "\"rms_px\": 1, \"landmarks\": 5, \"iterations\": 2, \"alpha\": [" +
         alpha + "], \"beta\": [" + beta + "], \"camera\": [[1, 0, 0, 0], [0, 1, 0, 0]]}]}";
}

void add_fits(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const std::string& text, int code,
                          std::vector<std::string> says) {
    if (code != 0) says.push_back("f.json");
    add_case(all, kind, "fit_json", file("f.json", text), "info head@f.json --json", code,
             std::move(says));
  };
  add_case(all, "missing", "fit_json", {}, "info head@f.json", 3, {"f.json", "no such file"});
  add("whole", fitted(), 0, {"\"frames\": 1"});
  add("windows_lines_and_bom", "\xEF\xBB\xBF" + fitted() + "\r\n", 0, {"\"frames\": 1"});
  add("empty", "", 3, {"JSON"});
  add("truncated", fitted().substr(0, 100), 3, {"JSON"});
  add("other_type", "[]", 3, {"`mimetra fit`"});
  add("of_another_command", "{\"frames\": 12}", 3, {"/identities"});
  add("not_a_number", fitted("wide", "null"), 3, {"/frames/0/alpha/0", "finite"});
  add("too_few_numbers", fitted("wide", "1", "0, 1"), 3, {"/frames/0/beta", "expected 3 numbers"});
  add("of_another_model", fitted("broad"), 4, {"'broad'", "'wide'", "another model"});
  add_case(all, "of_no_model", "fit_json",
           [](const fs::path& folder) {
             write_bytes_to(folder / "f.json", fitted());
             write_bytes_to(folder / "one.obj", bytes_of(square(), "obj"));
           },
           "transfer head one.obj@f.json --weights take.csv --full -o o.npy", 4,
           {"one.obj", "one mesh"});
}

void add_requests(std::vector<BadInput>& all) {
  const Files track = {{"t.csv", sound_track()}};
  const auto add = [&](const std::string& kind, const std::string& arguments, int code,
                       std::vector<std::string> says, const Files& more = {}) {
    Files files = track;
    files.insert(files.end(), more.begin(), more.end());
    add_case(all, kind, "fit", mapped(files), "fit " + arguments, code, std::move(says));
  };
  add("without_model", "t.csv -o o", 2, {"--model", "required"});
  add("without_output", "t.csv --model head", 2, {"--out", "required"});
  add("no_iterations", "t.csv --model head -o o --iterations 0", 2, {"--iterations", "1"});
  add("unknown_solver", "t.csv --model head -o o --solver newton", 2, {"joint", "alternating"});
  add("no_noise", "t.csv --model head -o o --sigma 0", 2, {"--sigma"});
  add("perspective_from_nowhere", "t.csv --model head -o o --camera perspective", 2,
      {"--camera", "--focal-length"});
  add("focal_length_of_another_camera", "t.csv --model head -o o --focal-length 900", 2,
      {"--focal-length", "--camera perspective"});
  add("orthographic_and_alternating",
      "t.csv --model head -o o --solver alternating --camera "
      "orthographic",
      2, {"--camera", "--solver joint"});
  add("resisting_and_alternating", "t.csv --model head -o o --solver alternating --outliers resist",
      2, {"--outliers", "--solver joint"});
  add("repeated_and_alternating", "t.csv --model head -o o --solver alternating --repeated 0.5", 2,
      {"--repeated", "--solver joint"});
  add("frames_beyond", "t.csv --model head -o o --frames 5:", 4, {"2 frames"});
  add("missing_model", "t.csv --model no -o o", 3, {"no: does not exist"});
  add("no_model", "t.csv --model t.csv -o o", 3, {"t.csv: ", "model can be read from .glb"});
  add("several_frames_into_a_mesh", "t.csv --model head -o o.obj", 4, {"2 frames"});
  add("overlay_without_images", "t.csv --model head -o o --overlay v", 2,
      {"--overlay: t.csv has no images", "--images"});
  add("images_that_are_missing", "t.csv --model head -o o --strip v.png --images i/*.png", 3,
      {"i/*.png: matches no PNG or JPEG file"});
  add("too_few_images", "t.csv --model head -o o --strip v.png --images a.png", 4,
      {"a.png: 1 images, expected one for each of the 2 frames of t.csv"}, {{"a.png", ""}});
  add("existing_coefficients", "t.csv --model head -o o", 5, {"o.fit.json", "exists"},
      {{"o.fit.json", "{}"}});
  add("existing_coefficients_forced", "t.csv --model head -o o --force", 0, {"2 frames"},
      {{"o.fit.json", "{}"}});
  add("unwritable_coefficients", "t.csv --model head -o o --fit-out o.txt", 2, {".json"});
}

}  // namespace

std::vector<BadInput> fit_cases() {
  std::vector<BadInput> all;
  add_tracks(all);
  add_points(all);
  add_json(all);
  add_videos(all);
  add_mappings(all);
  add_fits(all);
  add_requests(all);
  return all;
}

}  // namespace mimetra::test
