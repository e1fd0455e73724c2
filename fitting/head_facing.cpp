#include "fitting/head_facing.h"

#include <algorithm>

#include "fitting/fit_verdict.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

std::vector<AffineCamera> cameras_at_origin(const FittedCoefficients& fit) {
  std::vector<AffineCamera> cameras = fit.cameras;
  for (Eigen::Index f = 0; f < fit.depths.rows(); ++f) {
    AffineCamera& camera = cameras[static_cast<std::size_t>(f)];
    camera.leftCols<3>() -= camera.col(3) * fit.depths.row(f).head<3>();
  }
  return cameras;
}

AvertedLandmarks::AvertedLandmarks(const MeshSequence& sequence, const FittedCoefficients& fit,
                                   const std::vector<int>& vertices,
                                   const std::vector<AffineCamera>& cameras)
    : of_frames_(cameras.size(), -1), landmarks_(static_cast<int>(vertices.size())) {
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) continue;
    const auto frame = static_cast<std::size_t>(f);
    of_frames_[frame] =
        averted_landmarks(sequence.frame(f), sequence.triangles(), vertices, cameras[frame]);
  }
}

void AvertedLandmarks::require_facing(const std::string& name) const {
  const auto seen = std::ranges::count_if(of_frames_, [](int averted) { return averted >= 0; });
  const auto away =
      std::ranges::count_if(of_frames_, [&](int averted) { return 2 * averted > landmarks_; });
  if (2 * away <= seen) return;
  throw MismatchError(
      name + ": the face that fits looks away from the camera in " + std::to_string(away) + " of " +
      std::to_string(seen) +
      " frames, so the landmarks are mirrored; expected pixels from the upper left "
      "corner, x to the right and y down: where y points up take the image's height "
      "minus y, where the image was mirrored its width minus x");
}

std::vector<std::string> AvertedLandmarks::notes(const Invocation& invocation) const {
  const NamedData& landmarks = invocation.input("landmarks");
  std::vector<std::string> notes = landmarks.origin.frame_notes;
  std::vector<int> turned;
  notes.resize(of_frames_.size());
  for (std::size_t f = 0; f < of_frames_.size(); ++f) {
    if (4 * of_frames_[f] < landmarks_) continue;
    turned.push_back(static_cast<int>(f));
    std::string& note = notes[f];
    note += (note.empty() ? "" : "; ") + std::string("turned away: ") +
            std::to_string(of_frames_[f]) + " of " + std::to_string(landmarks_) +
            " landmarks are behind the face";
  }
  if (!turned.empty()) {
    invocation.warn(landmarks.name +
                    ": frames in which the head is turned so far that the hidden half of the face "
                    "is guessed: " +
                    listed(words_of(turned)));
  }
  const bool none =
      std::ranges::all_of(notes, [](const std::string& note) { return note.empty(); });
  return none ? std::vector<std::string>{} : notes;
}

}  // namespace mimetra
