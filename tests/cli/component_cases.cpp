#include <limits>

#include "tests/cli/bad_input.h"
#include "toolkit/formats/hdf5/components_file.h"

/// Files of components, and the sequence they are used with.
namespace mimetra::test {

namespace {

/// Two components of the patch, as decompose would store them, changed before they are stored.
std::function<void(const fs::path&)> stored(const std::function<void(Components&)>& change) {
  return [change](const fs::path& folder) {
    const MorphableModel model = Patch::model();
    Components components;
    components.rest = model.mean();
    components.triangles = model.connectivity().triangles;
    components.displacements = model.expressions().displacements.transpose().topRows(2);
    components.weights = Patch::performance().weights.leftCols(2);
    components.support = Eigen::MatrixXd::Zero(2, model.vertices());
    components.centers = {48, 71};
    change(components);
    write_components(folder / "c.h5", components, {.overwrite = true});
  };
}

std::function<void(const fs::path&)> cut(double share) {
  return [share](const fs::path& folder) {
    stored([](Components&) {})(folder);
    const auto bytes = static_cast<double>(fs::file_size(folder / "c.h5"));
    fs::resize_file(folder / "c.h5", static_cast<std::uintmax_t>(share * bytes));
  };
}

}  // namespace

std::vector<BadInput> component_cases() {
  std::vector<BadInput> all;
  const auto add = [&all](const std::string& kind, std::function<void(const fs::path&)> make,
                          int code, std::vector<std::string> says) {
    if (code != 0) says.push_back("c.h5");
    add_case(all, kind, "components", std::move(make),
             "regions head --weights take.csv --components c.h5 -o r.json --json", code,
             std::move(says));
  };
  add("whole", stored([](Components&) {}), 0, {"\"energy_share\""});
  add("missing", {}, 3, {"no such file"});
  add("empty", file("c.h5", ""), 3, {"is not an HDF5 file"});
  add("other_type", file("c.h5", bytes_of(square(), "ply")), 3, {"is not an HDF5 file"});
  add("truncated", cut(0.5), 3, {"truncated"});
  add("truncated_at_the_end", cut(0.99), 3, {"truncated"});
  add("a_folder", [](const fs::path& folder) { fs::create_directory(folder / "c.h5"); }, 3,
      {"is a folder"});
  add("index_out_of_range", stored([](Components& c) { c.triangles(3, 1) = 225; }), 3,
      {"triangle 3", "vertex 225", "0 to 224"});
  add("negative_index", stored([](Components& c) { c.triangles(3, 1) = -1; }), 3,
      {"triangle 3", "vertex -1", "0 to 224"});
  add("center_out_of_range", stored([](Components& c) { c.centers[1] = 225; }), 3, {"'centers'"});
  add("not_a_number",
      stored([](Components& c) { c.weights(1, 1) = std::numeric_limits<double>::quiet_NaN(); }), 3,
      {"'W'", "not finite"});
  add("infinity",
      stored([](Components& c) { c.rest(7, 1) = std::numeric_limits<double>::infinity(); }), 3,
      {"'default'", "not finite"});
  add("no_weights", stored([](Components& c) { c.weights.resize(0, 0); }), 4,
      {"no weights W", "decompose"});
  add("no_motion", stored([](Components& c) {
        c.displacements.setZero();
        c.centers = {-1, -1};
      }),
      4, {"no component"});
  add("flipped_triangles",
      stored([](Components& c) { c.triangles.col(1).swap(c.triangles.col(2)); }), 4,
      {"other triangles"});
  add("other_frames",
      stored([](Components& c) { c.weights.conservativeResize(7, Eigen::NoChange); }), 0, {});
  add_case(all, "other_vertex_count", "components",
           [](const fs::path& folder) {
             stored([](Components&) {})(folder);
             write_bytes_to(folder / "one.obj", bytes_of(square(), "obj"));
           },
           "regions one.obj --components c.h5 -o r.json", 4,
           {"c.h5", "225 vertices", "4 vertices"});
  return all;
}

}  // namespace mimetra::test
