#include "fitting/face_images.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "fitting/followed_face.h"
#include "fitting/image_codec.h"
#include "fitting/landmark_formats.h"
#include "fitting/recording_search.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

constexpr Eigen::Index kLandmarks = 68;
constexpr const char* kTerms =
    "the 68-point model was trained on photographs for non-commercial use only (iBUG 300-W)";

FaceBox box_of(const Face& face) {
  const Eigen::Array2d size(face.width, face.height);
  return {Eigen::Array2d(face.left, face.top) + size / 2, size};
}

FaceFrame frame_of(const FacesInImage& image, const std::vector<Face>& confident,
                   const Face* chosen, double min_confidence) {
  FaceFrame frame;
  frame.image = image.image;
  frame.faces = static_cast<int>(confident.size());
  if (chosen) {
    frame.outcome = FaceFrame::Outcome::found;
    frame.confidence = chosen->confidence;
    if (frame.faces > 1) frame.note = "one of " + std::to_string(frame.faces) + " faces";
  } else if (image.faces.empty()) {
    frame.note = "no face found";
  } else {
    frame.confidence = std::ranges::max_element(image.faces, {}, &Face::confidence)->confidence;
    const bool trusted = frame.faces > 0;
    frame.outcome = trusted ? FaceFrame::Outcome::other_face : FaceFrame::Outcome::low_confidence;
    frame.note = trusted ? "only faces of others than the one that is followed"
                         : low_confidence_note(frame.confidence, min_confidence);
  }
  return frame;
}

/// "3 of 120 images WHAT, the first is NAME", or nothing where none is counted.
template <typename Counted>
void add_note(std::vector<std::string>& notes, const std::vector<FaceFrame>& frames,
              const std::string& what, Counted is_counted) {
  const auto first = std::ranges::find_if(frames, is_counted);
  if (first == frames.end()) return;
  notes.push_back(std::to_string(std::ranges::count_if(frames, is_counted)) + " of " +
                  std::to_string(frames.size()) + " images " + what + ", the first is " +
                  fs::path(first->image).filename().string());
}

std::vector<std::string> notes_on(const std::vector<FaceFrame>& frames) {
  using Outcome = FaceFrame::Outcome;
  std::vector<std::string> notes;
  add_note(notes, frames, "show no face that was found",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::no_face; });
  add_note(notes, frames, "show only faces of too low confidence",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::low_confidence; });
  add_note(notes, frames,
           "show several faces (the largest of the first frame with a face is followed)",
           [](const FaceFrame& frame) { return frame.faces > 1; });
  add_note(notes, frames, "show only faces of others than the one that is followed",
           [](const FaceFrame& frame) { return frame.outcome == Outcome::other_face; });
  add_note(notes, frames,
           "show the face that is followed elsewhere than before (is it the same person's?)",
           [](const FaceFrame& frame) { return frame.jumps; });
  return notes;
}

std::vector<FacesInImage> faces_of_images(const ImageSequence& images, const FaceFinder& finder,
                                          const Context& context) {
  std::vector<FacesInImage> frames(static_cast<std::size_t>(images.frames()));
  const auto look_at = [&](int i) {
    frames[static_cast<std::size_t>(i)] = {images.name(i), finder.faces(images.image(i))};
  };
  parallel_for(images.frames(), look_at, context);
  return frames;
}

/// Throws IoError where no frame shows a face.
void check_some_face(const FaceTrack& track) {
  const auto is_found = [](const FaceFrame& frame) {
    return frame.outcome == FaceFrame::Outcome::found;
  };
  if (std::ranges::any_of(track.frames, is_found)) return;
  const std::size_t others = track.frames.size() - 1;
  throw IoError(
      track.frames.front().image,
      "shows no face that the detector is sure of" +
          (others == 0 ? std::string() : ", nor does any of the other " + std::to_string(others)) +
          "; a face must look towards the camera and be at least 80 pixels wide");
}

}  // namespace

FaceTrack follow_face(const std::vector<FacesInImage>& frames, double min_confidence) {
  check_options(FaceOptions{.min_confidence = min_confidence});
  const auto count = static_cast<Eigen::Index>(frames.size());
  FaceTrack track;
  track.landmarks.names = numbered_names(kLandmarks);
  track.landmarks.points.setConstant(count, 2 * kLandmarks,
                                     std::numeric_limits<double>::quiet_NaN());
  track.landmarks.confidence.setZero(count);
  std::vector<std::vector<Face>> confident;
  std::vector<std::vector<FaceBox>> boxes;
  for (const FacesInImage& image : frames) {
    auto& faces = confident.emplace_back();
    std::ranges::copy_if(image.faces, std::back_inserter(faces),
                         [&](const Face& face) { return face.confidence >= min_confidence; });
    std::ranges::transform(faces, std::back_inserter(boxes.emplace_back()), box_of);
  }
  const FollowedFace followed = followed_face(boxes);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const int index = followed.chosen[f];
    const Face* chosen = index < 0 ? nullptr : &confident[f][static_cast<std::size_t>(index)];
    track.frames.push_back(frame_of(frames[f], confident[f], chosen, min_confidence));
    if (!chosen) continue;
    const auto row = static_cast<Eigen::Index>(f);
    track.landmarks.points.row(row) = chosen->landmarks.reshaped<Eigen::RowMajor>().transpose();
    track.landmarks.confidence[row] = chosen->confidence;
  }
  for (const int jump : followed.jumps) {
    FaceFrame& frame = track.frames[static_cast<std::size_t>(jump)];
    frame.jumps = true;
    if (frame.note.empty()) frame.note = "the face is elsewhere than before";
  }
  track.notes = notes_on(track.frames);
  return track;
}

std::string low_confidence_note(double confidence, double min_confidence) {
  std::ostringstream text;
  text.precision(2);
  text << "confidence " << confidence << " is below " << min_confidence;
  return text.str();
}

FaceTrack track_face(const ImageSequence& images, const FaceOptions& options,
                     const Context& context) {
  check_options(options);
  if (images.frames() == 0) throw std::invalid_argument("there are no images");
  require_dlib(images.name(0));
  const fs::path model = options.model.value_or(kDebianFaceModel);
  const FaceFinder finder(model);
  const std::vector<FacesInImage> found =
      images.is_recording() ? faces_of_recording(images, finder, options.min_confidence, context)
                            : faces_of_images(images, finder, context);
  FaceTrack track = follow_face(found, options.min_confidence);
  check_some_face(track);
  if (model == kDebianFaceModel) track.notes.insert(track.notes.begin(), kTerms);
  return track;
}

}  // namespace mimetra
