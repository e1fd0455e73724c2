#include <algorithm>
#include <cctype>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUtilities.h>
#include <nlohmann/json.hpp>

#include <mimetra/io/pending_output.h>
#include <mimetra/vtk/silent_vtk.h>
#include <mimetra/vtk/vtp_series.h>

namespace mimetra {

namespace {

namespace fs = std::filesystem;

vtkSmartPointer<vtkPolyData> read_poly_data(const fs::path& path) {
  // VTK reads a folder as an empty file and a missing one as an error without a reason.
  if (!fs::exists(path)) throw IoError(path.string(), "no such file");
  if (fs::is_directory(path)) throw IoError(path.string(), "is a folder");
  const SilentVtk silent;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(path.c_str());
  if (!reader->GetExecutive()->Update() || reader->GetErrorCode() != vtkErrorCode::NoError) {
    throw IoError(path.string(), "not a readable VTP file, or truncated");
  }
  return reader->GetOutput();
}

Eigen::MatrixXd values_of(vtkDataArray& array) {
  Eigen::MatrixXd values(array.GetNumberOfTuples(), array.GetNumberOfComponents());
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      values(row, column) = array.GetComponent(row, static_cast<int>(column));
    }
  }
  return values;
}

struct FrameEntry {
  fs::path file;
  double time;
};

std::vector<FrameEntry> entries_of_pvd(const fs::path& path) {
  const SilentVtk silent;
  const auto root = vtkSmartPointer<vtkXMLDataElement>::Take(
      vtkXMLUtilities::ReadElementFromString(read_file(path).c_str()));
  vtkXMLDataElement* list = root ? root->FindNestedElementWithName("Collection") : nullptr;
  if (!list) throw IoError(path.string(), "expected a VTKFile with a Collection");
  std::vector<FrameEntry> entries;
  for (int i = 0; i < list->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement* element = list->GetNestedElement(i);
    const char* file = element->GetAttribute("file");
    double time = 0;
    if (!file || !element->GetScalarAttribute("timestep", time)) {
      throw IoError(path.string(), "DataSet " + std::to_string(i) + " has no file or no timestep");
    }
    entries.push_back({path.parent_path() / file, time});
  }
  return entries;
}

std::vector<FrameEntry> entries_of_series(const fs::path& path) {
  std::vector<FrameEntry> entries;
  try {
    const auto series = nlohmann::json::parse(read_file(path));
    for (const auto& entry : series.at("files")) {
      entries.push_back({path.parent_path() / entry.at("name").get<std::string>(),
                         entry.at("time").get<double>()});
    }
  } catch (const nlohmann::json::exception&) {
    throw IoError(path.string(), "expected JSON with a list `files` of name and time");
  }
  return entries;
}

std::vector<FrameEntry> entries_of(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  std::vector<FrameEntry> entries = extension == ".vtp"   ? std::vector{FrameEntry{path, 0}}
                                    : extension == ".pvd" ? entries_of_pvd(path)
                                                          : entries_of_series(path);
  if (entries.empty()) throw IoError(path.string(), "names no frame");
  return entries;
}

Positions positions_of(vtkPolyData& data, const fs::path& file) {
  if (data.GetNumberOfPoints() == 0)
    throw IoError(file.string(), "has no points, or its counts do not fit");
  const Positions positions = values_of(*data.GetPoints()->GetData());
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    if (!positions.row(v).allFinite()) {
      throw IoError(file.string(), "point " + std::to_string(v) + " is not finite");
    }
  }
  return positions;
}

Connectivity connectivity_of(vtkPolyData& data, const fs::path& file) {
  Polygons polygons;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < data.GetNumberOfPolys(); ++cell) {
    data.GetPolys()->GetCellAtId(cell, corners);
    for (const vtkIdType corner : *corners) polygons.corners.push_back(static_cast<int>(corner));
    polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
  }
  if (polygons.size() == 0) throw IoError(file.string(), "has no faces");
  try {
    return Connectivity::from_polygons(static_cast<int>(data.GetNumberOfPoints()),
                                       std::move(polygons));
  } catch (const std::invalid_argument& error) {
    throw IoError(file.string(), error.what());
  }
}

