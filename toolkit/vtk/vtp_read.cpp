#include <algorithm>
#include <charconv>
#include <cmath>

#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>
#include <nlohmann/json.hpp>

#include "toolkit/io/frame_files.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/silent_vtk.h"
#include "toolkit/vtk/vtp_header.h"
#include "toolkit/vtk/vtp_series.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// What else may be wrong with a file that VTK does not read.
std::string hint_of(const std::string& text) {
  if (text.find("<AppendedData") == std::string::npos) return "";
  return "; its data are appended, which VTK does not read with newer versions of libexpat: save "
         "it "
         "in ParaView with the data mode Binary";
}

vtkSmartPointer<vtkPolyData> read_poly_data(const fs::path& path) {
  const std::string text = read_file(path);
  check_vtp_header(path.string(), text);
  const SilentVtk silent;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(text);
  if (!reader->GetExecutive()->Update() || reader->GetErrorCode() != vtkErrorCode::NoError) {
    throw IoError(path.string(), "not a readable VTP file, or truncated" + hint_of(text));
  }
  if (reader->GetOutput()->GetNumberOfPoints() == 0) {
    throw IoError(path.string(), "has no points, or its counts do not fit");
  }
  return reader->GetOutput();
}

struct FrameFile {
  fs::path file;
  double time;
};

std::vector<FrameFile> entries_of_pvd(const fs::path& path) {
  const std::vector<XmlElement> elements = xml_elements(path.string(), read_file(path));
  if (std::ranges::find(elements, "Collection", &XmlElement::name) == elements.end()) {
    throw IoError(path.string(), "expected a VTKFile with a Collection");
  }
  std::vector<FrameFile> entries;
  for (const XmlElement& element : elements) {
    if (element.parent != "Collection") continue;
    const std::string file = element.attribute("file"), time = element.attribute("timestep");
    double seconds = 0;
    const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), seconds);
    if (file.empty() || error != std::errc() || end != time.data() + time.size()) {
      throw IoError(path.string(),
                    "DataSet " + std::to_string(entries.size()) + " has no file or no timestep");
    }
    entries.push_back({path.parent_path() / file, seconds});
  }
  return entries;
}

std::vector<FrameFile> entries_of_series(const fs::path& path) {
  std::vector<FrameFile> entries;
  try {
    const Json series = read_json(path, "JSON with a list `files` of name and time");
    for (const auto& entry : series.at("files")) {
      entries.push_back({path.parent_path() / entry.at("name").get<std::string>(),
                         entry.at("time").get<double>()});
    }
  } catch (const Json::exception&) {
    throw IoError(path.string(), "expected JSON with a list `files` of name and time");
  }
  return entries;
}

std::vector<FrameFile> listed_by(const fs::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".vtp") return {{path, 0}};
  if (extension == ".pvd") return entries_of_pvd(path);
  if (extension == ".series") return entries_of_series(path);
  throw IoError(path.string(), "expected a series in .pvd or .vtp.series, or one mesh in .vtp");
}

std::vector<FrameFile> entries_of(const fs::path& path) {
  std::vector<FrameFile> entries = listed_by(path);
  if (entries.empty()) throw IoError(path.string(), "names no frame");
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double time = entries[i].time;
    if (std::isfinite(time) && (i == 0 || time > entries[i - 1].time)) continue;
    throw IoError(path.string(),
                  entries[i].file.filename().string() + " is at the time " + readable(time) +
                      (i == 0 ? ", expected a finite one"
                              : ", expected a later one than " + readable(entries[i - 1].time) +
                                    " of " + entries[i - 1].file.filename().string()) +
                      "; times must ascend, with one file each");
  }
  return entries;
}

}  // namespace

FieldSequence read_vtp_series(const fs::path& path, const VtpReadOptions& options) {
  const std::vector<FrameFile> all = entries_of(path);
  const auto count = static_cast<int>(all.size());
  const std::vector<int> chosen =
      options.selected ? options.selected(count) : selected_frames({}, count);
  const FrameFile& first = all[static_cast<std::size_t>(chosen.front())];
  std::vector<Field> fields;
  Connectivity connectivity;
  Frames frames;
  Eigen::VectorXd times(static_cast<Eigen::Index>(chosen.size()));
  std::optional<Positions> rest;
  for (Eigen::Index f = 0; f < times.size(); ++f) {
    const FrameFile& entry = all[static_cast<std::size_t>(chosen[static_cast<std::size_t>(f)])];
    const auto data = read_poly_data(entry.file);
    const Positions positions = positions_of(*data, entry.file.string());
    Connectivity own = connectivity_of(*data, entry.file.string());
    if (f == 0) {
      connectivity = std::move(own);
      frames.resize(times.size(), positions.size());
      fields = fields_of(*data, connectivity);
      rest = rest_of(*data, positions, entry.file.string());
    } else if (!same_faces(own, connectivity)) {
      throw MismatchError(entry.file.string() + ": other vertices or faces than " +
                          first.file.string());
    }
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(positions.data(), positions.size());
    times[f] = entry.time;
    report_progress(options.progress,
                    static_cast<double>(f + 1) / static_cast<double>(times.size()));
  }
  if (lower_extension(path) == ".vtp") times.resize(0);
  return {
      MeshSequence(std::move(connectivity), std::move(frames), std::move(times), std::move(rest)),
      std::move(fields)};
}

std::vector<fs::path> vtp_series_files(const fs::path& path) {
  std::vector<fs::path> files = {path};
  for (const FrameFile& entry : entries_of(path)) {
    if (entry.file != path) files.push_back(entry.file);
  }
  return files;
}

Eigen::MatrixXd read_vtp_field(const fs::path& path, const std::string& name) {
  const auto data = read_poly_data(path);
  if (const auto values = point_values(*data, name)) return *values;
  vtkPointData* on_points = data->GetPointData();
  std::string known;
  for (int i = 0; i < on_points->GetNumberOfArrays(); ++i) {
    known += (i ? ", " : "") + std::string(on_points->GetArrayName(i));
  }
  throw IoError(path.string(), "no field '" + name + "' on the vertices; it has " +
                                   (known.empty() ? "none" : known));
}

std::optional<Eigen::MatrixXd> find_vtp_field(const fs::path& path, const std::string& name) {
  return point_values(*read_poly_data(path), name);
}

}  // namespace mimetra
