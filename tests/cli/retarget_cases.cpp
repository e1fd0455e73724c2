#include "tests/cli/bad_input.h"

/// Weights of one rig for another: what is asked for, and maps that were kept.
namespace mimetra::test {

namespace {

/// A map of the model's three expressions onto two of another rig, with members in `place` of some.
std::string kept_map(const std::string& from = "", const std::string& to = "") {
  std::string text =
      R"({"kind": "weights of one rig to another", "version": 1,
          "source": ["left", "right", "top"], "target": ["x", "y"],
          "lower": [0, 0], "upper": [1, 1], "gram": [[2, 1], [1, 2]],
          "linear": [[1, 0, 0], [0, 1, 0]]})";
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return text;
}

}  // namespace

std::vector<BadInput> retarget_cases() {
  const auto map = [](const std::string& kind, const std::string& text, int code,
                      std::vector<std::string> says) {
    if (code != 0) says.push_back("map.json");
    return BadInput{kind,
                    "map",
                    file("map.json", text),
                    "retarget --map map.json --weights take.csv -o w.csv --json",
                    code,
                    std::move(says)};
  };
  const auto request = [](const std::string& kind, const std::string& arguments, int code,
                          std::vector<std::string> says) {
    return BadInput{
        kind, "retarget",     file("map.json", kept_map()), "retarget " + arguments + " -o w.csv",
        code, std::move(says)};
  };
  const std::string driven = " --weights take.csv";
  return {
      map("whole", kept_map(), 0, {"\"frames\": 12", "\"expressions\": 2"}),
      map("empty", "", 3, {"expected a map of weights"}),
      map("truncated", kept_map().substr(0, 200), 3, {"expected a map of weights"}),
      map("other_type", "time,left\n0,1\n", 3, {"expected a map of weights"}),
      map("a_list", "[]", 3, {"--map-out"}),
      map("nested_deeply", std::string(100000, '['), 3, {"nested deeper than 100"}),
      map("missing_member", kept_map("\"upper\"", "\"up\""), 3, {"has no 'upper'"}),
      map("unknown_key", kept_map("\"version\"", "\"l1\": 0, \"version\""), 3,
          {"'l1' is unknown", "leave it out"}),
      map("later_version", kept_map("1,", "7,"), 3, {"version: expected 1, found 7"}),
      map("ragged_rows", kept_map("[1, 2]", "[1]"), 3, {"gram/1: expected 2 numbers, found 1"}),
      map("too_few_rows", kept_map(", [0, 1, 0]", ""), 3,
          {"linear: expected 2 rows, one for each expression of 'target', found 1"}),
      map("not_a_number", kept_map("[2, 1]", "[2, \"one\"]"), 3,
          {"gram/0/1: expected a finite number, found \"one\""}),
      map("huge_number", kept_map("[2, 1]", "[2, 1e999]"), 3, {}),
      map("not_symmetric", kept_map("[1, 2]", "[0, 2]"), 3, {"not symmetric"}),
      map("not_semidefinite", kept_map("[[2, 1], [1, 2]]", "[[1, 2], [2, 1]]"), 3,
          {"negative eigenvalue", "--map-out"}),
      map("bounds_cross", kept_map("[0, 0]", "[0, 2]"), 3, {"the bounds of 'y' cross"}),
      map("name_twice", kept_map("[\"x\", \"y\"]", "[\"x\", \"x\"]"), 3, {"'x' twice"}),
      BadInput{
          "no_name_known",
          "map",
          file("map.json", kept_map("[\"left\", \"right\", \"top\"]", "[\"a\", \"b\", \"c\"]")),
          "retarget --map map.json --weights take.csv -o w.csv",
          4,
          {"take.csv", "'left'", "'a'"}},
      request("no_models", driven, 2, {"SOURCE and TARGET", "--map FILE"}),
      request("one_model", "head" + driven, 2, {"SOURCE and TARGET", "--map FILE"}),
      request("no_weights", "head head", 2, {"--weights"}),
      request("map_and_models", "head head --map map.json" + driven, 2,
              {"--map: it stands for SOURCE and TARGET"}),
      request("map_and_map_out", "--map map.json --map-out m.json" + driven, 2, {"--map-out"}),
      request("map_and_markers", "--map map.json --markers m.txt" + driven, 2,
              {"--markers: it is about meshes"}),
      request("map_and_axes", "--map map.json --axes none" + driven, 2,
              {"--axes: it is about meshes"}),
      request("map_that_is_missing", "--map no.json" + driven, 3, {"no.json", "no such"}),
      request("weights_that_are_missing", "head head --weights no.csv", 3, {"no.csv", "no such"}),
      request("rate_of_what_has_times", "head head --fps 10" + driven, 2, {"take.csv", "fps"}),
      request("frames_that_are_not_there", "head head --frames 20:30" + driven, 4, {"20:30"}),
      BadInput{"source_without_expressions",
               "retarget",
               file("mesh.obj", bytes_of(square(), "obj")),
               "retarget mesh.obj head --weights take.csv -o w.csv",
               4,
               {"mesh: has no expressions"}},
      BadInput{"target_without_expressions",
               "retarget",
               file("mesh.obj", bytes_of(square(), "obj")),
               "retarget head mesh.obj --weights take.csv -o w.csv",
               4,
               {"mesh: has no expressions"}},
  };
}

}  // namespace mimetra::test
