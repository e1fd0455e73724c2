#include <algorithm>
#include <map>

#include "fitting/fit_operation.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/values.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/operations/operation.h"
#include "toolkit/vtk/vtk_formats.h"

namespace mimetra::fuzz {

namespace {

/// Sound files of formats that nothing here writes.
const std::map<std::string, std::vector<std::string>>& texts() {
  static const std::map<std::string, std::vector<std::string>> all = {
      {"regions_txt", {"3\n4\n5\n", "0\n0\n1\n1\n0\n0\n0\n0\n0\n"}},
      {"sequence_vtu",
       {"# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 "
        "0\n"
        "POLYGONS 1 4\n3 0 1 2\nPOINT_DATA 3\nSCALARS a float\nLOOKUP_TABLE default\n1 2 3\n",
        "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n"
        "0 0 0 1 0 0 0 1 0\nCELLS 2 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n"
        "0 1 2\nCELL_TYPES 1\n5\n",
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" "
        "NumberOfCells=\"1\"><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">"
        "0 0 0 1 0 0 0 1 0</DataArray></Points><Cells>"
        "<DataArray type=\"Int32\" Name=\"connectivity\">0 1 2</DataArray>"
        "<DataArray type=\"Int32\" Name=\"offsets\">3</DataArray>"
        "<DataArray type=\"UInt8\" Name=\"types\">5</DataArray></Cells></Piece>"
        "</UnstructuredGrid></VTKFile>"}},
      {"landmarks_pts", {"version: 1\nn_points: 3\n{\n1 2\n3.5 4\n5 6e1\n}\n"}},
      {"landmarks_csv", {"time,x0,y0,x1,y1\n0,1,2,3,4\n0.04,1,2,3,4\n"}},
      {"landmarks_json",
       {R"({"names": ["a", "b"], "frames": [{"time": 0, "points": [[1, 2], null]}]})",
        R"([{"timestamp_ms": 40, "faceLandmarks": [[{"x": 1, "y": 2, "z": -5}]]},
            {"timestamp_ms": 80, "faceLandmarks": []}])"}}};
  return all;
}

/// "landmarks_csv".
std::string name_of(const Format& format) {
  std::string name =
      std::string(kind_name(format.kind)) + '_' + format.extensions.front().substr(1);
  std::ranges::replace(name, ' ', '_');
  return name;
}

void read(const Format& format, const fs::path& file) {
  const Context context = Context().with_threads(1);
  ReadValue read = format.read(file.string(),
                               {.fields = true,
                                .identities = true,
                                .vertices = static_cast<int>(grid().positions.rows()),
                                .triangles = &grid().connectivity.triangles},
                               context);
  in_memory(std::move(read.value.data), context);
}

void write(const Format& format, const Data& value, const fs::path& file) {
  format.write(value, file, {.overwrite = true}, Context().with_threads(1));
}

/// The value, or one frame of it for a format that holds one.
void write_value(const Format& format, const fs::path& file) {
  try {
    write(format, value_of(format.kind), file);
  } catch (const MismatchError&) {
    write(format, one_frame(), file);
  }
}

/// A file as it is under each extension of its format, which readers tell apart by content.
std::vector<std::function<void(const fs::path& file)>> written_seeds(const Format& format) {
  std::vector<std::function<void(const fs::path& file)>> seeds;
  for (const std::string& extension : format.extensions) {
    seeds.push_back([&format, extension](const fs::path& file) {
      const fs::path written = fs::path(file).replace_extension(extension);
      write_value(format, written);
      fs::rename(written, file);
    });
  }
  return seeds;
}

}  // namespace

std::vector<Target> format_targets() {
  static const OperationTable table = [] {
    OperationTable made;
    add_toolkit(made);
    add_vtk(made);
    add_fitting(made);
    return made;
  }();
  std::vector<Target> targets;
  for (const Format& format : table.formats()) {
    const std::string& extension = format.extensions.front();
    if (!format.read || !extension.starts_with('.')) continue;
    Target target{name_of(format),
                  "a" + extension,
                  [&format](const fs::path& file) { read(format, file); },
                  {}};
    if (const auto found = texts().find(target.name); found != texts().end()) {
      for (const std::string& content : found->second) target.seeds.push_back(text(content));
    } else if (format.write) {
      target.seeds = written_seeds(format);
    } else {
      continue;
    }
    targets.push_back(std::move(target));
  }
  return targets;
}

}  // namespace mimetra::fuzz
