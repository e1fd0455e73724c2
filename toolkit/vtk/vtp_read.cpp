#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <set>

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <nlohmann/json.hpp>

#include "toolkit/io/binary_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/json_text.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/face_order.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/vtk_file.h"
#include "toolkit/vtk/vtp_series.h"
#include "toolkit/vtk/xml_elements.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

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

/// Files of a series that lists them with their times.
std::vector<FrameFile> listed_by(const fs::path& path) {
  std::vector<FrameFile> entries =
      lower_extension(path) == ".pvd" ? entries_of_pvd(path) : entries_of_series(path);
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

/// Files to which the name of a series refers.
struct SeriesFiles {
  FrameSeries series;
  std::optional<Eigen::VectorXd> times = {};
  std::vector<fs::path> others = {};  ///< further files that are read: a list, times
};

/// Files that a list, a folder or a pattern names, or one file.
SeriesFiles files_of(const fs::path& path) {
  const std::string extension = lower_extension(path);
  std::error_code unreadable;
  if (fs::is_directory(path, unreadable)) {
    SeriesFiles found{frames_of_folder(path, vtk_extensions())};
    found.times = times_beside(name_with(path, kTimesSuffix),
                               static_cast<int>(found.series.frames.size()), found.others);
    return found;
  }
  if (!is_there(path) && is_frame_pattern(path.string())) {
    return {frames_of_pattern(path.string(), vtk_extensions())};
  }
  if (extension == ".pvd" || extension == ".series") {
    SeriesFiles found{.others = {path}};
    const std::vector<FrameFile> entries = listed_by(path);
    found.times.emplace(static_cast<Eigen::Index>(entries.size()));
    for (const FrameFile& entry : entries) {
      (*found.times)[static_cast<Eigen::Index>(found.series.frames.size())] = entry.time;
      found.series.frames.push_back(entry.file);
    }
    return found;
  }
  if (std::ranges::find(vtk_extensions(), extension) == vtk_extensions().end()) {
    throw IoError(path.string(), "expected a series in .pvd or .series, or a mesh in " +
                                     joined(vtk_extensions(), ", ", " or "));
  }
  return {{{path}}};
}

/// Faces of a later frame, in the order of the first frame's. Usually both lists are equal. Throws
/// MismatchError if the faces differ.
Connectivity faces_of(vtkPolyData& data, const VtkFile& file, const Connectivity& first,
                      const VtkFile& first_file) {
  Connectivity found = connectivity_of(data, file.path());
  if (same_faces(found, first)) return found;
  // Faces may be in another order or triangulated differently, but not flipped.
  std::optional<Connectivity> ordered = in_order_of(first, found);
  if (ordered && ordered->triangles == first.triangles) return *std::move(ordered);
  throw MismatchError(file.path() + ": other vertices or faces than " + first_file.path());
}

bool is_no_field(const std::string&) {
  return false;
}

/// Positions of a later frame. Throws MismatchError if its faces differ from the first frame's.
Positions positions_in(const VtkFile& file, const Connectivity& first, const VtkFile& first_file) {
  if (file.stores_cells_of(first_file)) return positions_of(*file.points(), file.path());
  const auto data = file.poly_data(is_no_field);
  faces_of(*data, file, first, first_file);
  return positions_of(*data, file.path());
}

/// Frames that are read from their files on demand, including the first one.
class VtpFrames : public FrameSource {
 public:
  VtpFrames(std::vector<fs::path> files, std::shared_ptr<const VtkFile> first,
            SequenceHeader header)
      : FrameSource(std::move(header)), files_(std::move(files)), first_(std::move(first)) {}

 private:
  void read_frames(int first, FramesView poses) const override {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const VtkFile file(files_[static_cast<std::size_t>(first + row)]);
      const Positions positions = positions_in(file, connectivity(), *first_);
      poses.row(row) = Eigen::Map<const Eigen::RowVectorXd>(positions.data(), positions.size());
    }
  }

  std::vector<fs::path> files_;
  std::shared_ptr<const VtkFile> first_;
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
  ComparedFields(const VtkFile& file, const Connectivity& connectivity, std::vector<Field> fields)
      : first_(file), connectivity_(connectivity), steady_(std::move(fields)) {}

  /// Decodes only those fields whose bytes differ from the first file's.
  void look_at(const VtkFile& later) {
    std::set<std::string> unclear;
    for (const Field& field : steady_) {
      if (!later.stores_field_of(first_, {field.location, field.name})) unclear.insert(field.name);
    }
    for (const VtkFile::StoredField& field : later.stored_fields()) {
      const bool is_rest = field.name == kRestPose || field.name == kPlaced;
      if (!is_rest && !has(steady_, field) && !has(changing_, field)) unclear.insert(field.name);
    }
    if (unclear.empty()) return;
    const auto data =
        later.poly_data([&unclear](const std::string& name) { return unclear.contains(name); });
    const std::vector<Field> found =
        fields_of(*data, faces_of(*data, later, connectivity_, first_));
    const auto stays = [&](const Field& field) {
      return !unclear.contains(field.name) ||
             std::ranges::any_of(found, [&](const Field& other) { return is_same(field, other); });
    };
    const auto changed = std::stable_partition(steady_.begin(), steady_.end(), stays);
    std::move(changed, steady_.end(), std::back_inserter(changing_));
    steady_.erase(changed, steady_.end());
    for (const Field& field : found) {
      const VtkFile::StoredField place{field.location, field.name};
      if (!has(steady_, place) && !has(changing_, place)) changing_.push_back(field);
    }
  }

  const std::vector<Field>& steady() const { return steady_; }
  const std::vector<Field>& changing() const { return changing_; }

 private:
  static bool has(const std::vector<Field>& fields, const VtkFile::StoredField& wanted) {
    return std::ranges::any_of(fields, [&wanted](const Field& field) {
      return field.name == wanted.name && field.location == wanted.location;
    });
  }

  const VtkFile& first_;
  const Connectivity& connectivity_;
  std::vector<Field> steady_, changing_;
};

