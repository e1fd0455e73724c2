#include <algorithm>
#include <memory>
#include <stdexcept>

#include <mimetra/io/array_file.h>
#include <mimetra/io/frame_files.h>
#include <mimetra/io/mesh_file.h>
#include <mimetra/io/pending_output.h>
#include <mimetra/io/sequence_file.h>

namespace mimetra {
namespace fs = std::filesystem;
namespace {

using ExtraFiles = std::vector<std::pair<std::string, std::string>>;

/// Several outputs that appear one right after the other when all of them are whole.
class PendingOutputs {
 public:
  explicit PendingOutputs(bool overwrite) : overwrite_(overwrite) {}
  PendingOutputs(const PendingOutputs&) = delete;
  PendingOutputs& operator=(const PendingOutputs&) = delete;
  /// The first one made the parent folders and can remove them only when the others are gone.
  ~PendingOutputs() {
    while (!outputs_.empty()) outputs_.pop_back();
  }

  /// The temporary path to write to.
  const fs::path& add(const fs::path& target, PendingOutput::Kind kind) {
    outputs_.push_back(std::make_unique<PendingOutput>(target, kind, overwrite_));
    return outputs_.back()->path();
  }

  /// A file of an earlier output that would be taken for a part of this one. Throws OutputError
  /// unless it may be replaced; commit() removes it.
  void add_stale(const fs::path& path) {
    std::error_code unreadable;
    if (!fs::exists(path, unreadable)) return;
    if (!overwrite_) {
      throw OutputError(path.string(), "exists already; use --force to replace it");
    }
    stale_.push_back(path);
  }

  /// What was added first comes last: whoever sees it sees all that belongs to it.
  void commit() {
    for (const fs::path& path : stale_) {
      std::error_code error;
      fs::remove(path, error);
      if (error) throw OutputError(path.string(), "cannot be removed: " + error.message());
    }
    for (auto output = outputs_.rbegin(); output != outputs_.rend(); ++output) {
      (*output)->commit();
    }
  }

 private:
  bool overwrite_;
  std::vector<std::unique_ptr<PendingOutput>> outputs_;
  std::vector<fs::path> stale_;
};

PositionsView view_of(const Positions& positions) {
  return {positions.data(), positions.rows(), 3};
}

/// A file that only mimetra reads: it holds what the program held.
void add_pose(PendingOutputs& outputs, const fs::path& target, const MeshSequence& sequence,
              std::vector<fs::path>& files) {
  write_mesh(outputs.add(target, PendingOutput::Kind::file), view_of(sequence.rest()),
             sequence.connectivity(), {.double_precision = true, .extension = ".ply"});
  files.push_back(target);
}

void add_rest(PendingOutputs& outputs, const fs::path& sequence_path, const MeshSequence& sequence,
              bool is_kept, std::vector<fs::path>& files) {
  const fs::path target = beside(sequence_path, kRestSuffix);
  if (is_kept && sequence.rest_is_known()) {
    add_pose(outputs, target, sequence, files);
  } else {
    outputs.add_stale(target);
  }
}

void add_extra_beside(PendingOutputs& outputs, const fs::path& target, const ExtraFiles& extra,
                      std::vector<fs::path>& files) {
  for (const auto& [name, content] : extra) {
    const fs::path path = target.parent_path() / name;
    write_bytes(outputs.add(path, PendingOutput::Kind::file), content);
    files.push_back(path);
  }
}

std::string frame_name(int frame, int frames, const std::string& format) {
  constexpr std::size_t kLeastDigits = 4;
  const std::size_t digits = std::max(kLeastDigits, std::to_string(frames - 1).size());
  const std::string number = std::to_string(frame);
  return "frame_" + std::string(digits - number.size(), '0') + number + "." + format;
}

std::vector<fs::path> write_folder(const MeshSequence& sequence, const fs::path& target,
                                   const SequenceWriteOptions& options, const ExtraFiles& extra) {
  PendingOutputs outputs(options.overwrite);
  const fs::path folder = outputs.add(target, PendingOutput::Kind::folder);
  std::vector<fs::path> files;
  for (int frame = 0; frame < sequence.frames(); ++frame) {
    report_progress(options.progress, static_cast<double>(frame) / sequence.frames());
    const std::string name = frame_name(frame, sequence.frames(), options.format);
    write_mesh(folder / name, sequence.frame(frame), sequence.connectivity(),
               {.double_precision = options.double_precision});
    files.push_back(target / name);
  }
  for (const auto& [name, content] : extra) {
    write_bytes(folder / name, content);
    files.push_back(target / name);
  }
  // STL numbers its vertices anew, so that a rest pose in the old order would not fit.
  add_rest(outputs, target, sequence, options.format != "stl", files);
  report_progress(options.progress, 1);
  outputs.commit();
  return files;
}

std::vector<fs::path> write_array(const MeshSequence& sequence, const fs::path& target,
                                  const SequenceWriteOptions& options, const ExtraFiles& extra) {
  PendingOutputs outputs(options.overwrite);
  std::vector<fs::path> files = {target};
  report_progress(options.progress, 0);
  write_npy_frames(outputs.add(target, PendingOutput::Kind::file), sequence.positions(),
                   options.single_precision);
  add_pose(outputs, beside(target, kTopologySuffix), sequence, files);
  add_rest(outputs, target, sequence, true, files);
  add_extra_beside(outputs, target, extra, files);
  report_progress(options.progress, 1);
  outputs.commit();
  return files;
}

std::vector<fs::path> write_single(const MeshSequence& sequence, const fs::path& target,
                                   const SequenceWriteOptions& options, const ExtraFiles& extra) {
  if (sequence.frames() != 1) {
    throw MismatchError(target.string() + ": one mesh file cannot hold " +
                        std::to_string(sequence.frames()) +
                        " frames; name a folder, a .npy file, or one frame with --frames");
  }
  PendingOutputs outputs(options.overwrite);
  std::vector<fs::path> files = {target};
  write_mesh(
      outputs.add(target, PendingOutput::Kind::file), sequence.frame(0), sequence.connectivity(),
      {.double_precision = options.double_precision, .extension = target.extension().string()});
  add_extra_beside(outputs, target, extra, files);
  report_progress(options.progress, 1);
  outputs.commit();
  return files;
}

}  // namespace

std::vector<fs::path> write_sequence(const MeshSequence& sequence, const fs::path& target,
                                     const SequenceWriteOptions& options, const ExtraFiles& extra) {
  if (!is_mesh_extension("." + options.format)) {
    throw std::invalid_argument("format '" + options.format + "': expected ply, obj, off or stl");
  }
  if (sequence.frames() == 0) throw std::invalid_argument("the sequence has no frames");
  if (is_array(target)) return write_array(sequence, target, options, extra);
  if (is_mesh_extension(target.extension().string()))
    return write_single(sequence, target, options, extra);
  return write_folder(sequence, target, options, extra);
}

}  // namespace mimetra
