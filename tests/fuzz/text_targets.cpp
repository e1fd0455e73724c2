#include <algorithm>

#include <nlohmann/json.hpp>

#include "fitting/landmark_mapping.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/values.h"
#include "tests/image_bytes.h"
#include "toolkit/formats/model_file.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/correspondence_file.h"
#include "toolkit/io/example_folder.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/marker_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/painting_file.h"
#include "toolkit/io/retargeting_file.h"
#include "toolkit/io/rules_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/model/retargeting.h"
#include "toolkit/operations/manifest.h"
#include "toolkit/operations/operation.h"
#include "toolkit/operations/parameter_files.h"

namespace mimetra::fuzz {

namespace {

/// Those of every operation of the toolkit, each name once.
Parameters all_parameters() {
  OperationTable table;
  add_toolkit(table);
  std::vector<Parameter> all;
  for (const Operation& operation : table.operations()) {
    for (Parameter& parameter : table.parameters_of(operation)) {
      if (std::ranges::find(all, parameter.name, &Parameter::name) != all.end()) continue;
      all.push_back(std::move(parameter));
    }
  }
  return Parameters(std::move(all));
}

/// Writes the value that it reads as a manifest would.
void read_options(const fs::path& file) {
  static const Parameters declared = all_parameters();
  Parameters parameters = declared;
  set_from_file(file.string(), parameters);
  for (const Parameter& parameter : declared.declared()) to_text(parameters.value(parameter.name));
}

/// A run that wrote the file beside its manifest.
void write_manifest(const fs::path& file) {
  FinishedRun run;
  run.operation = "transfer";
  run.parameters = all_parameters();
  run.arguments = {"transfer", "take.npy", "actor", "-o", "out.npy"};
  run.named_inputs = {{"source", {"take.npy"}}, {"target", {"actor"}}};
  run.inputs = {"/dev/null"};
  run.outputs = {"out.npy"};
  write_bytes(file, manifest(run, R"({"seconds": 1})"));
}

void read_manifest(const fs::path& file) {
  const fs::path output = file.parent_path() / "out.npy";
  is_manifest_of(file, output);
  is_manifest_of_operation(file, "transfer");
  read_run(file);
}

/// A folder's manifest says which files of it are mimetra's; it is written again with all of them.
void read_file_list(const fs::path& file) {
  files_of_others(file.parent_path());
  list_written_files(file.parent_path());
}

/// A painting of two triangles with texture coordinates.
void read_triangles_painting(const fs::path& file) {
  static const Connectivity mesh = [] {
    Triangles triangles(2, 3);
    triangles << 0, 1, 2, 0, 2, 3;
    Connectivity made = Connectivity::from_triangles(4, triangles);
    made.texture.coordinates = {{0, 0}, {1, 0.5}, {-3.5, 7}, {0.25, 1}};
    made.texture.corners = made.polygons.corners;
    return made;
  }();
  read_painting(file, mesh);
}

std::string white_png() {
  return test::png_bytes(2, 2, PNG_FORMAT_GRAY, std::vector<std::uint8_t>(4, 255));
}

/// The times beside an array.
void read_times(const fs::path& file) {
  static const fs::path take = [&file] {
    const fs::path written = file.parent_path() / "written";
    write_sequence(*std::get<FieldSequence>(value_of(DataKind::sequence)).frames,
                   written / "take.npy", {.overwrite = true}, Context().with_threads(1));
    fs::remove(written / file.filename());
    for (const auto& entry : fs::directory_iterator(written)) {
      fs::rename(entry.path(), file.parent_path() / entry.path().filename());
    }
    return file.parent_path() / "take.npy";
  }();
  read_sequence(take.string(), {}, Context().with_threads(1));
}

/// Each of the grid's triangles is its own partner.
void write_correspondence(const fs::path& file) {
  write_bytes(file, correspondence_json(Correspondence::identity(
                                            static_cast<int>(grid().connectivity.triangles.rows())),
                                        grid().connectivity, grid().connectivity));
}

/// Writes and applies the value that it reads.
void read_map(const fs::path& file) {
  const Retargeting map = parse_retargeting(file.string(), read_file(file));
  retargeting_json(map);
  plain_matrix_csv(map, plain_matrix(map));
}

void write_map(const fs::path& file) {
  const Retargeting map{.source_names = {"smile", "jaw", "brow"},
                        .target_names = {"smile_L", "jawOpen"},
                        .gram = Eigen::MatrixXd{{2, 0.5}, {0.5, 1}},
                        .linear = Eigen::MatrixXd{{1, 0, 0.25}, {0, 1, 0}},
                        .lower = Eigen::VectorXd::Zero(2),
                        .upper = Eigen::VectorXd::Ones(2)};
  write_bytes(file, retargeting_json(map));
}

/// Weights of the poses beside the file.
void read_poses(const fs::path& file) {
  const fs::path folder = file.parent_path();
  for (const char* mesh : {"a.ply", "b.ply"}) {
    if (!fs::exists(folder / mesh)) write_mesh(folder / mesh, grid());
  }
  read_examples(folder, grid().connectivity, "actor");
}

}  // namespace

std::vector<Target> text_targets() {
  return {{"json",
           "a.json",
           [](const fs::path& file) { parse_json("a.json", json_text(read_json(file), 1)); },
           {text(R"({"k": [1, 2.5, "x\u00e4"], "all": {"a": null}})")}},
          {"options",
           "c.json",
           read_options,
           {text(R"({"k": 3, "radius": "12abs", "full": true, "space": "vertex", "rest": "a.ply",)"
                 R"( "coverage": 0.5, "frames": "2:90:3", "ridge": 1e-3})")}},
          {"manifest", "out.run.json", read_manifest, {write_manifest}},
          {"file_list",
           "mimetra-run.json",
           read_file_list,
           {text(R"({"program": "mimetra", "files": ["a.ply", "b/c.ply"]})")}},
          {"motion",
           "align.json",
           [](const fs::path& file) { read_motion(file.string(), 1); },
           {text(R"({"result": {"motion": [{"rotation": [1, 0, 0, 0, 1, 0, 0, 0, 1],)"
                 R"( "translation": [0, 0.5, 1e3]}]}})")}},
          {"times", "take.times.csv", read_times, {text("time\n0\n0.04\n0.08\n")}},
          {"landmark_mapping",
           "ibug_to_m.txt",
           [](const fs::path& file) { read_landmark_mapping(file); },
           {text("# iBUG\n[landmark_mappings]\n9 = 33\n31 = 114\n")}},
          {"markers",
           "pairs.corr",
           [](const fs::path& file) { marker_text(read_markers(file, 1)); },
           {text("# eyes\n1, 2\n3 4\n5:6\n- 7:8\n"), text("2\n1, 2\n3, 4\n"),
            text("source: [1, 3]\ntarget: [2, 4]\n")}},
          {"correspondence",
           "a.correspondence.json",
           [](const fs::path& file) {
             read_correspondence(file, grid().connectivity, grid().connectivity);
           },
           {write_correspondence}},
          {"rules",
           "rules.json",
           [](const fs::path& file) { read_rules(file); },
           {text(R"({"pairs": [["browUpLeft", "browUpRight"]], "exclusive": [["up", "down"]],)"
                 R"( "expressions": {"jaw": {"minimum": 0, "maximum": 0.8, "gain": 1.2}}})")}},
          {"retargeting", "rigs.map.json", read_map, {write_map}},
          {"examples", "examples.csv", read_poses, {text("mesh,smile,jaw\na,0.5,0\nb,0,1\n")}},
          {"model_name",
           "name.txt",
           [](const fs::path& file) { ModelSpec::parse(read_file(file)).name(); },
           {text("actor@identity003=1.5,identity007=-1"), text("actor@out/a.fit.json")}},
          {"frame_range",
           "range.txt",
           [](const fs::path& file) { selected_frames(read_file(file), 100); },
           {text("2:90:3")}},
          {"vertex_set",
           "set.txt",
           [](const fs::path& file) {
             named_vertices(read_file(file), std::get<FieldSequence>(value_of(DataKind::sequence)));
           },
           {text("component:0"), text("group:lips"), text("field:heat")}},
          {"painting_png", "p.png", read_triangles_painting, {text(white_png())}},
          {"painting_jpeg",
           "p.jpg",
           read_triangles_painting,
           {text(test::jpeg_bytes(3, 2, {0, 255, 9, 90, 80, 7}))}},
          {"painting_list", "p.txt", read_triangles_painting, {text("1 0.5 0 1e-3\n")}},
          {"painting_table", "p.csv", read_triangles_painting, {text("vertex,weight\n2,0.5\n")}}};
}

}  // namespace mimetra::fuzz
