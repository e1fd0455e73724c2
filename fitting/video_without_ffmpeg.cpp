#include "fitting/video_codec.h"
#include "toolkit/mesh/errors.h"

/// Errors of a build without FFmpeg's libraries when videos are used.
namespace mimetra {

std::unique_ptr<VideoDecoder> open_video(const std::filesystem::path& path) {
  throw IoError(path.string(),
                "videos need FFmpeg's libraries, without which mimetra was built; install the "
                "packages libavformat-dev, libavcodec-dev and libswscale-dev and build again, or "
                "make images of it: 'ffmpeg -i VIDEO images/%05d.png'");
}

std::unique_ptr<VideoEncoder> create_video(const std::filesystem::path&,
                                           const std::filesystem::path& target,
                                           const VideoLayout&) {
  throw OutputError(target.string(),
                    "videos need FFmpeg's libraries, without which mimetra was built; name a "
                    "folder, which gets a picture of each frame");
}

bool can_keep_sound(const std::filesystem::path&, const std::string&) {
  return true;
}

}  // namespace mimetra
