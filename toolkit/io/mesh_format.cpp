#include <algorithm>
#include <map>
#include <optional>
#include <span>

#include "toolkit/io/file_parameters.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/material_library.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/io/single_precision.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Frames with one mesh file each.
class FrameFiles : public FrameSource {
 public:
  FrameFiles(std::unique_ptr<const MeshFileReader> reader, std::vector<fs::path> files,
             SequenceHeader header)
      : FrameSource(std::move(header)), reader_(std::move(reader)), files_(std::move(files)) {
    if (!rest_is_known()) {
      header_.rest =
          files_[0] == reader_->first() ? reader_->mesh().positions : reader_->read(files_[0]);
    }
  }

 private:
  void read_frames(int first, FramesView poses) const override {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const fs::path& file = files_[static_cast<std::size_t>(first + row)];
      const std::span<double> pose(poses.row(row).data(), static_cast<std::size_t>(poses.cols()));
      if (file == reader_->first()) {
        std::copy_n(reader_->mesh().positions.data(), pose.size(), pose.begin());
      } else {
        reader_->read(file, pose);
      }
    }
  }

  std::unique_ptr<const MeshFileReader> reader_;
  std::vector<fs::path> files_;
};

/// Data beside the folder of a sequence's files.
struct KnownBeside {
  std::optional<Eigen::VectorXd> times = {};  ///< seconds of each file
  std::optional<Positions> rest = {};
};

KnownBeside known_beside(const fs::path& folder, int frames, const MeshFileReader& reader,
                         std::vector<fs::path>& read) {
  KnownBeside known;
  known.times = times_beside(name_with(folder, kTimesSuffix), frames, read);
  known.rest = rest_beside(name_with(folder, kRestSuffix), reader, read);
  return known;
}

bool has_companion(const fs::path& folder) {
  return fs::exists(beside(name_with(folder, kTimesSuffix), kTimesSuffix)) ||
         fs::exists(beside(name_with(folder, kRestSuffix), kRestSuffix));
}

/// Data beside the folder in which a pattern selects several frames. If the files include others
/// than the folder's frames, there is a note and no data. A single mesh is not part of a sequence.
KnownBeside known_of_folder(const std::vector<fs::path>& files, const MeshFileReader& reader,
                            OpenSequence& open) {
  const fs::path home = fs::absolute(files.front()).lexically_normal().parent_path();
  const auto is_elsewhere = [&home](const fs::path& file) {
    return fs::absolute(file).lexically_normal().parent_path() != home;
  };
  if (files.size() < 2 || !has_companion(home) || std::ranges::any_of(files, is_elsewhere)) {
    return {};
  }
  const std::vector<fs::path> all = frames_of_format(home, files.front().extension().string());
  std::map<std::string, Eigen::Index> place_of;
  for (const fs::path& file : all) {
    place_of.emplace(file.filename().string(), static_cast<Eigen::Index>(place_of.size()));
  }
  std::vector<Eigen::Index> places;
  for (const fs::path& file : files) {
    if (const auto found = place_of.find(file.filename().string()); found != place_of.end()) {
      places.push_back(found->second);
      continue;
    }
    open.notes.push_back(home.string() + ": times and rest pose beside it are not used: " +
                         file.filename().string() + " is none of its " +
                         std::to_string(all.size()) + " frames");
    return {};
  }
  KnownBeside known = known_beside(home, static_cast<int>(all.size()), reader, open.files);
  if (known.times) known.times = Eigen::VectorXd((*known.times)(places));
  return known;
}

class FolderSink : public FrameSink {
 public:
  FolderSink(const SequenceHeader& header, const fs::path& target, const WriteOptions& options,
             const WrittenMaterials& materials, const Context& context)
      : header_(header),
        extent_(extent(header.rest)),
        target_(target),
        extension_('.' + lower_case(options.frame_format)),
        outputs_(options.overwrite, options.inputs, options.together),
        folder_(outputs_.add(target, PendingOutput::Kind::folder)),
        writer_(*header.connectivity, extension_, options.double_precision, {}, target.string(),
                context.part(0, 0.5)),
        exact_writer_(*header.connectivity, extension_, true, {}, target.string(),
                      context.part(0.5, 1)) {
    const auto frames = static_cast<int>(header.times.size());
    for (int frame = 0; frame < frames; ++frame) {
      files_.push_back(target / frame_name(frame, frames, extension_));
    }
    if (materials.text) {
      write_bytes(folder_ / materials.name, *materials.text);
      files_.push_back(target_ / materials.name);
    }
    // A manifest may have megabytes, so it is written now and not kept.
    for (const auto& [name, content] : options.extra) {
      write_bytes(folder_ / name, content);
      files_.push_back(target_ / name);
    }
  }

