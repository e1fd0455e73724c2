#include "toolkit/io/sequence_parts.h"

#include "toolkit/io/csv.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/scene.h"
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
             {.double_precision = true, .extension = ".ply"});
  files.push_back(target);
}

}  // namespace

FrameTimes frame_times(const std::string& name, int frames, std::optional<Eigen::VectorXd> known,
                       const SequenceSource& source) {
  if (!known) {
    const double fps = source.fps.value_or(kDefaultFramesPerSecond);
    return {Eigen::VectorXd::LinSpaced(frames, 0, frames - 1) / fps, source.fps.has_value()};
  }
  check_rate(name, *known, source);
  return {*std::move(known), true};
}

fs::path other_of_name(const fs::path& sequence) {
  const fs::path name = beside(sequence, ""), own = sequence.lexically_normal();
  std::vector<fs::path> others;
  if (is_there(name / kFolderManifest) && own != name && own != name / "") others.push_back(name);
  for (const SequenceFormat& format : sequence_formats()) {
    if (!format.has_companions) continue;
    for (const std::string& extension : format.extensions) {
      const fs::path other = name.string() + extension;
      if (other != own && is_there(other)) others.push_back(other);
    }
  }
  return others.empty() ? fs::path() : others.front();
}

fs::path topology_of(const fs::path& path, const SequenceSource& source) {
  if (source.topology) return *source.topology;
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
                                           const SequenceSource& source) {
  selected_frames(source.frames, 1);
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
                   const SequenceSource& source) {
  if (source.weights) {
    WeightTrack track = read_weights(*source.weights);
    scale_weights(source.weights->string(), track, model->expressions().names, source.weight_scale);
    return drive(std::move(model), path, source, *source.weights, std::move(track));
  }
  return {resting(std::move(model), source), true, {path}, {}};
}

OpenSequence drive(std::shared_ptr<const BlendshapeModel> model, const fs::path& path,
                   const SequenceSource& source, const fs::path& driver, WeightTrack track) {
  OpenSequence open;
  open.model_driven = true;
  open.files = {path, driver};
  const auto frames = static_cast<int>(track.weights.rows());
  const std::vector<int> chosen = selected_frames(source.frames, frames);
  const std::vector<std::string>& expressions = model->expressions().names;
  if (expressions.empty()) {
    const std::vector<std::string> unread = notes_on_unread(path);
    throw MismatchError(driver.string() + ": drives nothing; " +
                        (unread.empty() ? path.string() + ": has no expressions" : unread[0]));
  }
  for (const std::string& note : track.notes) open.notes.push_back(driver.string() + ": " + note);
  const auto unmatched = match_notes(driver, path, match_weights(track, expressions));
  open.notes.insert(open.notes.end(), unmatched.begin(), unmatched.end());
  std::optional<Eigen::VectorXd> of_track;
  if (track.times.size() > 0) of_track = track.times;
  FrameTimes times = frame_times(driver.string(), frames, std::move(of_track), source);
  if (track.times.size() == 0 && track.step != 1) {
    times.seconds *= track.step;
    times.are_known = true;
    if (!source.fps) {
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

OpenSequence open_scene(const fs::path& path, const SequenceSource& source,
                        const Context& context) {
  Scene scene = read_gltf(path, context);
  const auto frames = static_cast<int>(scene.weights.rows());
  OpenSequence open;
  if (source.weights || frames == 0) {
    open = drive(scene.model, path, source);
  } else {
    const std::vector<int> chosen = selected_frames(source.frames, frames);
    std::optional<Eigen::VectorXd> of_scene;
    if (scene.times.size() > 0) of_scene = scene.times;
    const FrameTimes times = frame_times(path.string(), frames, std::move(of_scene), source);
    open.model_driven = true;
    open.frames = std::make_shared<const Animation>(
        scene.performer, Eigen::MatrixXd(scene.weights(chosen, Eigen::all)), times.seconds(chosen),
        times.are_known);
  }
  if (!scene.rest_is_known && !source.weights) {
    open.frames = with_rest(open.frames, std::nullopt);
    open.model_driven = false;
  }
  open.files = scene.files;
  if (source.weights) open.files.push_back(*source.weights);
  std::vector<std::string>& notes = scene.notes;
  const auto& of_use = source.weights ? scene.model_notes : scene.motion_notes;
  notes.insert(notes.end(), of_use.begin(), of_use.end());
  open.notes.insert(open.notes.begin(), notes.begin(), notes.end());
  return open;
}

}  // namespace mimetra
