#include <algorithm>
#include <stdexcept>

#include "toolkit/io/array_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/pending_output.h"
#include "toolkit/io/sequence_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/progress.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

using ExtraFiles = std::vector<std::pair<std::string, std::string>>;

PositionsView view_of(const Positions& positions) {
  return {positions.data(), positions.rows(), 3};
}

/// A file that only mimetra reads: it holds what the program held.
void add_pose(PendingOutputs& outputs, const fs::path& target, const MeshSequence& sequence,
              std::vector<fs::path>& files) {
  write_mesh(outputs.add(target, PendingOutput::Kind::file, PendingOutputs::Existing::same),
             view_of(sequence.rest()), sequence.connectivity(),
             {.double_precision = true, .extension = ".ply"});
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
    write_bytes(outputs.add(path, PendingOutput::Kind::file, PendingOutputs::Existing::anything),
                content);
    files.push_back(path);
  }
}

/// Far from the origin single precision would round the motion away.
bool needs_double(const MeshSequence& sequence) {
  constexpr double kRounding = 6e-8;     // of float32, relative
  constexpr double kMostRounded = 1e-5;  // of the longest side: well below what one sees
  return kRounding * sequence.positions().cwiseAbs().maxCoeff() > kMostRounded * sequence.extent();
}

std::vector<fs::path> write_folder(const MeshSequence& sequence, const fs::path& target,
                                   const SequenceWriteOptions& options, const ExtraFiles& extra) {
  PendingOutputs outputs(options.overwrite, options.inputs);
  const fs::path folder = outputs.add(target, PendingOutput::Kind::folder);
  const bool double_precision = options.double_precision || needs_double(sequence);
  std::vector<fs::path> files;
  for (int frame = 0; frame < sequence.frames(); ++frame) {
    files.push_back(target / frame_name(frame, sequence.frames(), "." + options.format));
  }
  report_progress(options.progress, 0);
  const MeshFileWriter writer(sequence.connectivity(), "." + options.format, double_precision);
  const auto write_pose = [&](int frame) {
    writer.write(folder / files[static_cast<std::size_t>(frame)].filename(), sequence.frame(frame));
  };
  parallel_for(sequence.frames(), options.threads, write_pose, options.progress);
  for (const auto& [name, content] : extra) {
    write_bytes(folder / name, content);
    files.push_back(target / name);
  }
  const fs::path manifest = target / kFolderManifest;
  if (std::ranges::find(files, manifest) == files.end()) files.push_back(manifest);
  // STL numbers its vertices anew, so that a rest pose in the old order would not fit.
  add_rest(outputs, target, sequence, options.format != "stl", files);
  report_progress(options.progress, 1);
  outputs.commit();
  return files;
}

std::vector<fs::path> write_array(const MeshSequence& sequence, const fs::path& target,
                                  const SequenceWriteOptions& options, const ExtraFiles& extra) {
  PendingOutputs outputs(options.overwrite, options.inputs);
  std::vector<fs::path> files = {target};
  report_progress(options.progress, 0);
  write_npy_frames(outputs.add(target, PendingOutput::Kind::file), sequence.positions(),
                   options.single_precision, options.threads);
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
  PendingOutputs outputs(options.overwrite, options.inputs);
  std::vector<fs::path> files = {target};
  write_mesh(outputs.add(target, PendingOutput::Kind::file), sequence.frame(0),
             sequence.connectivity(),
             {.double_precision = options.double_precision || needs_double(sequence),
              .extension = target.extension().string()});
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
