#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fitting/face_finder.h"
#include "fitting/image_files.h"
#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/landmark_track.h"
#include "toolkit/operations/image.h"

namespace mimetra {

/// What became of one frame.
struct FaceFrame {
  enum class Outcome { found, no_face, low_confidence, other_face };

  std::string image;  ///< its name
  Outcome outcome = Outcome::no_face;
  int faces = 0;          ///< those of enough confidence, among which one was chosen
  double confidence = 0;  ///< of the chosen face; else of the best that was found; 0 where none was
  /// Another face, elsewhere than in the frames before, is taken for that of the person.
  bool jumps = false;
  std::string note;  ///< what is not as it should be, or nothing
};

/// The landmarks of one person over a sequence of images.
struct FaceTrack {
  /// Frames without a face are NaN and have confidence 0. No times.
  LandmarkTrack landmarks;
  std::vector<FaceFrame> frames;
  /// What a user should know: the model's terms, and how many frames lack a face or show several.
  std::vector<std::string> notes;
};

/// Chooses the face of one person in each frame, as followed_face(), among those of enough
/// confidence. Throws std::invalid_argument where min_confidence is out of its range.
FaceTrack follow_face(const std::vector<FacesInImage>& frames,
                      double min_confidence = FaceOptions{}.min_confidence);

/// What is said of a frame that is not trusted: "confidence 0.05 is below 0.1".
std::string low_confidence_note(double confidence, double min_confidence);

/// Finds the faces of all images, and follows one. In a recording a face is looked for near the
/// place of the frame before; in the whole frame where one is lost, and in every 30th. Throws as
/// FaceFinder, ImageSequence::image and follow_face; IoError where no image shows a face;
/// Cancelled.
FaceTrack track_face(const ImageSequence& images, const FaceOptions& = {}, const Context& = {});

/// FaceFinder as finder of landmarks in drawings of meshes: the most certain face of each. Its
/// model is read when it is used first; that throws as FaceFinder does.
LandmarkFinder landmarks_of_drawings(const std::filesystem::path& model = kDebianFaceModel);

}  // namespace mimetra
