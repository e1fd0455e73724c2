#include "toolkit/vtk/vtp_series.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <set>
#include <stdexcept>
#include <utility>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>

#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/silent_vtk.h"
#include "toolkit/vtk/vtk_array.h"

namespace mimetra {
namespace {

constexpr int kFewestDigits = 4;

std::string place_of(Field::Location location) {
  return location == Field::Location::vertices ? "vertices" : "triangles";
}

void check(const FieldSequence& fields) {
  std::set<std::pair<Field::Location, std::string>> names;
  if (fields.displacement) {
    names.insert({Field::Location::vertices, kDisplacement});
    names.insert({Field::Location::vertices, kDisplacementLength});
  }
  for (const Field& field : fields.fields) {
    const Eigen::Index expected = field.location == Field::Location::vertices
                                      ? fields.frames->vertices()
                                      : fields.frames->triangles().rows();
    if (field.values.rows() != expected || field.values.cols() == 0) {
      throw std::invalid_argument(
          "field '" + field.name + "': " + std::to_string(field.values.rows()) + " x " +
          std::to_string(field.values.cols()) + " values, expected " + std::to_string(expected) +
          " rows for the mesh's " + place_of(field.location) + " and at least one column");
    }
    if (!names.insert({field.location, field.name}).second) {
      throw std::invalid_argument("field '" + field.name + "' occurs twice on the " +
                                  place_of(field.location) + "; give each field its own name");
    }
  }
}

/// Texts of the .vtp files of a sequence. What the frames share is encoded once. VTK's writer is
/// not used: it encodes all arrays for each file, and its text depends on the files before.
class VtpTexts {
 public:
  VtpTexts(const FieldSequence& fields, Compression compression)
      : fields_(fields),
        compressor_(compression == Compression::fast ? "vtkLZ4DataCompressor"
                                                     : "vtkZLibDataCompressor") {
    const Connectivity& connectivity = fields.frames->connectivity();
    const vtkNew<vtkPolyData> data;
    set_polygons(*data, connectivity);
    for (const Field& field : fields.fields) add_field(*data, field, connectivity);
    const char* scalars = active_scalars(*data);
    before_ = "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"" +
              std::string(is_little_endian() ? "LittleEndian" : "BigEndian") +
              "\" header_type=\"UInt32\" compressor=\"" + compressor_ +
              "\">\n<PolyData>\n<Piece NumberOfPoints=\"" + std::to_string(connectivity.vertices) +
              "\" NumberOfPolys=\"" + std::to_string(connectivity.polygons.size()) +
              "\">\n<PointData" + (scalars ? " Scalars=\"" + escaped_for_xml(scalars) + '"' : "") +
              ">\n" + elements_of(*data->GetPointData());
    between_ = "</PointData>\n<CellData>\n" + elements_of(*data->GetCellData()) +
               "</CellData>\n<Points>\n";
    vtkDataArray* corners = data->GetPolys()->GetConnectivityArray();
    corners->SetName("connectivity");
    // Files give the ends of faces only.
    vtkNew<vtkTypeInt32Array> ends;
    ends->SetName("offsets");
    for (int polygon = 0; polygon < connectivity.polygons.size(); ++polygon) {
      ends->InsertNextValue(connectivity.polygons.offsets[static_cast<std::size_t>(polygon) + 1]);
    }
    after_ = "</Points>\n<Polys>\n" + data_array_element(*corners, compressor_) +
             data_array_element(*ends, compressor_) +
             "</Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  }

  /// Safe to call from several threads.
  std::string at(int frame) const {
    const Frames pose = fields_.frames->read(frame, 1);
    const PositionsView positions(pose.data(), fields_.frames->vertices(), 3);
    const vtkNew<vtkPolyData> data;
    set_positions(*data, positions, Precision::single_precision);
    if (fields_.displacement) add_displacement(*data, positions - fields_.frames->rest());
    return before_ + elements_of(*data->GetPointData()) + between_ +
           data_array_element(*data->GetPoints()->GetData(), compressor_) + after_;
  }

 private:
  static bool is_little_endian() { return std::endian::native == std::endian::little; }

  static const char* active_scalars(vtkPolyData& data) {
    vtkDataArray* scalars = data.GetPointData()->GetScalars();
    return scalars ? scalars->GetName() : nullptr;
  }

  std::string elements_of(vtkFieldData& arrays) const {
    std::string text;
    for (int i = 0; i < arrays.GetNumberOfArrays(); ++i) {
      text += data_array_element(*arrays.GetArray(i), compressor_);
    }
    return text;
  }

  const FieldSequence& fields_;
  std::string compressor_;
  std::string before_, between_, after_;  ///< around the fields that change, and the points
};

std::string decimal(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string escaped_for_json(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

/// File of a frame, relative to the .pvd, and its time.
struct FrameEntry {
  std::string file;
  double time;
};

std::string pvd_text(const std::vector<FrameEntry>& entries) {
  std::string text =
      "<?xml version=\"1.0\"?>\n"
      "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (const FrameEntry& entry : entries) {
    text += "    <DataSet timestep=\"" + decimal(entry.time) + "\" part=\"0\" file=\"" +
            escaped_for_xml(entry.file) + "\"/>\n";
  }
  return text + "  </Collection>\n</VTKFile>\n";
}

std::string series_text(const std::vector<FrameEntry>& entries) {
  std::string text = "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [";
  const char* separator = "\n";
  for (const FrameEntry& entry : entries) {
    text += separator + std::string("    {\"name\": \"") + escaped_for_json(entry.file) +
            "\", \"time\": " + decimal(entry.time) + "}";
    separator = ",\n";
  }
  return text + "\n  ]\n}\n";
}

/// Folder for the frames of NAME.pvd. It is not NAME, which people use for the meshes of the same
/// sequence.
std::string frames_folder(const std::string& name) {
  return name + "_vtp";
}

std::vector<FrameEntry> entries_of(const FrameSource& sequence, const std::string& name) {
  const int last = sequence.frames() - 1;
  const int digits = std::max(kFewestDigits, static_cast<int>(std::to_string(last).size()));
  std::vector<FrameEntry> entries;
  for (int f = 0; f <= last; ++f) {
    const std::string number = std::to_string(f);
    const std::string zeros(static_cast<std::size_t>(digits) - number.size(), '0');
    const std::string file = name + "_" + zeros + number + ".vtp";
    entries.push_back({frames_folder(name) + "/" + file, sequence.times()[f]});
  }
  return entries;
}

std::vector<std::filesystem::path> write_one(const FieldSequence& fields,
                                             const std::filesystem::path& target,
                                             const WriteOptions& options, const Context& context) {
  PendingOutputs outputs(options.overwrite, options.inputs, options.together);
  write_bytes(outputs.add(target, PendingOutput::Kind::file),
              VtpTexts(fields, options.compression).at(0));
  context.report(1);
  outputs.commit();
  return {target};
}

std::vector<std::filesystem::path> write_all(const FieldSequence& fields,
                                             const std::filesystem::path& target,
                                             const WriteOptions& options, const Context& context) {
  const std::string name = target.stem().string();
  if (!is_printable(name)) {
    throw OutputError(target.string(),
                      "its name has control characters or is no UTF-8, and the list of its frames "
                      "is XML, which cannot hold it; choose another");
  }
  const std::filesystem::path beside = target.parent_path();
  const std::filesystem::path series = beside / (name + ".vtp.series");
  const std::vector<FrameEntry> entries = entries_of(*fields.frames, name);

  for (const auto& path : {target, series, beside / frames_folder(name)}) {
    check_inputs_stay(path, options.inputs);
  }
  PendingOutputs outputs(options.overwrite, options.inputs, options.together);
  write_bytes(outputs.add(target, PendingOutput::Kind::file), pvd_text(entries));
  write_bytes(outputs.add(series, PendingOutput::Kind::file, PendingOutputs::Existing::same),
              series_text(entries));
  const std::filesystem::path frames = beside / frames_folder(name);
  const std::filesystem::path folder = outputs.add(frames, PendingOutput::Kind::folder);

  std::vector<std::filesystem::path> written = {target, series};
  for (const FrameEntry& entry : entries) written.push_back(beside / entry.file);
  written.push_back(frames / kFolderManifest);
  const VtpTexts texts(fields, options.compression);
  const auto write = [&](int f) {
    const std::filesystem::path frame = entries[static_cast<std::size_t>(f)].file;
    write_bytes(folder / frame.filename(), texts.at(f));
  };
  parallel_for(fields.frames->frames(), write, context);
  context.report(1);
  outputs.commit();
  return written;
}

}  // namespace

std::vector<std::filesystem::path> write_vtp_series(const FieldSequence& fields,
                                                    const std::filesystem::path& target,
                                                    const WriteOptions& options,
                                                    const Context& context) {
  check(fields);
  check_options(options);
  const SilentVtk silent;
  const std::string extension = lower_extension(target);
  if (extension == ".vtp" || extension == ".pvd") {
    const auto write = extension == ".vtp" ? write_one : write_all;
    return write_with_extra(target, options,
                            [&] { return write(fields, target, options, context); });
  }
  throw std::invalid_argument(target.string() + ": expected a name that ends in .pvd or .vtp");
}

}  // namespace mimetra
