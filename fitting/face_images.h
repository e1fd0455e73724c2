#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fitting/face_finder.h"
#include "fitting/image_files.h"
#include "toolkit/correspondence/landmark_finder.h"
#include "toolkit/io/image.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/landmark_track.h"

namespace mimetra {

/// Result of the face search in one frame.
struct FaceFrame {
  enum class Outcome { found, no_face, low_confidence, other_face };

  std::string image;  ///< name of the image
  Outcome outcome = Outcome::no_face;
  int faces = 0;          ///< faces of enough confidence
  double confidence = 0;  ///< confidence of the chosen face, else of the best face; 0 without faces
  /// True if a face at another place than in previous frames was chosen as the person's.
  bool jumps = false;
  std::string note;  ///< problem with this frame; empty if none
};

/// Landmarks of one person over a sequence of images.
struct FaceTrack {
  /// NaN and confidence 0 in frames without a face. Has no times.
  LandmarkTrack landmarks;
  std::vector<FaceFrame> frames;
  /// Notes for the user: terms of the model, number of frames without a face or with several.
  std::vector<std::string> notes;
};

/// Chooses one person's face in each frame, as followed_face(), among faces of enough confidence.
/// Throws std::invalid_argument if min_confidence is out of range.
FaceTrack follow_face(const std::vector<FacesInImage>& frames,
                      double min_confidence = FaceOptions{}.min_confidence);

/// Note on a frame that is not trusted: "confidence 0.05 is below 0.1".
std::string low_confidence_note(double confidence, double min_confidence);

/// Finds the faces of all images and follows one person. In a recording the search covers the
/// surroundings of the previous frame's faces. It covers the whole frame in every 30th frame and
/// whenever a face is lost. Throws as FaceFinder, ImageSequence::image and follow_face(); IoError
/// if no image shows a face; Cancelled.
FaceTrack track_face(const ImageSequence& images, const FaceOptions& = {}, const Context& = {});

/// Returns a finder of landmarks in drawings of meshes, which takes FaceFinder's most certain face.
/// The first call reads the model and throws as FaceFinder does.
LandmarkFinder landmarks_of_drawings(const std::filesystem::path& model = kDebianFaceModel);

}  // namespace mimetra
