#include "toolkit/io/sequence_file.h"

#include <stdexcept>

#include "toolkit/io/array_file.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/model_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;
namespace {

/// Frames keep the time they have in the whole sequence, whichever part is taken.
Eigen::VectorXd times_of(const std::vector<int>& frames, const SequenceSource& source) {
  const double fps = source.fps.value_or(kDefaultFramesPerSecond);
  if (!(fps > 0)) {
    throw std::invalid_argument("fps is " + std::to_string(fps) + ", expected more than 0");
  }
  Eigen::VectorXd times(static_cast<Eigen::Index>(frames.size()));
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    times[i] = frames[static_cast<std::size_t>(i)] / fps;
  }
  return times;
}

/// What cannot even be asked for, such as a name too long, is not there.
bool is_there(const fs::path& path) {
  std::error_code unreadable;
  return fs::exists(path, unreadable);
}

Eigen::Map<const Eigen::RowVectorXd> as_row(const Positions& positions) {
  return {positions.data(), positions.size()};
}

std::optional<Positions> rest_beside(const fs::path& sequence, const MeshFileReader& reader,
                                     SequenceRead& read) {
  const fs::path rest = beside(sequence, kRestSuffix);
  if (!is_there(rest)) return std::nullopt;
  read.files.push_back(rest);
  return reader.read(rest);
}

bool is_stl(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension.size() == 4 && (extension[1] == 's' || extension[1] == 'S');
}

/// The positions of all files, one row each.
Frames read_poses(const MeshFileReader& reader, const std::vector<fs::path>& files,
                  const SequenceSource& source) {
  const Positions& first = reader.mesh().positions;
  Frames frames(static_cast<Eigen::Index>(files.size()), first.size());
  const auto read_pose = [&](int frame) {
    const fs::path& file = files[static_cast<std::size_t>(frame)];
    if (file == reader.first()) {
      frames.row(frame) = as_row(first);
    } else {
      reader.read(file, {frames.row(frame).data(), static_cast<std::size_t>(frames.cols())});
    }
  };
  parallel_for(static_cast<int>(files.size()), source.threads, read_pose, source.progress);
  report_progress(source.progress, 1);
  return frames;
}

/// `folder` is where a rest pose may lie beside; empty for patterns and single files.
SequenceRead read_frames(const std::vector<fs::path>& files, const fs::path& folder,
                         const SequenceSource& source) {
  const std::vector<int> selected = selected_frames(source.frames, static_cast<int>(files.size()));
  SequenceRead read;
  for (const int frame : selected) {
    read.files.push_back(files[static_cast<std::size_t>(frame)]);
  }
  const Eigen::VectorXd times = times_of(selected, source);
  // Which corners of an STL file are one vertex is what its first frame says, asked for or not.
  const fs::path first = is_stl(files[0]) ? files[0] : read.files[0];
  const MeshFileReader reader(first);
  Frames frames = read_poses(reader, read.files, source);
  std::optional<Positions> rest;
  if (!folder.empty()) rest = rest_beside(folder, reader, read);
  read.sequence =
      MeshSequence(reader.mesh().connectivity, std::move(frames), times, std::move(rest));
  return read;
}

fs::path topology_of(const fs::path& array, const SequenceSource& source) {
  if (source.topology) return *source.topology;
  const fs::path topology = beside(array, kTopologySuffix);
  if (!is_there(topology)) {
    throw IoError(array.string(), "says nothing of faces and there is no " + topology.string() +
                                      "; name a mesh file with --topology");
  }
  return topology;
}

