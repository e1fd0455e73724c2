#include "toolkit/io/sequence_file.h"

#include "toolkit/io/fit_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/frame_sequence.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/io/sequence_parts.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// What cannot even be asked for, such as a name too long, is not there.
bool is_there(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

Eigen::Map<const Eigen::RowVectorXd> as_row(const Positions& positions) {
  return {positions.data(), positions.size()};
}

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

std::shared_ptr<const FrameSource> neutral_of(const BlendshapeModel& person,
                                              const SequenceSource& source) {
  selected_frames(source.frames, 1);
  return std::make_shared<const MeshSequence>(person.shared_connectivity(),
                                              as_row(person.neutral()), frame_times(1, source),
                                              person.neutral());
}

Eigen::MatrixXd weights_of(const fs::path& path, const WeightTrack& track,
                           const std::vector<std::string>& expressions) {
  try {
    return weights_for(track, expressions);
  } catch (const MismatchError& error) {
    throw MismatchError(path.string() + ": " + error.what());
  }
}

OpenSequence open_driven(const ModelSpec& spec, const SequenceSource& source) {
  OpenSequence open;
  open.model_driven = true;
  open.files = {spec.path};
  open.notes = spec.notes();
  auto person = std::make_shared<const BlendshapeModel>(read_person(spec, source.threads));
  if (spec.fit) open.files.push_back(*spec.fit);
  if (!source.weights && !spec.fit) {
    open.frames = neutral_of(*person, source);
    return open;
  }
  if (source.weights) open.files.push_back(*source.weights);
  const fs::path& driver = open.files.back();
  WeightTrack track = source.weights ? read_weights(driver) : read_fit(driver).performance();
  for (const std::string& note : track.notes) {
    open.notes.push_back(driver.string() + ": " + note);
  }
  const auto frames = static_cast<int>(track.weights.rows());
  const std::vector<int> chosen = selected_frames(source.frames, frames);
  const std::vector<std::string>& expressions = person->expressions().names;
  const auto unmatched = match_notes(driver, spec.path, match_weights(track, expressions));
  open.notes.insert(open.notes.end(), unmatched.begin(), unmatched.end());
  const Eigen::VectorXd times = track.times.size() > 0 ? track.times : frame_times(frames, source);
  // There may be many frames: no more than one copy of what is not needed again.
  if (static_cast<int>(chosen.size()) < frames) {
    track.weights = Eigen::MatrixXd(track.weights(chosen, Eigen::all));
  }
  Eigen::MatrixXd weights = weights_of(driver, track, expressions);
  track.weights.resize(0, 0);
  open.frames =
      std::make_shared<const Animation>(std::move(person), std::move(weights), times(chosen));
  return open;
}

/// What the name in `text` turned out to be is not a model: nothing there can be driven.
void check_undriven(const std::string& text, const SequenceSource& source) {
  if (!source.weights) return;
  throw MismatchError(text + " is no model that the weights of " + source.weights->string() +
                      " could drive; expected a folder with a neutral and expressions");
}

OpenSequence open_path(const fs::path& path, const SequenceSource& source) {
  if (fs::is_directory(path)) return open_frames(frames_of_folder(path), path, source);
  if (const SequenceFormat* format = sequence_format(path)) return format->open(path, source);
  throw IoError(path.string(), "is no sequence; expected a folder, " +
                                   joined(sequence_extensions()) + " or a model");
}

}  // namespace

OpenSequence open_sequence(const std::string& text, const SequenceSource& source) {
  check_options(source);
  const bool exists = is_there(text);
  if (exists && is_model(text)) return open_driven(ModelSpec{text, {}, {}}, source);
  if (!exists && !is_frame_pattern(text) && text.find('@') != std::string::npos) {
    const ModelSpec spec = ModelSpec::parse(text);
    if (is_there(spec.path) && !is_model(spec.path)) {
      throw IoError(spec.path.string(), "is no model, so that nothing can follow '@'");
    }
    return open_driven(spec, source);
  }
  if (!exists && !is_frame_pattern(text)) throw IoError(text, "no such file or folder");
  check_undriven(text, source);
  return exists ? open_path(text, source) : open_frames(frames_of_pattern(text), {}, source);
}

SequenceRead read_sequence(const std::string& text, const SequenceSource& source) {
  OpenSequence open = open_sequence(text, source);
  SequenceRead read{
      MeshSequence(*open.frames, {.threads = source.threads, .progress = source.progress}),
      open.model_driven, std::move(open.files), std::move(open.notes)};
  report_progress(source.progress, 1);
  return read;
}

}  // namespace mimetra
