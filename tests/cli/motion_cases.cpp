#include "tests/cli/bad_input.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/mesh/unit_change.h"

/// Every operation where motion is missing, and every number of components that is too high or low.
namespace mimetra::test {

namespace {

/// An operation on a sequence; `%` stands for the sequence with its options.
struct Request {
  std::string operation;
  std::string arguments;
  bool needs_motion;
};

const std::vector<Request>& requests() {
  static const std::vector<Request> kRequests = {
      {"info", "info %", false},
      {"align", "align % --on all -o b.npy", false},
      {"geodesic", "geodesic % --source 112 -o d.vtp", false},
      {"decompose", "decompose % -k 2 -o c.h5", true},
      {"regions", "regions % -k 2 -o r.json", true},
      {"transfer", "transfer % head -k 2 -o x.npy", true},
      {"transfer_full", "transfer % head --full -o x.npy", false},
      {"transfer_vertex", "transfer % head --full --space vertex -o x.npy", false},
      {"evaluate", "evaluate % head -k 2", true},
      {"convert", "convert % -o x.npy", false},
      {"simplify", "simplify % -o x.npy", false},
      {"subdivide", "subdivide % -o x.npy", false},
  };
  return kRequests;
}

std::string with_sequence(const std::string& arguments, const std::string& sequence) {
  const std::size_t place = arguments.find('%');
  return arguments.substr(0, place) + sequence + arguments.substr(place + 1) + " --json";
}

/// One BadInput for each operation; `says` is what those that need motion answer, all transfers of
/// one frame, and with a warning those of all triangles where every frame is the rest pose.
void add_to_all(std::vector<BadInput>& all, const std::string& kind, const std::string& sequence,
                const std::function<void(const fs::path&)>& make, const std::string& says,
                const std::string& where_motion_is_needed = "") {
  for (const Request& request : requests()) {
    const bool is_refused =
        request.needs_motion || (kind == "one_frame" && request.operation.starts_with("transfer"));
    const bool says_so = is_refused || (says == "nothing moves" && kind != "identical_frames" &&
                                        request.operation.starts_with("transfer"));
    const std::string options = request.needs_motion ? where_motion_is_needed : "";
    add_case(all, kind, request.operation, make,
             with_sequence(request.arguments, sequence) + options, is_refused ? 4 : 0,
             says_so ? std::vector{says} : std::vector<std::string>{"{"});
  }
}

/// A model whose two expressions move one vertex, and 4 frames of it.
void moving_dot(const fs::path& folder) {
  const MorphableModel model = Patch::model();
  Eigen::MatrixXd fields = Eigen::MatrixXd::Zero(3 * model.vertices(), 2);
  fields(3 * 112, 0) = fields(3 * 112 + 2, 1) = 1;
  write_model(folder / "dot",
              MorphableModel(std::make_shared<Connectivity>(model.connectivity()), model.mean(),
                             model.identities(), {{"aside", "up"}, fields}));
  write_bytes_to(folder / "dot.csv", "aside,up\n0,0\n1,0\n0,1\n0.5,0.2\n");
}

void add_counts(std::vector<BadInput>& all) {
  const std::string sequence = "head --weights take.csv";
  for (const Request& request : requests()) {
    if (!request.needs_motion) continue;
    const auto with_count = [&](const std::string& count) {
      std::string arguments = with_sequence(request.arguments, sequence);
      return arguments.replace(arguments.find("-k 2") + 3, 1, count);
    };
    const std::string name = request.operation;
    add_case(all, "k_zero", name, {}, with_count("0"), 2, {"-k", "at least 1", "'0'"});
    add_case(all, "k_negative", name, {}, with_count("-3"), 2, {"-k", "at least 1", "'-3'"});
    add_case(all, "k_no_number", name, {}, with_count("many"), 2, {"-k", "whole number", "many"});
    add_case(all, "k_above_vertices", name, {}, with_count("226"), 4,
             {"226 components", "225 vertices"});
    // One vertex moves, in two directions: two components meet there, the others have none.
    std::string dot = with_sequence(request.arguments, "dot --weights dot.csv");
    dot.replace(dot.find("-k 2") + 3, 1, "5");
    if (dot.find("head") != std::string::npos) dot.replace(dot.find("head"), 4, "dot");
    add_case(all, "k_above_distinct_centers", name, moving_dot, dot, 0,
             {name == "decompose" ? "components died" : "share a region"});
  }
}

/// The model with an expression that moves nothing.
void with_idle_expression(const fs::path& folder) {
  const MorphableModel model = Patch::model();
  ShapeBasis expressions = model.expressions();
  expressions.names.push_back("idle");
  expressions.displacements.conservativeResize(Eigen::NoChange, 4);
  expressions.displacements.col(3).setZero();
  write_model(folder / "idle", MorphableModel(std::make_shared<Connectivity>(model.connectivity()),
                                              model.mean(), model.identities(), expressions));
}

}  // namespace

std::vector<BadInput> motion_cases() {
  std::vector<BadInput> all;
  add_to_all(all, "one_frame", "head", {}, "one frame");
  const std::string still = "left,right,top\n0,0,0\n0,0,0\n0,0,0\n";
  add_to_all(all, "no_motion", "head --weights still.csv", file("still.csv", still),
             "nothing moves");
  const std::string same = "left,right,top\n0.5,0.5,0\n0.5,0.5,0\n0.5,0.5,0\n";
  add_to_all(all, "identical_frames", "head --weights same.csv", file("same.csv", same),
             "nothing moves", " --rest first");
  const std::string noise = "left,right,top\n0,0,0\n1e-9,0,0\n0,1e-9,-1e-9\n";
  add_to_all(all, "rounding_noise", "head --weights noise.csv", file("noise.csv", noise),
             "nothing moves");
  add_counts(all);
  for (const std::string arguments :
       {"transfer head --weights take.csv idle --full -o x.npy --weights-out w.csv",
        "evaluate head --weights take.csv idle -k 2"}) {
    add_case(all, "all_zero_expression", arguments.substr(0, arguments.find(' ')),
             with_idle_expression, arguments, 0, {"expressions do not move", "idle"});
  }
  add_case(all, "rest_in_another_unit", "transfer",
           [](const fs::path& folder) {
             const SequenceRead head = read_sequence((folder / "head").string());
             write_sequence(
                 *with_units(std::make_shared<MeshSequence>(head.sequence), {.scale = 0.01}),
                 folder / "small.ply");
           },
           "transfer head --weights take.csv head --full --source-rest small.ply -o x.npy", 4,
           {"head: the rest pose is 100 times as small as frame 0", "--scale"});
  add_case(all, "all_zero_expression", "info", with_idle_expression, "info idle --json", 0,
           {"\"vertices\": 225"});
  return all;
}

}  // namespace mimetra::test