SequenceRead read_array(const fs::path& path, const SequenceSource& source) {
  Frames all = read_npy_frames(path, source.threads);
  const std::vector<int> selected = selected_frames(source.frames, static_cast<int>(all.rows()));
  const fs::path topology = topology_of(path, source);
  const MeshFileReader reader(topology);
  const TriMesh& mesh = reader.mesh();
  if (all.cols() != mesh.positions.size()) {
    throw MismatchError(path.string() + ": " + std::to_string(all.cols() / 3) +
                        " vertices, expected " + std::to_string(mesh.positions.rows()) + " as in " +
                        topology.string());
  }
  SequenceRead read;
  read.files = {path, topology};
  std::optional<Positions> rest = rest_beside(path, reader, read);
  Frames frames = source.frames ? Frames(all(selected, Eigen::all)) : std::move(all);
  read.sequence = MeshSequence(mesh.connectivity, std::move(frames), times_of(selected, source),
                               std::move(rest));
  report_progress(source.progress, 1);
  return read;
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

MeshSequence neutral_of(const BlendshapeModel& person, const SequenceSource& source) {
  const std::vector<int> selected = selected_frames(source.frames, 1);
  return MeshSequence(person.shared_connectivity(), as_row(person.neutral()),
                      times_of(selected, source), person.neutral());
}

Eigen::MatrixXd weights_of(const fs::path& path, const WeightTrack& track,
                           const std::vector<std::string>& expressions) {
  try {
    return weights_for(track, expressions);
  } catch (const MismatchError& error) {
    throw MismatchError(path.string() + ": " + error.what());
  }
}

SequenceRead read_driven(const ModelSpec& spec, const SequenceSource& source) {
  SequenceRead read;
  read.model_driven = true;
  read.files = {spec.path};
  const BlendshapeModel person = read_person(spec, source.threads);
  if (spec.fit) read.files.push_back(*spec.fit);
  if (!source.weights && !spec.fit) {
    read.sequence = neutral_of(person, source);
    return read;
  }
  if (source.weights) read.files.push_back(*source.weights);
  const fs::path& driver = read.files.back();
  const WeightTrack track = source.weights ? read_weights(driver) : read_fit(driver).performance();
  const std::vector<int> selected =
      selected_frames(source.frames, static_cast<int>(track.weights.rows()));
  const std::vector<std::string>& expressions = person.expressions().names;
  read.notes = match_notes(driver, spec.path, match_weights(track, expressions));
  const Eigen::MatrixXd weights = weights_of(driver, track, expressions)(selected, Eigen::all);
  const bool timed = track.times.size() > 0;
  read.sequence = person.animate(
      weights, timed ? Eigen::VectorXd(track.times(selected)) : times_of(selected, source));
  report_progress(source.progress, 1);
  return read;
}

/// What the name in `text` turned out to be is not a model: nothing there can be driven.
void check_undriven(const std::string& text, const SequenceSource& source) {
  if (!source.weights) return;
  throw MismatchError(text + " is no model that the weights of " + source.weights->string() +
                      " could drive; expected a folder with a neutral and expressions");
}

SequenceRead read_path(const fs::path& path, const SequenceSource& source) {
  if (fs::is_directory(path)) return read_frames(frames_of_folder(path), path, source);
  const std::string extension = path.extension().string();
  if (is_array(path)) return read_array(path, source);
  if (is_mesh_extension(extension)) return read_frames({path}, {}, source);
  throw IoError(path.string(),
                "is no sequence; expected a folder, .obj, .ply, .off, .stl, .npy or a model");
}

}  // namespace

SequenceRead read_sequence(const std::string& text, const SequenceSource& source) {
  const bool exists = is_there(text);
  if (exists && is_model(text)) return read_driven(ModelSpec{text, {}, {}}, source);
  if (!exists && !is_frame_pattern(text) && text.find('@') != std::string::npos) {
    const ModelSpec spec = ModelSpec::parse(text);
    if (is_there(spec.path) && !is_model(spec.path)) {
      throw IoError(spec.path.string(), "is no model, so that nothing can follow '@'");
    }
    return read_driven(spec, source);
  }
  if (!exists && !is_frame_pattern(text)) throw IoError(text, "no such file or folder");
  check_undriven(text, source);
  return exists ? read_path(text, source) : read_frames(frames_of_pattern(text), {}, source);
}

}  // namespace mimetra
