#include <map>
#include <set>

#include "tests/cli/bad_input.h"

/// Requests that are wrong whatever the data, and outputs that cannot be written.
namespace mimetra::test {

namespace {

const std::string kSequence = "head --weights take.csv";

/// Every operation with every kind of file that it can make; `arguments` ends in the output.
struct Making {
  std::string subject;
  std::string arguments;
  std::string output;
};

const std::vector<Making>& makings() {
  static const std::vector<Making> kMakings = {
      {"align_npy", "align " + kSequence + " -o ", "b.npy"},
      {"geodesic_vtp", "geodesic head -o ", "d.vtp"},
      {"decompose_h5", "decompose " + kSequence + " -k 2 -o ", "c.h5"},
      {"regions_pvd", "regions " + kSequence + " -k 2 -o ", "r.pvd"},
      {"regions_json", "regions " + kSequence + " -k 2 -o ", "r.json"},
      {"regions_csv", "regions " + kSequence + " -k 2 -o ", "r.csv"},
      {"transfer_folder", "transfer " + kSequence + " head -k 2 -o ", "x"},
      {"evaluate_csv", "evaluate " + kSequence + " head -k 2 -o ", "t.csv"},
      {"convert_folder", "convert " + kSequence + " -o ", "x"},
      {"convert_npy", "convert " + kSequence + " -o ", "x.npy"},
      {"convert_ply", "convert head -o ", "x.ply"},
      {"convert_obj", "convert head -o ", "x.obj"},
      {"convert_off", "convert head -o ", "x.off"},
      {"convert_stl", "convert head -o ", "x.stl"},
      {"sample_folder", "sample -o ", "s"},
  };
  return kMakings;
}

void read_only_folder(const fs::path& folder) {
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_write, fs::perm_options::remove);
}

/// The administrator may write anywhere; without this right that ends.
std::string without_override() {
  return getuid() == 0 ? "setpriv --bounding-set=-dac_override" : "";
}

void add_making(std::vector<BadInput>& all, const Making& making) {
  const auto add = [&](const std::string& kind, const std::string& output,
                       std::function<void(const fs::path&)> make, std::vector<std::string> says,
                       const std::string& prefix) {
    add_case(all, kind, making.subject, std::move(make), making.arguments + output, 5,
             std::move(says), prefix);
  };
  const std::string& name = making.output;
  // One for each way to write: a file, several, a folder, a table, and VTK's.
  static const std::set<std::string> kOneOfAKind = {"decompose_h5",   "convert_npy",
                                                    "convert_folder", "evaluate_csv",
                                                    "geodesic_vtp",   "regions_pvd"};
  if (kOneOfAKind.contains(making.subject)) {
    add("unwritable_folder", "locked/" + name, read_only_folder,
        {"locked/" + name, "cannot be written", "Permission denied"}, without_override());
    add("file_instead_of_a_folder", "take.csv/" + name, {},
        {"take.csv/" + name, "cannot be written"}, "");
  }
  if (fs::path(name).has_extension()) {
    add("existing_output", name, file(name, "mine"), {name, "exists already", "--force"}, "");
  } else {
    const auto of_users = [name](const fs::path& folder) {
      fs::create_directory(folder / name);
      std::ofstream(folder / name / "notes.txt") << "mine";
    };
    // Which --force would not replace.
    add("existing_output", name, of_users, {name, "holds 'notes.txt'", "manifest"}, "");
    add("existing_file", name + " --force", file(name, "mine"), {name, "exists and is no folder"},
        "");
    add("folder_of_others", name + " --force", of_users, {name, "holds 'notes.txt'", "manifest"},
        "");
  }
  // In blocks of 512 bytes; without the signal, writing fails as on a full disk.
  add("full_disk", name, {}, {fs::path(name).stem().string(), "cannot be written"},
      "trap '' XFSZ; ulimit -f 1;");
}

}  // namespace