/// Values of each polygon on its triangles. VTK counts vertices and lines before polygons.
Eigen::MatrixXd on_triangles(const Eigen::MatrixXd& on_cells, Eigen::Index before,
                             const Connectivity& connectivity) {
  return on_cells.middleRows(before, connectivity.polygons.size())(connectivity.polygon_of_triangle,
                                                                   Eigen::all);
}

std::vector<Field> fields_of(vtkPolyData& data, const Connectivity& connectivity) {
  std::vector<Field> fields;
  const auto add = [&fields](vtkFieldData& arrays, Field::Location location, auto placed) {
    for (int i = 0; i < arrays.GetNumberOfArrays(); ++i) {
      vtkDataArray* array = vtkDataArray::SafeDownCast(arrays.GetAbstractArray(i));
      if (!array || !array->GetName()) continue;
      const std::string name = array->GetName();
      if (name == kDisplacement || name == kDisplacementLength) continue;
      const bool integer = array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE;
      fields.push_back({name, location, placed(values_of(*array)), integer});
    }
  };
  add(*data.GetPointData(), Field::Location::vertices,
      [](const Eigen::MatrixXd& values) { return values; });
  const Eigen::Index before = data.GetNumberOfVerts() + data.GetNumberOfLines();
  add(*data.GetCellData(), Field::Location::triangles,
      [&](const Eigen::MatrixXd& values) { return on_triangles(values, before, connectivity); });
  return fields;
}

}  // namespace

FieldSequence read_vtp_series(const fs::path& path,
                              const std::function<std::vector<int>(int count)>& selected,
                              const Progress& progress) {
  const std::vector<FrameEntry> all = entries_of(path);
  const std::vector<int> chosen = selected(static_cast<int>(all.size()));
  const FrameEntry& first = all[static_cast<std::size_t>(chosen.front())];
  FieldSequence result;
  Connectivity connectivity;
  Frames frames;
  Eigen::VectorXd times(static_cast<Eigen::Index>(chosen.size()));
  std::optional<Positions> rest;
  for (Eigen::Index f = 0; f < times.size(); ++f) {
    const FrameEntry& entry = all[static_cast<std::size_t>(chosen[static_cast<std::size_t>(f)])];
    const auto data = read_poly_data(entry.file);
    const Positions positions = positions_of(*data, entry.file);
    Connectivity own = connectivity_of(*data, entry.file);
    if (f == 0) {
      connectivity = std::move(own);
      frames.resize(times.size(), positions.size());
      result.fields = fields_of(*data, connectivity);
      if (vtkDataArray* moved = data->GetPointData()->GetArray(kDisplacement)) {
        if (moved->GetNumberOfComponents() == 3) rest = positions - values_of(*moved);
      }
    } else if (!same_faces(own, connectivity)) {
      throw MismatchError(entry.file.string() + ": other vertices or faces than " +
                          first.file.string());
    }
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(positions.data(), positions.size());
    times[f] = entry.time;
    report_progress(progress, static_cast<double>(f + 1) / static_cast<double>(times.size()));
  }
  result.sequence =
      MeshSequence(std::move(connectivity), std::move(frames), std::move(times), std::move(rest));
  return result;
}

std::vector<fs::path> vtp_series_files(const fs::path& path) {
  std::vector<fs::path> files = {path};
  for (const FrameEntry& entry : entries_of(path)) {
    if (entry.file != path) files.push_back(entry.file);
  }
  return files;
}

Eigen::MatrixXd read_vtp_field(const fs::path& path, const std::string& name) {
  const auto data = read_poly_data(path);
  vtkPointData* on_points = data->GetPointData();
  if (vtkDataArray* array = on_points->GetArray(name.c_str())) return values_of(*array);
  std::string known;
  for (int i = 0; i < on_points->GetNumberOfArrays(); ++i) {
    known += (i ? ", " : "") + std::string(on_points->GetArrayName(i));
  }
  throw IoError(path.string(), "no field '" + name + "' on the vertices; it has " +
                                   (known.empty() ? "none" : known));
}

}  // namespace mimetra
