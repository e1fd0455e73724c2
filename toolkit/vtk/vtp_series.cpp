#include "toolkit/vtk/vtp_series.h"

#include <algorithm>
#include <charconv>
#include <memory>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>

#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/poly_data.h"
#include "toolkit/vtk/silent_vtk.h"

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

/// A mesh as vtkPolyData. Only its points and displacements change from frame to frame.
class FrameData {
 public:
  explicit FrameData(const FieldSequence& fields) : fields_(fields) {
    const Connectivity& connectivity = fields.frames->connectivity();
    set_polygons(*data_, connectivity);
    for (const Field& field : fields.fields) add_field(*data_, field, connectivity);
  }

  vtkPolyData& at(int frame) {
    const Frames pose = fields_.frames->read(frame, 1);
    const PositionsView positions(pose.data(), fields_.frames->vertices(), 3);
    set_positions(*data_, positions, Precision::single_precision);
    if (fields_.displacement) add_displacement(*data_, positions - fields_.frames->rest());
    return *data_;
  }

 private:
  const FieldSequence& fields_;
  vtkNew<vtkPolyData> data_;
};

/// Text of a .vtp file. VTK does not write it to disk, because on a full disk VTK frees memory that
/// it does not own.
std::string vtp_text(vtkPolyData& data, VtpCompression compression) {
  const vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&data);
  // VTK up to 9.3 cannot read appended data with libexpat 2.6 or later, or with Debian 12's
  // libexpat and its fixes.
  writer->SetDataModeToBinary();
  writer->SetByteOrderToLittleEndian();
  if (compression == VtpCompression::lz4) {
    writer->SetCompressorTypeToLZ4();
  } else {
    writer->SetCompressorTypeToZLib();
  }
  writer->WriteToOutputStringOn();
  if (!writer->Write()) throw std::runtime_error("VTK cannot write this mesh");
  return writer->GetOutputString();
}

/// Meshes for several threads. VTK's arrays cache values computed for a file, so each thread needs
/// its own mesh.
class FrameDataPool {
 public:
  FrameDataPool(const FieldSequence& fields, VtpCompression compression)
      : fields_(fields), compression_(compression) {}

  std::unique_ptr<FrameData> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<FrameData> data = std::move(free_.back());
        free_.pop_back();
        return data;
      }
    }
    auto data = std::make_unique<FrameData>(fields_);
    // The cached values affect the next file. Every mesh therefore writes frame 0 first, so that
    // files do not depend on the thread that writes them.
    vtp_text(data->at(0), compression_);
    return data;
  }

  void give_back(std::unique_ptr<FrameData> data) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(data));
  }

 private:
  const FieldSequence& fields_;
  VtpCompression compression_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<FrameData>> free_;
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

std::filesystem::path write_one(const FieldSequence& fields, const std::filesystem::path& target,
                                const VtpOptions& options, const Context& context) {
  PendingOutputs outputs(options.overwrite, options.inputs, options.together);
  write_bytes(outputs.add(target, PendingOutput::Kind::file),
              vtp_text(FrameData(fields).at(0), options.compression));
  context.report(1);
  outputs.commit();
  return target;
}

std::vector<std::filesystem::path> write_all(const FieldSequence& fields,
                                             const std::filesystem::path& target,
                                             const VtpOptions& options, const Context& context) {
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
  const auto write = [&](FrameData& data, int f) {
    const std::filesystem::path frame = entries[static_cast<std::size_t>(f)].file;
    write_bytes(folder / frame.filename(), vtp_text(data.at(f), options.compression));
  };
  FrameDataPool pool(fields, options.compression);
  auto first = std::make_unique<FrameData>(fields);
  write(*first, 0);
  pool.give_back(std::move(first));
  const auto write_further = [&](int f) {
    std::unique_ptr<FrameData> data = pool.take();
    write(*data, f + 1);
    pool.give_back(std::move(data));
  };
  parallel_for(fields.frames->frames() - 1, write_further, context);
  context.report(1);
  outputs.commit();
  return written;
}

}  // namespace

std::vector<std::filesystem::path> write_vtp_series(const FieldSequence& fields,
                                                    const std::filesystem::path& target,
                                                    const VtpOptions& options,
                                                    const Context& context) {
  check(fields);
  check_options(options);
  const SilentVtk silent;
  const std::string extension = lower_extension(target);
  if (extension == ".vtp") return {write_one(fields, target, options, context)};
  if (extension == ".pvd") return write_all(fields, target, options, context);
  throw std::invalid_argument(target.string() + ": expected a name that ends in .pvd or .vtp");
}

}  // namespace mimetra
