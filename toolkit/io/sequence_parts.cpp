#include "toolkit/io/sequence_parts.h"

#include <cmath>
#include <string>

#include "toolkit/io/csv.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_codecs.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/sequence_companions.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Of NAME.times.csv, in seconds.
constexpr std::string_view kTimeColumn = "time";

bool stands(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

/// A file that only mimetra reads: it holds what the program held.
void add_pose(PendingOutputs& outputs, const fs::path& sequence, const std::string& suffix,
              const SequenceHeader& header, std::vector<fs::path>& files) {
  const fs::path target = beside(sequence, suffix);
  write_mesh(outputs.add(target, PendingOutput::Kind::file, PendingOutputs::Existing::same,
                         other_of_name(sequence)),
             {header.rest.data(), header.rest.rows(), 3}, *header.connectivity,
             {.double_precision = true, .extension = ".ply"});
  files.push_back(target);
}

}  // namespace

void check_rate(const std::string& name, const Eigen::VectorXd& times,
                const SequenceSource& source) {
  if (!source.fps || times.size() == 0) return;
  throw std::invalid_argument(name + ": its " + std::to_string(times.size()) +
                              " frames have times of their own, " + readable(times[0]) + " to " +
                              readable(times[times.size() - 1]) +
                              " s, and option 'fps' is for what has none; leave it out");
}

std::string note_on_steps(const Eigen::VectorXd& times) {
  constexpr double kLongest = 1;
  constexpr Eigen::Index kMany = 10;
  if (times.size() < 2) return "";
  const double step = median_difference(times);
  const bool are_whole =
      times.size() >= kMany && step >= kLongest && (times.array() == times.array().round()).all();
  if (!(step > kLongest) && !are_whole) return "";
  return "its frames are " + readable(step) +
         " s apart (median), as where times are milliseconds or numbers of frames; expected "
         "seconds";
}

FrameTimes frame_times(const std::string& name, int frames, std::optional<Eigen::VectorXd> known,
                       const SequenceSource& source) {
  if (!known) {
    const double fps = source.fps.value_or(kDefaultFramesPerSecond);
    return {Eigen::VectorXd::LinSpaced(frames, 0, frames - 1) / fps, source.fps.has_value()};
  }
  check_rate(name, *known, source);
  return {*std::move(known), true};
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
                                     "; name a mesh file with option 'topology'");
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

std::optional<Eigen::VectorXd> times_beside(const fs::path& sequence, int frames,
                                            std::vector<fs::path>& files) {
  const fs::path path = beside(sequence, kTimesSuffix);
  if (!stands(path)) return std::nullopt;
  CsvReader csv(path);
  if (csv.names() != std::vector<std::string_view>{kTimeColumn}) {
    csv.fail("expected one column, '" + std::string(kTimeColumn) + "'");
  }
  std::vector<double> seconds;
  while (csv.next_row()) seconds.push_back(csv.number(0));
  Eigen::VectorXd times =
      Eigen::Map<const Eigen::VectorXd>(seconds.data(), static_cast<Eigen::Index>(seconds.size()));
  check_times(path.string(), times);
  if (times.size() != frames) {
    throw MismatchError(path.string() + ": " + std::to_string(times.size()) +
                        " times, expected one for each of the " + std::to_string(frames) +
                        " frames of " + sequence.string() +
                        "; mend it, or remove it where it is of other frames");
  }
  files.push_back(path);
  return times;
}

void add_topology_beside(PendingOutputs& outputs, const fs::path& sequence,
                         const SequenceHeader& header, std::vector<fs::path>& files) {
  add_pose(outputs, sequence, kTopologySuffix, header, files);
}

void add_rest_beside(PendingOutputs& outputs, const fs::path& sequence,
                     const SequenceHeader& header, std::vector<fs::path>& files) {
  if (header.rest_is_known) {
    add_pose(outputs, sequence, kRestSuffix, header, files);
  } else {
    outputs.add_stale(beside(sequence, kRestSuffix), other_of_name(sequence));
  }
}

void add_times_beside(PendingOutputs& outputs, const fs::path& sequence,
                      const SequenceHeader& header, std::vector<fs::path>& files) {
  const fs::path target = beside(sequence, kTimesSuffix);
  if (!header.times_are_known) {
    outputs.add_stale(target, other_of_name(sequence));
    return;
  }
  std::string text = std::string(kTimeColumn) + '\n';
  for (const double time : header.times) {
    append_number(text, time, true);
    text += '\n';
  }
  write_bytes(outputs.add(target, PendingOutput::Kind::file, PendingOutputs::Existing::same,
                          other_of_name(sequence)),
              text);
  files.push_back(target);
}

void add_extra_beside(PendingOutputs& outputs, const fs::path& target, const ExtraFiles& extra,
                      std::vector<fs::path>& files) {
  for (const auto& [name, content] : extra) {
    const fs::path path = target.parent_path() / name;
    write_bytes(outputs.add(path, PendingOutput::Kind::file, existing_beside(name)), content);
    files.push_back(path);
  }
}

}  // namespace mimetra
