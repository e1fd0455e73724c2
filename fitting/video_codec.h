#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "toolkit/operations/image.h"

/// Video files to pixels and back, where FFmpeg's libraries are there. Internal to video_file.h.
namespace mimetra {

/// The frames of a video, one after the other, as a player shows them.
class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;
  /// Goes to the next frame and returns its time in seconds; none after the last one. Throws
  /// IoError where it is damaged, or the video ends before it should.
  virtual std::optional<double> next() = 0;
  /// The frame's picture, turned as it is meant, with square pixels. \pre next() came to one
  virtual Image image() = 0;
};

/// Throws IoError for what is no video that can be read, and where FFmpeg's libraries are missing.
std::unique_ptr<VideoDecoder> open_video(const std::filesystem::path& path);

class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;
  /// Throws std::invalid_argument for an image of another size; OutputError.
  virtual void add(const Image& image, double time) = 0;
  /// Makes the file whole. Throws OutputError.
  virtual void finish() = 0;
};

/// What a new video is like.
struct VideoLayout {
  std::string extension;  ///< ".mp4": chooses the container
  int width = 0;
  int height = 0;
  double fps = 0;  ///< about, for the encoder's plans
  double first_time = 0;
  double end_time = 0;               ///< where the last frame's picture ends
  std::filesystem::path sound = {};  ///< a video whose sound goes along from first to end, or none
};

/// Writes to `path`, whatever its name. Throws OutputError that names `target`, also where
/// FFmpeg's libraries are missing.
std::unique_ptr<VideoEncoder> create_video(const std::filesystem::path& path,
                                           const std::filesystem::path& target,
                                           const VideoLayout& layout);

/// False where create_video() would leave the sound of `video` out of a file with this extension.
/// Throws IoError.
bool can_keep_sound(const std::filesystem::path& video, const std::string& extension);

}  // namespace mimetra
