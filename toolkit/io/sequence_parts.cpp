#include "toolkit/io/sequence_parts.h"

#include <string_view>

#include "toolkit/io/csv.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_times.h"
#include "toolkit/io/text_cursor.h"
#include "toolkit/io/weight_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/io/written_files.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace fs = std::filesystem;

namespace {

/// Column of NAME.times.csv, in seconds.
constexpr std::string_view kTimeColumn = "time";

/// Adds a mesh file in double precision, since only mimetra reads it.
void add_pose(PendingOutputs& outputs, const fs::path& sequence, const std::string& suffix,
              const SequenceHeader& header, std::vector<fs::path>& files) {
  const fs::path target = beside(sequence, suffix);
  write_mesh(outputs.add(target, PendingOutput::Kind::file, PendingOutputs::Existing::same,
                         other_of_name(sequence)),
             {header.rest.data(), header.rest.rows(), 3}, *header.connectivity,
             {.double_precision = true});
  files.push_back(target);
}

}  // namespace

fs::path other_of_name(const fs::path& sequence) {
  const fs::path name = beside(sequence, ""), own = sequence.lexically_normal();
  std::vector<fs::path> others;
  if (is_there(name / kFolderManifest) && own != name && own != name / "") others.push_back(name);
  for (const std::string_view extension : kExtensionsWithCompanions) {
    const fs::path other = name.string() + std::string(extension);
    if (other != own && is_there(other)) others.push_back(other);
  }
  return others.empty() ? fs::path() : others.front();
}

fs::path topology_of(const fs::path& path, const ReadOptions& options) {
  if (options.topology) return *options.topology;
  const fs::path topology = beside(path, kTopologySuffix);
  if (!is_there(topology)) {
    throw IoError(path.string(), "says nothing of faces and there is no " + topology.string() +
                                     "; name a mesh file with option 'topology'");
  }
  return topology;
}

std::optional<Positions> rest_beside(const fs::path& sequence, const MeshFileReader& reader,
                                     std::vector<fs::path>& files) {
  const fs::path rest = beside(sequence, kRestSuffix);
  if (!is_there(rest)) return std::nullopt;
  files.push_back(rest);
  return reader.read(rest);
}

std::optional<Eigen::VectorXd> times_beside(const fs::path& sequence, int frames,
                                            std::vector<fs::path>& files) {
  const fs::path path = beside(sequence, kTimesSuffix);
  if (!is_there(path)) return std::nullopt;
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
    append_number(text, time);
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

namespace {

std::vector<std::string> match_notes(const fs::path& weights, const fs::path& model,
                                     const WeightMatch& match) {
  std::vector<std::string> notes;
  if (!match.unmatched_columns.empty()) {
    notes.push_back(weights.string() +
                    ": columns that drive no expression: " + listed(match.unmatched_columns));
  }
  if (!match.undriven_expressions.empty()) {
    notes.push_back(model.string() +
                    ": expressions that no column drives: " + listed(match.undriven_expressions));
  }
  return notes;
}

/// Sequence of one frame with all weights at 0.
std::shared_ptr<const FrameSource> resting(std::shared_ptr<const BlendshapeModel> model,
                                           const ReadOptions& options) {
  selected_frames(options.frames, 1);
  const int expressions = model->expressions().size();
  return std::make_shared<const Animation>(std::move(model), Eigen::MatrixXd::Zero(1, expressions));
}

Eigen::MatrixXd weights_of(const fs::path& path, const WeightTrack& track,
                           const std::vector<std::string>& expressions) {
  try {
    return weights_for(track, expressions);
  } catch (const MismatchError& error) {
    throw MismatchError(path.string() + ": " + error.what());
  }
}

}  // namespace

OpenSequence drive(std::shared_ptr<const BlendshapeModel> model, const fs::path& path,
                   const ReadOptions& options) {
  if (options.weights) {
    WeightTrack track = read_weights(*options.weights);
    scale_weights(options.weights->string(), track, model->expressions().names,
                  options.weight_scale);
    return drive(std::move(model), path, options, *options.weights, std::move(track));
  }
  return {resting(std::move(model), options), true, {path}, {}};
}

OpenSequence drive(std::shared_ptr<const BlendshapeModel> model, const fs::path& path,
                   const ReadOptions& options, const fs::path& driver, WeightTrack track) {
  OpenSequence open;
  open.model_driven = true;
  open.files = {path, driver};
  const auto frames = static_cast<int>(track.weights.rows());
  const std::vector<int> chosen = selected_frames(options.frames, frames);
  const std::vector<std::string>& expressions = model->expressions().names;
  if (expressions.empty()) {
    throw MismatchError(driver.string() + ": drives nothing; " + path.string() +
                        ": has no expressions");
  }
  for (const std::string& note : track.notes) open.notes.push_back(driver.string() + ": " + note);
  const auto unmatched = match_notes(driver, path, match_weights(track, expressions));
  open.notes.insert(open.notes.end(), unmatched.begin(), unmatched.end());
  std::optional<Eigen::VectorXd> of_track;
  if (track.times.size() > 0) of_track = track.times;
  FrameTimes times = frame_times(driver.string(), frames, std::move(of_track), options.fps);
  if (track.times.size() == 0 && track.step != 1) {
    times.seconds *= track.step;
    times.are_known = true;
    if (!options.fps) {
      open.notes.push_back(driver.string() + ": rows are " + readable(track.step) +
                           " frames apart, of which " + readable(kDefaultFramesPerSecond) +
                           " a second are assumed; option 'fps' gives the rate");
    }
    const std::string odd = note_on_steps(times.seconds);
    if (!odd.empty()) open.notes.push_back(driver.string() + ": " + odd);
  }
  // There may be many frames, so at most one copy of the weights is kept.
  if (static_cast<int>(chosen.size()) < frames) {
    track.weights = Eigen::MatrixXd(track.weights(chosen, Eigen::all));
  }
  Eigen::MatrixXd weights = weights_of(driver, track, expressions);
  track.weights.resize(0, 0);
  open.frames = std::make_shared<const Animation>(std::move(model), std::move(weights),
                                                  times.seconds(chosen), times.are_known);
  return open;
}

}  // namespace mimetra
