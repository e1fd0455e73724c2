#include "tests/cli/bad_input.h"
#include "tests/cli/matched_patch.h"
#include "tests/shapes.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/mesh/unit_change.h"

/// Examples of a rig.
namespace mimetra::test {

namespace {

/// The target of these cases: the model's own neutral, and a folder of examples with `name`, and
/// `weights` as examples.csv where there are some.
std::function<void(const fs::path&)> examples(const std::string& name,
                                              const std::string& weights = "") {
  return [name, weights](const fs::path& folder) {
    fs::copy_file(folder / "head/neutral.ply", folder / "double.ply");
    fs::create_directory(folder / "scans");
    fs::copy_file(folder / "head/expressions/left.ply", folder / "scans" / name);
    if (!weights.empty()) write_bytes_to(folder / "scans/examples.csv", weights);
  };
}

}  // namespace

std::vector<BadInput> rig_cases() {
  const std::string rig = "rig head double.ply -o out ";
  const std::string by_examples = rig + "--examples scans";
  const auto refused = [&](const std::string& kind, const std::string& weights, int code,
                           std::vector<std::string> says) {
    return BadInput{kind, "rig", examples("pose.ply", weights), by_examples, code, std::move(says)};
  };
  return {
      {"example_of_unknown_name",
       "rig",
       examples("rihgt.ply"),
       by_examples,
       4,
       {"scans/rihgt.ply: 'rihgt' is no expression", "did you mean 'right'?", "examples.csv",
        "--estimate-weights"}},
      {"example_of_no_near_name",
       "rig",
       examples("eyebrow.ply"),
       by_examples,
       4,
       {"there are left, right, top"}},
      {"example_of_other_vertices",
       "rig",
       [](const fs::path& folder) {
         examples("left.ply")(folder);
         write_bytes_to(folder / "scans/right.obj", small_patch());
       },
       by_examples,
       4,
       {"right.obj", "64 vertices, expected 225"}},
      {"example_twice",
       "rig",
       [](const fs::path& folder) {
         examples("left.ply")(folder);
         write_bytes_to(folder / "scans/left.off", "OFF\n");
       },
       by_examples,
       3,
       {"left.off"}},
      {"example_in_another_unit",
       "rig",
       [](const fs::path& folder) {
         examples("left.ply")(folder);
         const SequenceRead shape = read_sequence((folder / "scans/left.ply").string());
         const auto smaller =
             with_units(std::make_shared<MeshSequence>(shape.sequence), {.scale = 0.01});
         write_sequence(*smaller, folder / "scans/left.ply", {.overwrite = true});
       },
       by_examples,
       4,
       {"example 'left'", "those of double", "into one unit", "--scale"}},
      {"examples_missing", "rig", examples("left.ply"), rig + "--examples nowhere", 3, {"nowhere"}},
      {"examples_empty",
       "rig",
       [](const fs::path& folder) {
         examples("left.ply")(folder);
         fs::remove(folder / "scans/left.ply");
       },
       by_examples,
       3,
       {"scans: holds no .obj"}},
      refused("example_weights_of_no_mesh", "mesh,left\nother,1\n", 3,
              {"examples.csv", "line 2", "there is no mesh 'other'"}),
      refused("example_weights_with_extensions", "mesh,left\npose.ply,1\n", 3,
              {"there is no mesh 'pose.ply'", "leave out the file's extension"}),
      refused("example_expression_twice", "mesh,left,left\npose,1,1\n", 3,
              {"the name 'left' occurs twice"}),
      refused("example_weights_twice", "mesh,left\npose,1\npose,1\n", 3,
              {"line 3", "'pose' occurs twice"}),
      refused("example_weights_without_names", "left,right\n1,0\n", 3, {"first column 'mesh'"}),
      refused("example_weights_of_unknown_expression", "mesh,lefd\npose,1\n", 4,
              {"'lefd' is no expression", "did you mean 'left'?"}),
      refused("example_weight_of_2", "mesh,left\npose,2\n", 4,
              {"the weight of 'left' is 2 for mesh 'pose', expected 0 to 1"}),
      refused("example_weight_of_words", "mesh,left\npose,much\n", 3, {"line 2"}),
      {"share_without_examples",
       "rig",
       examples("left.ply"),
       rig + "--share 2",
       2,
       {"--share", "without --examples"}},
      {"rounds_without_estimates",
       "rig",
       examples("left.ply"),
       by_examples + " --rounds 2",
       2,
       {"--rounds", "--estimate-weights"}},
      {"prior_of_0", "rig", examples("left.ply"), by_examples + " --prior 0", 2, {"prior"}},
      {"source_without_expressions",
       "rig",
       examples("left.ply"),
       "rig double.ply double.ply -o out",
       4,
       {"double: the source has no expressions"}},
      {"rig_of_other_faces",
       "rig",
       [](const fs::path& folder) { write_bytes_to(folder / "small.obj", small_patch()); },
       "rig head small.obj -o out",
       4,
       {"small: 64 vertices, expected 225 as in the source", "--markers FILE"}},
  };
}

}  // namespace mimetra::test