  void write(int first, const Frames& poses) override {
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const PositionsView pose(poses.row(row).data(), header_.connectivity->vertices, 3);
      const MeshFileWriter& writer = needs_double(pose, extent_) ? exact_writer_ : writer_;
      writer.write(folder_ / files_[static_cast<std::size_t>(first + row)].filename(), pose);
    }
  }

  std::vector<fs::path> commit() override {
    std::vector<fs::path> files = files_;
    const fs::path manifest = target_ / kFolderManifest;
    if (std::ranges::find(files, manifest) == files.end()) files.push_back(manifest);
    // A format without indices renumbers the vertices, so a rest pose in the old order would not
    // fit.
    SequenceHeader kept = header_;
    kept.rest_is_known = kept.rest_is_known && mesh_format(extension_)->parse_mesh;
    add_rest_beside(outputs_, target_, kept, files);
    add_times_beside(outputs_, target_, header_, files);
    outputs_.commit();
    return files;
  }

 private:
  SequenceHeader header_;
  double extent_;
  fs::path target_;
  std::string extension_;
  PendingOutputs outputs_;
  fs::path folder_;
  std::vector<fs::path> files_;
  MeshFileWriter writer_;
  /// Writer for poses far from the origin.
  MeshFileWriter exact_writer_;
};

}  // namespace

OpenSequence open_frames(const FrameSeries& series, const fs::path& folder,
                         const ReadOptions& options, const Context& context) {
  const std::vector<fs::path>& files = series.frames;
  const std::vector<int> chosen = selected_frames(options.frames, static_cast<int>(files.size()));
  OpenSequence open;
  open.notes = series.notes;
  for (const int frame : chosen) open.files.push_back(files[static_cast<std::size_t>(frame)]);
  std::vector<fs::path> frames = open.files;
  // If files do not index vertices, the first frame decides which corners are one vertex, whether
  // or not it is selected.
  const bool names_vertices = mesh_format(files[0].extension().string())->parse_mesh;
  auto reader =
      std::make_unique<const MeshFileReader>(names_vertices ? frames[0] : files[0], context);
  SequenceHeader header;
  header.connectivity = std::make_shared<const Connectivity>(reader->mesh().connectivity);
  const auto count = static_cast<int>(files.size());
  auto [known_times, rest] = folder.empty() ? known_of_folder(files, *reader, open)
                                            : known_beside(folder, count, *reader, open.files);
  const FrameTimes times =
      frame_times(folder.empty() ? files.front().parent_path().string() : folder.string(), count,
                  std::move(known_times), options.fps);
  header.times = times.seconds(chosen);
  header.times_are_known = times.are_known;
  if (!rest && series.rest) {
    rest = reader->read(*series.rest);
    open.files.push_back(*series.rest);
  }
  if (rest) {
    header.rest = *std::move(rest);
    header.rest_is_known = true;
  }
  open.frames =
      std::make_shared<const FrameFiles>(std::move(reader), std::move(frames), std::move(header));
  return open;
}

std::unique_ptr<FrameSink> begin_folder(const SequenceHeader& header, const fs::path& target,
                                        const WriteOptions& options, const Context& context) {
  const HeldParts holds = held_in_folder('.' + options.frame_format);
  if (!holds.groups || !header.connectivity->materials) {
    return std::make_unique<FolderSink>(header, target, options, WrittenMaterials(), context);
  }
  const WrittenMaterials materials = materials_in_folder(*header.connectivity, target);
  SequenceHeader named = header;
  named.connectivity =
      std::make_shared<const Connectivity>(with_library(*header.connectivity, materials.name));
  return std::make_unique<FolderSink>(named, target, options, materials, context);
}

namespace {

/// Opens one mesh as a sequence of one frame.
OpenSequence open_mesh(const fs::path& path, const ReadOptions& options, const Context& context) {
  return open_frames({{path}}, {}, options, context);
}

/// Opens an OM mesh, whose properties may be fields.
OpenSequence open_om(const fs::path& path, const ReadOptions& options, const Context& context) {
  OpenSequence open = open_mesh(path, options, context);
  if (!options.fields) return open;
  FieldsRead read = read_om_fields(path, open.frames->connectivity(), context.part(1, 1));
  open.fields = std::move(read.fields);
  if (!read.left_out.empty()) {
    open.notes.push_back(path.string() + ": its properties " + listed(read.left_out) +
                         " hold no numbers of vertices or faces, and are left out");
  }
  return open;
}

class MeshSink : public FrameSink {
 public:
  MeshSink(const SequenceHeader& header, const fs::path& target, const WriteOptions& options)
      : header_(header),
        target_(target),
        options_(options),
        outputs_(options.overwrite, options.inputs, options.together),
        path_(outputs_.add(target, PendingOutput::Kind::file)) {
    if (lower_extension(target) != ".obj" || !header.connectivity->materials) return;
    const WrittenMaterials materials = materials_beside(*header.connectivity, target);
    header_.connectivity =
        std::make_shared<const Connectivity>(with_library(*header.connectivity, materials.name));
    if (materials.text) {
      library_ = target.parent_path() / materials.name;
      write_bytes(outputs_.add(library_, PendingOutput::Kind::file, PendingOutputs::Existing::same),
                  *materials.text);
    }
  }

