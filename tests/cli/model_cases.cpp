#include "tests/cli/bad_input.h"

/// Model folders, model.json and the weights that drive them.
namespace mimetra::test {

namespace {

/// A model of the square with one expression, changed before it is used.
std::function<void(const fs::path&)> model(const std::function<void(const fs::path&)>& change) {
  return [change](const fs::path& folder) {
    const fs::path model = folder / "m";
    write_bytes_to(model / "neutral.obj", bytes_of(square(), "obj"));
    write_bytes_to(model / "expressions/lift.obj", bytes_of(square(1), "obj"));
    write_bytes_to(model / "identities/wide.obj", bytes_of(square(0.5), "obj"));
    if (change) change(model);
  };
}

std::function<void(const fs::path&)> model_json(const std::string& text) {
  return model([text](const fs::path& model) { write_bytes_to(model / "model.json", text); });
}

std::string flipped_square() {
  RawMesh mesh = square();
  for (auto& face : mesh.faces) std::swap(face[1], face[2]);
  return bytes_of(mesh, "obj");
}

std::function<void(const fs::path&)> weights(const std::string& text) {
  return file("w.csv", text);
}

}  // namespace

std::vector<BadInput> model_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& kind, const std::function<void(const fs::path&)>& make,
                          const std::string& arguments, int code, std::vector<std::string> says) {
    add_case(all, kind, "model", make, arguments, code, std::move(says));
  };
  const auto write = [](const std::string& name, const std::string& bytes) {
    return model([name, bytes](const fs::path& m) { write_bytes_to(m / name, bytes); });
  };
  const auto remove = [](const std::string& name) {
    return model([name](const fs::path& m) { fs::remove_all(m / name); });
  };
  RawMesh five = square();
  five.vertices.push_back({2, 2, 2});
  add("missing", {}, "transfer head --weights take.csv nobody -o x", 3, {"nobody", "no such"});
  add("empty_folder", [](const fs::path& folder) { fs::create_directory(folder / "m"); },
      "transfer head --weights take.csv m -o x", 3, {"m: is no model", "neutral"});
  add("without_neutral", remove("neutral.obj"), "transfer head --weights take.csv m -o x", 3,
      {"m: is no model"});
  add("empty_neutral", write("neutral.obj", ""), "info m", 3, {"neutral.obj", "is empty"});
  add("truncated", write("expressions/lift.obj", "v 0 0 0\nv 1 0"), "info m", 3, {"lift.obj"});
  add("no_expression_file",
      model([](const fs::path& m) { fs::remove(m / "expressions/lift.obj"); }), "info m", 3,
      {"expressions", "holds no .obj"});
  add("expression_of_other_count", write("expressions/lift.obj", bytes_of(five, "obj")), "info m",
      4, {"lift.obj", "5 vertices, expected 4", "neutral.obj"});
  add("flipped_expression", write("expressions/lift.obj", flipped_square()), "info m", 4,
      {"lift.obj", "face 1", "neutral.obj"});
  add("flipped_identity", write("identities/wide.obj", flipped_square()), "info m", 4,
      {"wide.obj", "face 1", "neutral.obj"});
  add("two_of_one_name", write("expressions/lift.ply", bytes_of(square(1), "ply")), "info m", 3,
      {"lift"});
  add("unknown_identity", model({}), "info m@tall=1", 4, {"no identity 'tall'", "wide"});
  add("identity_without_number", model({}), "info m@wide=big", 2, {"wide=big", "NAME=NUMBER"});
  add("identity_twice", model({}), "info m@wide=1,wide=2", 2, {"given twice"});
  add("identity_of_a_mesh", file("one.obj", bytes_of(square(), "obj")), "info one.obj@wide=1", 3,
      {"one.obj", "no model"});
  add("temporary_file_beside", write("expressions/.lift.obj.9-1.tmp", "half"), "info m --json", 0,
      {"\"vertices\": 4"});
  add("json_empty", model_json(""), "info m", 3, {"model.json", "JSON"});
  add("json_truncated", model_json("{\"neutral\": \"neu"), "info m", 3, {"model.json"});
  add("json_other_type", model_json("[1, 2]"), "info m", 3, {"model.json", "object"});
  add("json_without_neutral", model_json("{}"), "info m", 3, {"model.json", "neutral"});
  add("json_number_for_a_path", model_json("{\"neutral\": 3}"), "info m", 3, {"model.json"});
  add("json_names_a_missing_file", model_json("{\"neutral\": \"no.obj\"}"), "info m", 3,
      {"no.obj", "no such file"});
  add("json_names_a_missing_folder",
      model_json(R"({"neutral": "neutral.obj", "expressions": "nowhere"})"), "info m", 3,
      {"nowhere"});
  add("json_bom_accepted", model_json("\xEF\xBB\xBF{\"neutral\": \"neutral.obj\"}\r\n"),
      "info m --json", 0, {"\"vertices\": 4"});
  return all;
}

