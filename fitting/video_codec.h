#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "toolkit/io/image.h"

/// Decoding and encoding of videos, with FFmpeg's libraries if available. Internal to video_file.h.
namespace mimetra {

/// Frames of a video in order, as a player shows them.
class VideoDecoder {
 public:
  virtual ~VideoDecoder() = default;
  /// Advances to the next frame and returns its time in seconds; empty after the last frame. Throws
  /// IoError if the frame is damaged or the video breaks off.
  virtual std::optional<double> next() = 0;
  /// Picture of the current frame, upright and with square pixels. \pre next() returned a time
  virtual Image image() = 0;
};

/// Opens a video. Throws IoError if it is not a readable video or FFmpeg's libraries are missing.
std::unique_ptr<VideoDecoder> open_video(const std::filesystem::path& path);

class VideoEncoder {
 public:
  virtual ~VideoEncoder() = default;
  /// Throws std::invalid_argument if the image has another size, and OutputError.
  virtual void add(const Image& image, double time) = 0;
  /// Completes the file. Throws OutputError.
  virtual void finish() = 0;
};

/// Properties of a new video.
struct VideoLayout {
  std::string extension;  ///< selects the container, as ".mp4"
  int width = 0;
  int height = 0;
  double fps = 0;  ///< approximate rate, for the encoder
  double first_time = 0;
  double end_time = 0;               ///< end of the last frame
  std::filesystem::path sound = {};  ///< video whose sound is copied, or empty
};

/// Creates a video in `path`, whatever its name. Throws OutputError that names `target`, also if
/// FFmpeg's libraries are missing.
std::unique_ptr<VideoEncoder> create_video(const std::filesystem::path& path,
                                           const std::filesystem::path& target,
                                           const VideoLayout& layout);

/// Returns false if create_video() would drop the sound of `video` in a file with this extension.
/// Throws IoError.
bool can_keep_sound(const std::filesystem::path& video, const std::string& extension);

}  // namespace mimetra