  void write(int, const Frames& poses) override {
    const PositionsView pose(poses.data(), header_.connectivity->vertices, 3);
    WriteOptions options = options_;
    if (needs_double(pose, extent(header_.rest))) options.double_precision = true;
    write_mesh(path_, pose, *header_.connectivity, options);
  }

  std::vector<fs::path> commit() override {
    std::vector<fs::path> files = {target_};
    if (!library_.empty()) files.push_back(library_);
    add_extra_beside(outputs_, target_, options_.extra, files);
    outputs_.commit();
    return files;
  }

 private:
  SequenceHeader header_;
  fs::path target_;
  WriteOptions options_;
  PendingOutputs outputs_;
  fs::path path_;
  /// Path of its material library; empty if none is written.
  fs::path library_;
};

std::unique_ptr<FrameSink> begin_mesh(const SequenceHeader& header, const fs::path& target,
                                      const WriteOptions& options, const Context&) {
  if (header.times.size() != 1) {
    throw MismatchError(target.string() + ": one mesh file cannot hold " +
                        std::to_string(header.times.size()) +
                        " frames; name a folder, a .npy file, or one frame with option 'frames'");
  }
  return std::make_unique<MeshSink>(header, target, options);
}

using Texture = HeldParts::Texture;

/// A format with what its files hold in a folder, with files beside it.
Format format_of(const std::string& name, const HeldParts& in_folder) {
  HeldParts holds = in_folder;
  holds.rest = false;
  holds.times = false;
  return {.name = upper_case(name) + " mesh of one frame",
          .extensions = {'.' + name},
          .reading = reading_parameters(),
          .writing = writing_parameters({"double"}),
          .holds = [holds](const WriteOptions&) { return holds; },
          .open = open_mesh,
          .create = begin_mesh};
}

Format ply() {
  Format format = format_of("ply", {.polygons = true, .texture = Texture::corners});
  format.parse_mesh = read_ply;
  format.further_reader = ply_further_reader;
  format.mesh_frame = ply_frame;
  return format;
}

Format obj() {
  Format format = format_of("obj", {.polygons = true, .texture = Texture::corners, .groups = true});
  format.parse_mesh = read_obj;
  format.further_reader = obj_further_reader;
  format.mesh_frame = obj_frame;
  return format;
}

Format off() {
  Format format = format_of("off", {.polygons = true});
  format.parse_mesh = read_off;
  format.further_reader = off_further_reader;
  format.mesh_frame = off_frame;
  return format;
}

Format stl() {
  Format format = format_of("stl", {.vertex_order = false, .exact_positions = false});
  format.mesh_frame = stl_frame;
  return format;
}

Format om() {
  Format format =
      format_of("om", {.polygons = true, .texture = Texture::corners, .bare_faces = false});
  format.open = open_om;
  format.fields = true;
  format.parse_mesh = read_om;
  format.mesh_frame = om_frame;
  return format;
}

}  // namespace

const std::vector<Format>& mesh_formats() {
  static const std::vector<Format> formats = {ply(), obj(), off(), stl(), om()};
  return formats;
}

const Format* mesh_format(const std::string& extension) {
  const std::string wanted = lower_case(extension);
  const auto found = std::ranges::find_if(
      mesh_formats(), [&wanted](const Format& format) { return format.has(wanted); });
  return found == mesh_formats().end() ? nullptr : &*found;
}

bool is_mesh_extension(const std::string& extension) {
  return mesh_format(extension) != nullptr;
}

std::vector<std::string> mesh_extensions() {
  std::vector<std::string> extensions;
  for (const Format& format : mesh_formats()) extensions.push_back(format.extensions.front());
  return extensions;
}

std::string unknown_mesh_extension(const std::string& extension) {
  return (extension.empty() ? "has no extension" : "'" + extension + "' is no mesh format") +
         "; expected " + joined(mesh_extensions(), ", ", " or ");
}

HeldParts held_in_folder(const std::string& extension) {
  const Format* format = mesh_format(extension);
  if (!format) throw std::invalid_argument(unknown_mesh_extension(extension));
  HeldParts holds = format->holds({});
  // Files beside the folder hold the rest pose and the times. A format without indices renumbers
  // the vertices, so that a rest pose in the old order would not fit.
  holds.rest = holds.vertex_order;
  holds.times = true;
  return holds;
}

}  // namespace mimetra
