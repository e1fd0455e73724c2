#include "tests/cli/bad_input.h"

/// Every operation on a mesh with elements that are useless but allowed, and on targets that do not
/// fit the source.
namespace mimetra::test {

namespace {

Eigen::MatrixXd with_zero_rows(const Eigen::MatrixXd& fields, Eigen::Index rows) {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(fields.rows() + rows, fields.cols());
  result.topRows(fields.rows()) = fields;
  return result;
}

/// The patch with a vertex without face, a triangle that uses a vertex twice, and one whose corners
/// are on one line.
void odd_model(const fs::path& folder) {
  const MorphableModel model = Patch::model();
  const int vertices = model.vertices() + 1;
  const Eigen::Index faces = model.connectivity().triangles.rows();
  Positions mean(vertices, 3);
  mean << model.mean(), Eigen::RowVector3d(7, 7, 9);
  Triangles triangles(faces + 2, 3);
  triangles << model.connectivity().triangles, Eigen::RowVector3i(0, 0, 1),
      Eigen::RowVector3i(0, 15, 30);
  write_model(
      folder / "odd",
      MorphableModel(
          std::make_shared<Connectivity>(Connectivity::from_triangles(vertices, triangles)), mean,
          {{}, Eigen::MatrixXd(3 * vertices, 0)},
          {model.expressions().names, with_zero_rows(model.expressions().displacements, 3)}));
}

/// The patch as one mesh file, with faces changed.
std::function<void(const fs::path&)> target(const std::function<void(RawMesh&)>& change) {
  return [change](const fs::path& folder) {
    const MorphableModel model = Patch::model();
    RawMesh mesh;
    for (const auto& point : model.mean().rowwise()) {
      mesh.vertices.push_back({point[0], point[1], point[2]});
    }
    for (const auto& face : model.connectivity().triangles.rowwise()) {
      mesh.faces.push_back({face[0], face[1], face[2]});
    }
    change(mesh);
    write_bytes_to(folder / "other.obj", bytes_of(mesh, "obj"));
  };
}

void add_targets(std::vector<BadInput>& all) {
  const auto add = [&all](const std::string& kind, const std::function<void(RawMesh&)>& change,
                          const std::vector<std::string>& says) {
    for (const std::string operation : {"transfer", "evaluate"}) {
      const std::string output = operation == "transfer" ? " -o x.npy" : " -o x.csv";
      add_case(all, kind, operation, target(change),
               operation + " head --weights take.csv other.obj -k 2" + output, 4, says);
    }
  };
  add("target_of_other_count",
      [](RawMesh& mesh) {
        mesh.vertices.push_back({0, 0, 0});
      },
      {"other", "226 vertices, expected 225"});
  add("target_of_other_faces",
      [](RawMesh& mesh) {
        mesh.faces[7] = {7, 22, 23};
      },
      {"other", "face 7"});
  add("target_with_a_face_less", [](RawMesh& mesh) { mesh.faces.pop_back(); }, {"other", "face"});
}

}  // namespace

std::vector<BadInput> geometry_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& subject, const std::string& arguments,
                          std::vector<std::string> says) {
    add_case(all, "useless_elements", subject, odd_model, arguments, 0, std::move(says));
  };
  const std::string odd = " odd --weights take.csv";
  add("info", "info odd --json",
      {"\"vertices\": 226", "\"degenerate_triangles\": 2", "\"vertices_without_face\": 1"});
  add("align", "align" + odd + " -o b.npy --json", {"\"frames\": 12"});
  add("geodesic", "geodesic odd --source 112 -o d.vtp --json",
      {"\"vertices\": 226", "\"reached\": 225", "2 triangles without area", "vertex 225"});
  add("geodesic_exact", "geodesic odd --source 112 --geodesics exact -o d.vtp --json",
      {"\"vertices\": 226", "\"reached\": 225"});
  add_case(all, "source_vertex_without_face", "geodesic", odd_model,
           "geodesic odd --source 225 -o d.vtp", 4, {"--source", "vertex 225", "no triangle"});
  add("decompose", "decompose" + odd + " -k 3 -o c.h5 --json",
      {"\"vertices\": 226", "2 triangles without area"});
  add("regions", "regions" + odd + " -k 3 -o r.pvd --json", {"no region", "vertex 225"});
  add("transfer", "transfer" + odd + " odd --full -o x.npy --json", {"2 slivers of the source"});
  add("transfer_vertex", "transfer" + odd + " odd --full --space vertex -o x.npy --json",
      {"2 slivers of the target"});
  add("evaluate", "evaluate" + odd + " odd -k 3 --json", {"\"rows\""});
  add("convert", "convert" + odd + " -o x --format obj --json", {"\"vertices\": 226"});
  add("simplify", "simplify" + odd + " --share 0.5 -o x.npy --json", {"\"given_vertices\": 226"});
  add("subdivide", "subdivide" + odd + " -o x.npy --json", {"\"vertices\": "});
  add_targets(all);
  add_case(all, "mesh_without_size", "geodesic",
           file("dot.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), "geodesic dot.obj -o d.vtp", 3,
           {"dot.obj", "no size"});
  add_case(all, "source_vertex_out_of_range", "geodesic", {}, "geodesic head --source 225 -o d.vtp",
           4, {"--source", "vertex 225", "225"});
  add_case(all, "source_vertex_negative", "geodesic", {}, "geodesic head --source -1 -o d.vtp", 2,
           {"--source", "-1"});
  add_case(all, "support_map_upside_down", "geodesic", {},
           "geodesic head --source 1 --d-min 0.8 -o d.vtp", 2, {"--d-min", "--d-max"});
  add_case(all, "rest_of_other_count", "transfer", file("one.obj", bytes_of(square(), "obj")),
           "transfer head --weights take.csv head --source-rest one.obj -o x", 4,
           {"one.obj", "4 vertices, expected 225"});
  add_case(all, "rest_of_other_count", "decompose", file("one.obj", bytes_of(square(), "obj")),
           "decompose head --weights take.csv --rest one.obj -o c.h5", 4,
           {"one.obj", "4 vertices, expected 225"});
  add_case(all, "rest_of_other_faces", "transfer", target([](RawMesh& mesh) {
             for (auto& face : mesh.faces) {
               for (auto& corner : face) corner = corner == 3 ? 40 : corner == 40 ? 3 : corner;
             }
           }),
           "transfer head --weights take.csv head --source-rest other.obj -o x", 4,
           {"other.obj", "other vertices than in the sequence", "check --match"});
  return all;
}

}  // namespace mimetra::test
