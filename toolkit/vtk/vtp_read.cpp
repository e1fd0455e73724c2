#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include <vtkErrorCode.h>
#include <vtkExecutive.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>
#include <nlohmann/json.hpp>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/face_order.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/silent_vtk.h"
#include "toolkit/vtk/vtp_header.h"
#include "toolkit/vtk/vtp_series.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// Hint why VTK cannot read a file, or "".
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

/// Faces of a later frame, in the order of the first frame's. Usually both lists are equal. Throws
/// MismatchError if the faces differ.
Connectivity faces_of(vtkPolyData& data, const fs::path& file, const Connectivity& first,
                      const fs::path& first_file) {
  Connectivity found = connectivity_of(data, file.string());
  if (same_faces(found, first)) return found;
  // Faces may be in another order or triangulated differently, but not flipped.
  std::optional<Connectivity> ordered = in_order_of(first, found);
  if (ordered && ordered->triangles == first.triangles) return *std::move(ordered);
  throw MismatchError(file.string() + ": other vertices or faces than " + first_file.string());
}

/// Frames that are read from their files on demand, including the first one.
class VtpFrames : public FrameSource {
 public:
  VtpFrames(std::vector<FrameFile> files, SequenceHeader header)
      : FrameSource(std::move(header)), files_(std::move(files)) {}

 private:
  void read_frames(int first, FramesView poses) const override {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const fs::path& file = files_[static_cast<std::size_t>(first + row)].file;
      const auto data = read_poly_data(file);
      faces_of(*data, file, connectivity(), files_.front().file);  // throws if they differ
      const Positions positions = positions_of(*data, file.string());
      poses.row(row) = Eigen::Map<const Eigen::RowVectorXd>(positions.data(), positions.size());
    }
  }

  std::vector<FrameFile> files_;
};

/// Returns whether two fields are equal; NaN equals NaN.
bool is_same(const Field& a, const Field& b) {
  const auto& x = a.values;
  const auto& y = b.values;
  return a.name == b.name && a.location == b.location && x.rows() == y.rows() &&
         x.cols() == y.cols() &&
         (x.array() == y.array() || (x.array().isNaN() && y.array().isNaN())).all();
}

/// Splits the fields of all frames read into fields that are equal in each frame, and others.
class ComparedFields {
 public:
  explicit ComparedFields(std::vector<Field> first) : steady_(std::move(first)) {}

  void look_at(const std::vector<Field>& later) {
    const auto stays = [&later](const Field& field) {
      return std::ranges::any_of(later, [&](const Field& other) { return is_same(field, other); });
    };
    const auto changed = std::stable_partition(steady_.begin(), steady_.end(), stays);
    std::move(changed, steady_.end(), std::back_inserter(changing_));
    steady_.erase(changed, steady_.end());
    for (const Field& field : later) {
      if (!has(steady_, field) && !has(changing_, field)) changing_.push_back(field);
    }
  }

  const std::vector<Field>& steady() const { return steady_; }
  const std::vector<Field>& changing() const { return changing_; }

 private:
  static bool has(const std::vector<Field>& fields, const Field& wanted) {
    return std::ranges::any_of(fields, [&wanted](const Field& field) {
      return field.name == wanted.name && field.location == wanted.location;
    });
  }

  std::vector<Field> steady_, changing_;
};

/// Rest poses and fields found in the frames. `displaced` is implied by displacements, `carried`
/// came along a pipeline.
struct Findings {
  std::optional<Positions> displaced;
  std::optional<CarriedRest> carried;
  std::vector<Field> fields, changing;
};