/// Rest poses and fields found in the frames. `displaced` is implied by displacements, `carried`
/// came along a pipeline.
struct Findings {
  std::optional<Positions> displaced;
  std::optional<CarriedRest> carried;
  std::vector<Field> fields, changing;
};

/// Whether a field says where the rest pose is.
bool tells_of_rest(const std::string& name) {
  return name == kRestPose || name == kPlaced || name == kDisplacement ||
         name == kDisplacementLength;
}

Findings look_through(const VtkFile& first, const Positions& positions,
                      const Connectivity& connectivity, const std::vector<fs::path>& files,
                      bool with_fields, const Context& context) {
  const auto data =
      first.poly_data(with_fields ? std::function<bool(const std::string&)>() : tells_of_rest);
  DisplacedRest displaced(static_cast<int>(files.size()));
  displaced.look_at(*data, positions);
  std::optional<CarriedRest> carried = rest_of(*data, positions, first.path());
  const auto is_whole = [&carried] { return carried && carried->note.empty(); };
  ComparedFields fields(first, connectivity,
                        with_fields ? fields_of(*data, connectivity) : std::vector<Field>());
  for (int f = 1; f < static_cast<int>(files.size()); ++f) {
    context.report(static_cast<double>(f) / static_cast<double>(files.size()));
    const bool is_sampled = displaced.looks_at(f);
    if (!is_sampled && fields.steady().empty()) continue;
    if (!displaced.is_possible() && !is_whole() && !with_fields) break;
    const VtkFile file(files[static_cast<std::size_t>(f)]);
    if (with_fields) fields.look_at(file);
    if (!is_sampled) continue;
    const auto later_data = file.poly_data(tells_of_rest);
    const Positions later = positions_of(*later_data, file.path());
    displaced.look_at(*later_data, later);
    if (!is_whole()) continue;
    if (const auto of_this = rest_of(*later_data, later, file.path())) {
      carried->note = of_this->note;
    }
  }
  Findings found{displaced.found(first.path()), std::move(carried), fields.steady(),
                 fields.changing()};
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

FieldSequence open_vtp_series(const fs::path& path, const ReadOptions& options,
                              const Context& context) {
  check_options(options);
  const SeriesFiles all = files_of(path);
  if (all.times) check_rate(path.string(), *all.times, options.fps);
  for (const std::string& note : all.series.notes) context.note(note);
  const auto count = static_cast<int>(all.series.frames.size());
  const std::vector<int> chosen = selected_frames(options.frames, count);
  std::vector<fs::path> files;
  for (const int frame : chosen) {
    files.push_back(all.series.frames[static_cast<std::size_t>(frame)]);
    OpenedFile(files.back());  // throws if the file is missing
  }
  const auto first = std::make_shared<const VtkFile>(files.front());
  const auto data = first->poly_data(is_no_field);
  const Positions positions = positions_of(*data, first->path());
  SequenceHeader header;
  header.connectivity = std::make_shared<Connectivity>(connectivity_of(*data, first->path()));
  Findings found =
      look_through(*first, positions, *header.connectivity, files, options.fields, context);
  for (const std::string& note : notes_on(found)) context.note(note);
  header.rest = found.carried ? found.carried->positions : found.displaced.value_or(positions);
  header.rest_is_known = found.carried || found.displaced;
  if (all.series.rest) {
    header.rest = positions_in(VtkFile(*all.series.rest), *header.connectivity, *first);
    header.rest_is_known = true;
  }
  const FrameTimes times = frame_times(path.string(), count, all.times, options.fps);
  header.times = times.seconds(chosen);
  header.times_are_known = times.are_known;
  return {std::make_shared<const VtpFrames>(std::move(files), first, std::move(header)),
          std::move(found.fields)};
}

FieldSequence read_vtp_series(const fs::path& path, const ReadOptions& options,
                              const Context& context) {
  FieldSequence open = open_vtp_series(path, options, context.part(0, 0));
  return {MeshSequence(*open.frames, context), std::move(open.fields)};
}

std::vector<fs::path> vtp_series_files(const fs::path& path) {
  SeriesFiles found = files_of(path);
  std::vector<fs::path> files = std::move(found.others);
  files.insert(files.end(), found.series.frames.begin(), found.series.frames.end());
  if (found.series.rest) files.push_back(*found.series.rest);
  return files;
}

Eigen::MatrixXd read_vtp_field(const fs::path& path, const std::string& name) {
  if (const auto values = find_vtp_field(path, name)) return *values;
  std::vector<std::string> known;
  for (const VtkFile::StoredField& field : VtkFile(path).stored_fields()) {
    if (field.location == Field::Location::vertices) known.push_back(field.name);
  }
  throw IoError(path.string(), "no field '" + name + "' on the vertices; it has " +
                                   (known.empty() ? "none" : joined(known)));
}

std::optional<Eigen::MatrixXd> find_vtp_field(const fs::path& path, const std::string& name) {
  const auto data =
      VtkFile(path).poly_data([&name](const std::string& other) { return other == name; });
  return point_values(*data, name);
}

}  // namespace mimetra
