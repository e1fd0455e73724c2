#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fitting/face_images.h"
#include "toolkit/io/format.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/landmark_track.h"

namespace mimetra {

struct LandmarkInputOptions {
  /// Options of the search in images. Its min_confidence also applies to the frames of a track.
  FaceOptions faces = {};
  /// Images of the landmarks in a track or in .pts files, one a frame: a video, a file, a folder or
  /// a pattern. Defaults to images of the same name beside .pts files.
  std::optional<std::string> images = {};
  /// Size of the images, as "1920x1080", for landmarks in shares of width and height, as
  /// MediaPipe's. Defaults to the size of `images`.
  std::optional<std::string> image_size = {};

  static constexpr Option kImageSize{"image_size", &LandmarkInputOptions::image_size};
  static constexpr Option kImages{"images", &LandmarkInputOptions::images};
};

/// Landmarks with notes from reading them.
struct LandmarksRead {
  LandmarkTrack track;  ///< has times
  /// Images of the frames (F), or null.
  std::shared_ptr<const ImageSequence> images = {};
  /// Note on each frame (F, "" for none), or empty.
  std::vector<std::string> frame_notes = {};
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> notes = {};
};

/// Reads the landmarks of a clip: a .pts, .csv or .json file, or a folder or pattern of .pts files.
/// Images and videos are searched for faces: a video, an image, or a folder or pattern of images.
/// Each file is a frame, in natural order. The result has times, and holds the frames that
/// `reading.frames` selects.
///
/// Throws IoError as VideoFile and track_face() do, and if a selected frame comes after damage in a
/// video. Throws MismatchError as selected_frames() does, and if files differ in their number of
/// landmarks, the number of images is wrong or an option has no effect. Throws
/// std::invalid_argument for an option out of range, and Cancelled.
LandmarksRead read_landmark_input(const std::string& text, const ReadOptions& reading = {},
                                  const LandmarkInputOptions& = {}, const Context& = {});

}  // namespace mimetra