std::vector<BadInput> output_cases() {
  std::vector<BadInput> all;
  for (const Making& making : makings()) add_making(all, making);
  const auto full = [&all](const std::string& subject, const std::string& arguments,
                           const std::string& name, int blocks) {
    add_case(all, "full_disk_later", subject, {}, arguments, 5, {name, "cannot be written"},
             "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + ";");
  };
  const auto of_input = [&all](const std::string& subject, const std::string& arguments,
                               std::vector<std::string> says) {
    add_case(
        all, "output_is_an_input", subject,
        [](const fs::path& folder) {
          fs::copy(folder / "head", folder / "p", fs::copy_options::recursive);
          fs::create_symlink("take.csv", folder / "link.csv");
        },
        arguments + " --force", 5, std::move(says));
  };
  of_input("model", "convert head -o head", {"head: is an input of this run"});
  of_input("dots", "convert head -o p/../head/", {"head", "is an input of this run"});
  of_input("link", "decompose head --weights link.csv -k 2 -o c.h5 --weights-out take.csv",
           {"take.csv: is an input of this run"});
  of_input("part", "convert head --weights take.csv --frames 0:1 -o head/neutral.ply",
           {"head/neutral.ply: is a part of head, an input of this run"});
  of_input("folder", "convert head --weights p/performance.csv -o p",
           {"p: holds p/performance.csv, an input of this run"});
  for (const std::string extension : {".vtp", ".stl"}) {
    add_case(all, "far_from_the_origin", extension.substr(1),
             file("far.obj", "v 1e6 0 0\nv 1000001 0 0\nv 1e6 1 0\nf 1 2 3\n"),
             "convert far.obj -o x" + extension, 0,
             {"exact positions (rounded by up to 0.06", "1e+06 times its size from the origin"});
  }
  full("convert_npy", "convert " + kSequence + " -o x.npy", "x.npy", 20);
  full("decompose_h5", "decompose " + kSequence + " -k 2 -o c.h5", "c.h5", 20);
  full("regions_pvd", "regions " + kSequence + " -k 2 -o r.pvd", "r_vtp/r_0000.vtp", 6);
  add_case(all, "full_disk", "stdout", {}, "info head --json > /dev/full", 5,
           {"standard output", "cannot be written"});
  add_case(all, "full_disk", "help", {}, "--help > /dev/full", 5,
           {"standard output", "cannot be written"});
  return all;
}

std::vector<BadInput> request_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& kind, const std::string& subject,
                          const std::string& arguments, std::vector<std::string> says) {
    add_case(all, kind, subject, {}, arguments, 2, std::move(says));
  };
  add("unknown_command", "command", "decompse head", {"'decompse'", "did you mean 'decompose'?"});
  add("far_from_any_command", "command", "frobnicate", {"'frobnicate'", "--help"});
  add("no_command", "command", "", {"expected a command"});
  add("standard_output", "output", "convert head --weights take.csv -o -",
      {"not written to standard output", "give a name"});
  const std::string full = "transfer head --weights take.csv head --full -o x.npy ";
  const std::map<std::string, std::string> without_effect = {{"full_k", "-k 5"},
                                                             {"full_radius", "--radius 0.2"},
                                                             {"full_coverage", "--coverage 0.5"},
                                                             {"full_sparsity", "--sparsity 3"}};
  for (const auto& [subject, option] : without_effect) {
    add("option_without_effect", subject, full + option,
        {option.substr(0, option.find(' ')) + ": no regions are looked for"});
  }
  add("smoothness_of_milliseconds", "full", full + "--smoothness 100",
      {"--smoothness", "from 0 to 60", "100"});
  const std::map<std::string, std::pair<std::string, std::string>> misspelt = {
      {"info", {"head --jsno", "--json"}},
      {"transfer", {"head head -o x --ful", "--full"}},
      {"sample", {"-o s --froce", "--force"}},
  };
  for (const auto& [operation, line] : misspelt) {
    add("unknown_option", operation, operation + ' ' + line.first,
        {"did you mean '" + line.second + "'?"});
    add("missing_input", operation, operation, {operation + ":", "required"});
  }
  add("missing_output", "convert", "convert head", {"convert:", "--out", "required"});
  add("input_too_many", "convert", "convert head head -o x", {"convert:", "head"});
  add("empty_name", "info", "info ''", {"empty"});
  add("no_number", "transfer", "transfer head head --ridge nan -o x", {"--ridge", "'nan'"});
  add("infinity", "regions", "regions head --radius inf -o r.json", {"--radius", "'inf'"});
  add("view_of_no_series", "regions", "regions " + kSequence + " -k 2 -o r.json --paraview v.py",
      {"--paraview", "-o NAME.pvd"});
  add("zero_radius", "regions", "regions " + kSequence + " --radius 0 -o r.json",
      {"--radius", "0"});
  const std::string simplified = "regions " + kSequence + " -k 2 --simplify 0.5";
  add("simplified_support", "regions", simplified + " --region support -o r.json",
      {"--simplify", "--region disc"});
  add("simplified_components", "regions", simplified + " -o r.json --components-out c.h5",
      {"--components-out", "--simplify"});
  add("up_without_script", "regions", "regions " + kSequence + " -k 2 --up z -o r.json",
      {"--up", "--paraview"});
  add("share_above_1", "simplify", "simplify head --share 2 -o x", {"--share", "'2'"});
  add("too_many_times", "subdivide", "subdivide head --times 9 -o x", {"--times", "'9'"});
  add("unknown_choice", "convert", "convert head -o x --format fbx", {"--format", "ply, obj"});
  add("unknown_extension", "decompose", "decompose head -o c.txt", {"c.txt", ".h5"});
  add("unknown_extension", "geodesic", "geodesic head -o d.npy", {"d.npy", ".pvd or .vtp"});
  add("unknown_extension", "render", "render head -o r.jpg", {"r.jpg", ".png"});
  add("of_no_output", "convert_compress", "convert " + kSequence + " -o x.npy --compress small",
      {"'compress'", "leave it out"});
  add_case(all, "row_of_another_unit", "render",
           [](const fs::path& folder) {
             const MorphableModel model = Patch::model();
             write_model(
                 folder / "small",
                 MorphableModel(std::make_shared<Connectivity>(model.connectivity()),
                                model.mean() / 1000, model.identities(), model.expressions()));
           },
           "render head small --size 32 -o r.png", 0,
           {"small is 1000 times as small as head", "one scale", "--scale"});
  add_case(all, "several_frames", "convert_VTP", {}, "convert " + kSequence + " -o x.VTP", 4,
           {"x.VTP: holds one frame", "12; write a .pvd"});
  return all;
}

}  // namespace mimetra::test