std::vector<BadInput> weight_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& kind, const std::string& text, int code,
                          std::vector<std::string> says) {
    if (code != 0) says.push_back("w.csv");
    add_case(all, kind, "weights", weights(text), "info head --weights w.csv --json", code,
             std::move(says));
  };
  add_case(all, "missing", "weights", {}, "info head --weights no.csv", 3, {"no.csv", "no such"});
  add("empty", "", 3, {"is empty"});
  add("names_only", "time,left\n", 3, {"no row"});
  add("other_type", bytes_of(square(), "stl_binary"), 3, {});
  add("truncated", "time,left,right\n0,0.5,0.5\n1,0.", 3, {"line 3", "2 fields, expected 3"});
  add("ragged_rows", "time,left,right\n0,0.5,0.5,0.5\n", 3, {"line 2", "4 fields, expected 3"});
  add("decimal_commas", "time,left\n0,0,5\n", 3, {"line 2", "decimal commas"});
  add("tabs", "time\tleft\n0\t0.5\n", 3, {"line 1", "tabs"});
  add("duplicate_name", "time,left,left\n0,1,1\n", 3, {"line 1", "'left' occurs twice"});
  add("unnamed_column", "time,left,\n0,1,1\n", 3, {"column 3 has no name"});
  add("no_name_known", "time,smile\n0,1\n", 4, {"smile", "left"});
  add("not_a_number", "time,left\n0,nan\n", 3, {"line 2", "'left'", "finite"});
  add("infinity", "time,left\n0,inf\n", 3, {"line 2", "'left'", "finite"});
  add("text_for_a_number", "time,left\n0,high\n", 3, {"line 2", "'high'"});
  add("times_fall", "time,left\n1,0\n0,1\n", 3, {"line 3", "ascend"});
  add("unknown_and_missing_names", "time,left,smile\n0,0,0\n1,1,1\n", 0,
      {"\"frames\": 2", "drive no expression: smile", "no column drives: right, top"});
  add("windows_lines_and_bom", "\xEF\xBB\xBFtime,left,right,top\r\n0,0,0,0\r\n1,1,0,0\r\n", 0,
      {"\"frames\": 2"});
  add("json_in_a_csv", "[{\"left\": 1}]", 3, {"holds JSON", "call it .json"});
  add("percent", "time,left,right,top\n0,0,50,0\n1,100,20,80\n", 3,
      {"the weight of 'left' is 100 in frame 1", "--weight-scale"});
  add("frames_in_steps", "frame,left,right,top\n1001,0,0,0\n1003,1,0,0\n", 0,
      {"\"frames\": 2", "rows are 2 frames apart", "--fps gives the rate"});
  add("timecode_that_repeats", "Timecode,left\n01:00:00:01,0\n01:00:00:01,1\n", 3,
      {"line 3", "01:00:00:01 is not later"});
  add("no_timecode", "Timecode,left\nlater,0\n", 3, {"line 2", "HH:MM:SS:FF", "'later'"});
  add("timecodes_of_one_second", "Timecode,left,right,top\n1:0:0:1,0,0,0\n1:0:0:2,1,0,0\n", 0,
      {"\"frames\": 2", "--fps"});
  const auto add_json = [&all](const std::string& kind, const std::string& text, int code,
                               std::vector<std::string> says) {
    if (code != 0) says.push_back("w.json");
    add_case(all, kind, "weights_json", file("w.json", text), "info head --weights w.json --json",
             code, std::move(says));
  };
  add_json("whole", R"([{"left": 1, "right": 0, "top": 0}])", 0, {"\"frames\": 1"});
  add_json("empty", "", 3, {"is empty"});
  add_json("truncated", R"([{"left": 1)", 3, {"weights as JSON", "line 1"});
  add_json("other_type", "time,left\n0,1\n", 3, {"is not JSON", "call it .csv"});
  add_json("nested_deeply", std::string(100000, '['), 3, {"nested deeper than 100"});
  add_json("ragged_rows", R"({"names": ["left"], "weights": [[1, 2]]})", 3,
           {"weights/0", "2 weights, expected 1"});
  add_json("not_a_number", R"([{"left": null}])", 3, {"row 0", "'left'", "finite"});
  add_json("no_name_known", R"([{"smile": 1}])", 4, {"smile", "left"});
  add("all_zero", "time,left,right,top\n0,0,0,0\n1,0,0,0\n", 0, {"\"motion\": 0"});
  return all;
}

}  // namespace mimetra::test
