#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fitting/face_images.h"
#include "toolkit/io/sequence_format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/landmark_track.h"

namespace mimetra {

struct LandmarkInputOptions {
  /// For images. Frames of less confidence are taken as not seen, also those of a track.
  FaceOptions faces = {};
  /// The images that the landmarks of a track or of .pts files belong to, one for each frame: a
  /// video, or a file, folder or pattern. By default those of the same name beside .pts files, or
  /// none.
  std::optional<std::string> images = {};
  /// "1920x1080": of landmarks in shares of width and height, as MediaPipe's are. By default that
  /// of the images, where there are any.
  std::optional<std::string> image_size = {};

  static constexpr Option kImageSize{"image_size", &LandmarkInputOptions::image_size};
  static constexpr Option kImages{"images", &LandmarkInputOptions::images};
};

/// Landmarks, and what was noticed while reading them.
struct LandmarksRead {
  LandmarkTrack track;  ///< with times
  /// What the frames show (F images), or null.
  std::shared_ptr<const ImageSequence> images = {};
  /// What was noticed in each frame (F, "" for nothing), or none.
  std::vector<std::string> frame_notes = {};
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// Reads the landmarks of a clip: one .pts, .csv or .json file, a folder or pattern of .pts files,
/// or a video, an image, a folder or pattern of images in which faces are found; one frame a file
/// in natural order. With times, the frames that `source.frames` takes. Throws IoError, also as
/// VideoFile and track_face, and where a frame that is taken comes after a video's damage;
/// MismatchError for files that differ in their number of landmarks, another number of images, an
/// option that changes nothing, and as selected_frames; std::invalid_argument for options out of
/// range; Cancelled.
LandmarksRead read_landmark_input(const std::string& text, const SequenceSource& source = {},
                                  const LandmarkInputOptions& = {}, const Context& = {});

}  // namespace mimetra
