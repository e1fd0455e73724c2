#include "toolkit/io/sequence_parts.h"

#include <cmath>
#include <string>

#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// A file that only mimetra reads: it holds what the program held.
void add_pose(PendingOutputs& outputs, const fs::path& target, const SequenceHeader& header,
              std::vector<fs::path>& files) {
  write_mesh(outputs.add(target, PendingOutput::Kind::file, PendingOutputs::Existing::same),
             {header.rest.data(), header.rest.rows(), 3}, *header.connectivity,
             {.double_precision = true, .extension = ".ply"});
  files.push_back(target);
}

bool stands(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

}  // namespace

Eigen::VectorXd frame_times(int frames, const SequenceSource& source) {
  const double fps = source.fps.value_or(kDefaultFramesPerSecond);
  Eigen::VectorXd times(frames);
  for (Eigen::Index i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i) / fps;
  return times;
}

void check_times(const std::string& name, const Eigen::VectorXd& times) {
  for (Eigen::Index frame = 0; frame < times.size(); ++frame) {
    if (std::isfinite(times[frame]) && (frame == 0 || times[frame] > times[frame - 1])) continue;
    throw IoError(name, "frame " + std::to_string(frame) + " is at " + readable(times[frame]) +
                            " s, expected times that rise");
  }
}

fs::path topology_of(const fs::path& path, const SequenceSource& source) {
  if (source.topology) return *source.topology;
  const fs::path topology = beside(path, kTopologySuffix);
  if (!stands(topology)) {
    throw IoError(path.string(), "says nothing of faces and there is no " + topology.string() +
                                     "; name a mesh file with --topology");
  }
  return topology;
}

std::optional<Positions> rest_beside(const fs::path& sequence, const MeshFileReader& reader,
                                     std::vector<fs::path>& files) {
  const fs::path rest = beside(sequence, kRestSuffix);
  if (!stands(rest)) return std::nullopt;
  files.push_back(rest);
  return reader.read(rest);
}

void add_topology_beside(PendingOutputs& outputs, const fs::path& sequence,
                         const SequenceHeader& header, std::vector<fs::path>& files) {
  add_pose(outputs, beside(sequence, kTopologySuffix), header, files);
}

void add_rest_beside(PendingOutputs& outputs, const fs::path& sequence,
                     const SequenceHeader& header, std::vector<fs::path>& files) {
  const fs::path rest = beside(sequence, kRestSuffix);
  if (header.rest_is_known) {
    add_pose(outputs, rest, header, files);
  } else {
    outputs.add_stale(rest);
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

bool needs_double(const PositionsView& poses, double extent) {
  constexpr double kRounding = 6e-8;     // of float32, relative
  constexpr double kMostRounded = 1e-5;  // of the longest side: well below what one sees
  return kRounding * poses.cwiseAbs().maxCoeff() > kMostRounded * extent;
}

void check_single_precision(const fs::path& target, const PositionsView& poses, double extent) {
  if (!needs_double(poses, extent)) return;
  throw MismatchError(target.string() + ": " + target.extension().string() +
                      " holds single precision only, which would round motion that one sees: "
                      "the mesh lies " +
                      readable(poses.cwiseAbs().maxCoeff() / extent, 2) +
                      " times its size from the origin; move it, or write .npy");
}

}  // namespace mimetra