Findings look_through(vtkPolyData& first, const Positions& positions,
                      const Connectivity& connectivity, const std::vector<FrameFile>& files,
                      bool with_fields, const Context& context) {
  const std::string name = files.front().file.string();
  DisplacedRest displaced(static_cast<int>(files.size()));
  displaced.look_at(first, positions);
  std::optional<CarriedRest> carried = rest_of(first, positions, name);
  const auto is_whole = [&carried] { return carried && carried->note.empty(); };
  ComparedFields fields(with_fields ? fields_of(first, connectivity) : std::vector<Field>());
  for (int f = 1; f < static_cast<int>(files.size()); ++f) {
    context.report(static_cast<double>(f) / static_cast<double>(files.size()));
    const bool is_sampled = displaced.looks_at(f);
    if (!is_sampled && fields.steady().empty()) continue;
    if (!displaced.is_possible() && !is_whole() && !with_fields) break;
    const fs::path& file = files[static_cast<std::size_t>(f)].file;
    const auto data = read_poly_data(file);
    if (with_fields) {
      fields.look_at(fields_of(*data, faces_of(*data, file, connectivity, files.front().file)));
    }
    if (!is_sampled) continue;
    const Positions later = positions_of(*data, file.string());
    displaced.look_at(*data, later);
    if (!is_whole()) continue;
    if (const auto of_this = rest_of(*data, later, file.string())) carried->note = of_this->note;
  }
  Findings found{displaced.found(name), std::move(carried), fields.steady(), fields.changing()};
  if (found.displaced) {
    std::erase_if(found.fields, is_displacement);
    std::erase_if(found.changing, is_displacement);
  }
  return found;
}

bool may_be_rounded(const Field& field) {
  // Double precision represents all whole numbers up to here.
  const double limit = std::ldexp(1.0, std::numeric_limits<double>::digits);
  return field.integer && (field.values.array().abs() >= limit).any();
}

std::vector<std::string> notes_on(const Findings& found) {
  std::vector<std::string> notes, changing, rounded;
  if (found.carried && !found.carried->note.empty()) notes.push_back(found.carried->note);
  for (const Field& field : found.changing) changing.push_back(field.name);
  for (const Field& field : found.fields) {
    if (may_be_rounded(field)) rounded.push_back(field.name);
  }
  if (!changing.empty()) {
    notes.push_back(
        "a field that changes over the frames, or is not in all, is left out: " + listed(changing) +
        "; to keep that of frame k, convert it alone into .vtp (option 'frames' k:k+1)");
  }
  if (!rounded.empty()) {
    notes.push_back("whole numbers from 2^53 on are rounded to double precision: field " +
                    listed(rounded) + "; where they must stay apart, number them from 0");
  }
  return notes;
}

}  // namespace

FieldSequence open_vtp_series(const fs::path& path, const VtpReadOptions& options,
                              const Context& context) {
  check_options(options);
  const std::vector<FrameFile> all = entries_of(path);
  const auto count = static_cast<int>(all.size());
  std::vector<FrameFile> chosen;
  for (const int frame : options.selected ? options.selected(count) : selected_frames({}, count)) {
    chosen.push_back(all[static_cast<std::size_t>(frame)]);
    OpenedFile(chosen.back().file);  // throws if the file is missing
  }
  const std::string first = chosen.front().file.string();
  const auto data = read_poly_data(chosen.front().file);
  const Positions positions = positions_of(*data, first);
  SequenceHeader header;
  header.connectivity = std::make_shared<Connectivity>(connectivity_of(*data, first));
  Findings found =
      look_through(*data, positions, *header.connectivity, chosen, options.fields, context);
  for (const std::string& note : notes_on(found)) context.note(note);
  header.rest = found.carried ? found.carried->positions : found.displaced.value_or(positions);
  header.rest_is_known = found.carried || found.displaced;
  header.times_are_known = lower_extension(path) != ".vtp";
  header.times = default_times(static_cast<int>(chosen.size()));
  for (std::size_t f = 0; header.times_are_known && f < chosen.size(); ++f) {
    header.times[static_cast<Eigen::Index>(f)] = chosen[f].time;
  }
  return {std::make_shared<const VtpFrames>(std::move(chosen), std::move(header)),
          std::move(found.fields)};
}

FieldSequence read_vtp_series(const fs::path& path, const VtpReadOptions& options,
                              const Context& context) {
  FieldSequence open = open_vtp_series(path, options, context.part(0, 0));
  return {MeshSequence(*open.frames, context), std::move(open.fields)};
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
