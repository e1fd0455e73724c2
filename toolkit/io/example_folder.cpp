#include "toolkit/io/example_folder.h"

#include <algorithm>

#include "toolkit/io/csv.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

constexpr const char* kWeightFile = "examples.csv";
constexpr const char* kMeshColumn = "mesh";

/// Mesh files of the folder, in natural order.
std::vector<fs::path> example_files(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw IoError(folder.string(), "is no folder; expected one of meshes of the target");
  }
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& file = entry->path();
    const bool is_hidden = file.filename().string().starts_with('.');
    if (!is_hidden && is_mesh_extension(file.extension().string())) files.push_back(file);
  }
  if (error) throw IoError(folder.string(), "cannot be read: " + error.message());
  if (files.empty()) throw IoError(folder.string(), "holds no .obj, .ply, .off or .stl file");
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

void check_shape_names(const std::vector<ExampleShape>& shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (shapes[i].name != shapes[j].name) continue;
      throw IoError(shapes[i].path.string(), "is a second mesh named '" + shapes[i].name +
                                                 "', beside " + shapes[j].path.filename().string() +
                                                 "; rename or remove one of them");
    }
  }
}

void read_example_rows(CsvReader& csv, ExampleFolder& folder) {
  if (csv.names().front() != kMeshColumn || csv.names().size() < 2) {
    csv.fail(std::string("expected a first column '") + kMeshColumn +
             "' with names of meshes, then one for each expression");
  }
  for (std::size_t c = 1; c < csv.names().size(); ++c) {
    const std::string name = text_of_csv(csv.names()[c]);
    if (std::ranges::find(folder.weights.names, name) != folder.weights.names.end()) {
      csv.fail("the name '" + name + "' occurs twice");
    }
    folder.weights.names.push_back(name);
  }
  const auto columns = static_cast<Eigen::Index>(folder.weights.names.size());
  folder.weights.weights.resize(0, columns);
  while (csv.next_row()) {
    const std::string name = text_of_csv(csv.field(0));
    const auto is_it = [&name](const ExampleShape& shape) { return shape.name == name; };
    if (std::ranges::none_of(folder.shapes, is_it)) {
      const bool is_file = std::ranges::any_of(folder.shapes, [&name](const ExampleShape& shape) {
        return shape.path.filename() == name;
      });
      csv.fail("there is no mesh '" + name + "' in its folder" +
               (is_file ? "; leave out the file's extension" : ""));
    }
    if (std::ranges::find(folder.weighted, name) != folder.weighted.end()) {
      csv.fail("the mesh '" + name + "' occurs twice");
    }
    const Eigen::Index row = folder.weights.weights.rows();
    folder.weights.weights.conservativeResize(row + 1, Eigen::NoChange);
    for (Eigen::Index c = 0; c < columns; ++c) {
      folder.weights.weights(row, c) = csv.number(static_cast<std::size_t>(c) + 1);
    }
    folder.weighted.push_back(name);
  }
}

}  // namespace

ExampleFolder read_examples(const fs::path& path, const Connectivity& expected,
                            const std::string& expected_name) {
  ExampleFolder folder;
  for (const fs::path& file : example_files(path)) {
    folder.shapes.push_back(
        {file.stem().string(), file, read_positions(file, expected, expected_name)});
  }
  check_shape_names(folder.shapes);
  if (is_there(path / kWeightFile)) {
    CsvReader csv(path / kWeightFile);
    read_example_rows(csv, folder);
  }
  return folder;
}

}  // namespace mimetra
