#include "tests/cli/bad_input.h"

/// What the command reads back as JSON: an align run's manifest and files of options.
namespace mimetra::test {

namespace {

std::string motions(int frames, const std::string& rotation = "1,0,0,0,1,0,0,0,1") {
  std::string list;
  for (int frame = 0; frame < frames; ++frame) {
    list += std::string(frame > 0 ? "," : "") + "{\"rotation\": [" + rotation +
            "], \"translation\": [0,0,0]}";
  }
  return "{\"result\": {\"motion\": [" + list + "]}}";
}

}  // namespace

std::vector<BadInput> json_cases() {
  std::vector<BadInput> all;
  const auto add_manifest = [&all](const std::string& kind, const std::string& text, int code,
                                   std::vector<std::string> says) {
    if (code != 0) says.push_back("a.run.json");
    add_case(all, kind, "manifest", file("a.run.json", text),
             "align head --weights take.csv --undo a.run.json -o b.npy --json", code,
             std::move(says));
  };
  const auto add_config = [&all](const std::string& kind, const std::string& text, int code,
                                 std::vector<std::string> says) {
    if (code != 0) says.push_back("c.json");
    add_case(all, kind, "config", file("c.json", text),
             "regions head --weights take.csv --config c.json -o r.json --json", code,
             std::move(says));
  };
  add_case(all, "missing", "manifest", {}, "align head --weights take.csv --undo no.json -o b.npy",
           3, {"no.json", "no such file"});
  add_manifest("empty", "", 3, {"result.motion"});
  add_manifest("truncated", motions(12).substr(0, 60), 3, {"result.motion"});
  add_manifest("other_type", "[]", 3, {"result.motion"});
  add_manifest("of_another_run", "{\"result\": {\"frames\": 12}}", 3, {"result.motion"});
  add_manifest("eight_numbers", motions(12, "1,0,0,0,1,0,0,0"), 3, {"9 numbers"});
  add_manifest("no_rotation", motions(12, "2,0,0,0,1,0,0,0,1"), 3, {"frame 0", "rotation"});
  add_manifest("not_a_number", motions(12, "null,0,0,0,1,0,0,0,1"), 3, {"result.motion"});
  add_manifest("other_frame_count", motions(3), 4, {"3 rigid transforms, expected 12"});
  add_manifest("windows_lines_and_bom", "\xEF\xBB\xBF" + motions(12) + "\r\n", 0, {"\"frames\""});

  add_case(all, "missing", "config", {},
           "regions head --weights take.csv --config no.json -o r.json", 3,
           {"no.json", "no such file"});
  add_config("empty", "", 3, {"expected JSON"});
  add_config("truncated", "{\"k\": 3", 3, {"expected JSON"});
  add_config("other_type", "[1]", 3, {"expected an object"});
  add_config("unknown_option", "{\"radios\": 1}", 2,
             {"'radios' is no parameter", "mimetra operations"});
  add_config("wrong_value", "{\"k\": \"many\"}", 2, {"-k", "'many'"});
  add_config("out_of_range", "{\"k\": 0}", 2, {"-k", "at least 1"});
  add_config("null_value", "{\"k\": null}", 2, {"-k", "null"});
  add_config("nested_value", "{\"k\": {\"a\": 1}}", 2, {"-k"});
  add_config("windows_lines_and_bom", "\xEF\xBB\xBF{\"k\": 2,\r\n\"radius\": 0.2}\r\n", 0,
             {"\"regions\""});
  return all;
}

}  // namespace mimetra::test
