#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "tests/transfer/faces.h"
#include "toolkit/pipeline/transfer.h"

/// Performances of a small model.
namespace mimetra::test {

/// A performance of a patch with `expressions` bumps; its neutral is known and is not a frame.
inline MeshSequence take(int frames = 8, int expressions = 5) {
  return model_on(patch(), expressions).animate(random_weights(frames, expressions));
}

/// With a vertex more that no triangle has, which jumps about.
inline MeshSequence with_loose_vertex(const MeshSequence& sequence) {
  Connectivity connectivity = sequence.connectivity();
  ++connectivity.vertices;
  Positions rest(connectivity.vertices, 3);
  rest << sequence.rest(), Eigen::RowVector3d(0, 0, 50);
  Frames frames(sequence.frames(), rest.size());
  for (int f = 0; f < sequence.frames(); ++f) {
    frames.row(f) << sequence.positions().row(f), 30 * f, -20, 50 + f * f;
  }
  return {std::move(connectivity), std::move(frames), {}, std::move(rest)};
}

/// The same frames, of which nobody knows the neutral.
inline MeshSequence bare(const MeshSequence& sequence) {
  return {sequence.shared_connectivity(), sequence.positions(), sequence.times()};
}

/// All frames (F x 3N).
inline Frames frames_of(const std::shared_ptr<const FrameSource>& source) {
  return source->read(0, source->frames());
}

/// A turn and a shift of the head, larger from frame to frame.
inline std::vector<RigidTransform> nodding(int frames) {
  std::vector<RigidTransform> motion(frames);
  for (int f = 0; f < frames; ++f) {
    const Eigen::AngleAxisd turn(0.1 * f, Eigen::Vector3d(1, 2, 0).normalized());
    motion[f] = {turn.toRotationMatrix(), Eigen::Vector3d(0.5 * f, -f, 0.2)};
  }
  return motion;
}

/// Keeps the notes of a computation.
struct Noted {
  std::vector<Note> notes;

  Context context() {
    return Context().with_notes([this](const Note& note) { notes.push_back(note); });
  }
  bool has(Topic topic) const {
    return std::ranges::find(notes, topic, &Note::topic) != notes.end();
  }
};

/// What an OptionError that `work` throws is about.
template <typename Work>
Topic topic_of(const Work& work) {
  try {
    work();
  } catch (const OptionError& error) {
    return error.topic();
  }
  ADD_FAILURE() << "no OptionError was thrown";
  return Topic::other;
}

}  // namespace mimetra::test
