#include "fitting/ffmpeg.h"

#include <dlfcn.h>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace fs = std::filesystem;

SharedLibrary::SharedLibrary(const std::string& name)
    : name_(name), handle_(dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (!handle_) throw std::runtime_error(dlerror());
}

void* SharedLibrary::symbol(const char* name) const {
  void* const found = dlsym(handle_, name);
  if (!found) throw std::runtime_error(name_ + " has no function " + name);
  return found;
}

const Ffmpeg& ffmpeg() {
  static const Ffmpeg loaded;
  return loaded;
}

std::string ffmpeg_error(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  ffmpeg().av_strerror(error, text, sizeof text);
  return text;
}

double seconds(std::int64_t time, AVRational base) {
  return double(time) * base.num / base.den;
}

std::string file_url(const fs::path& path) {
  return "file:" + path.string();
}

FfmpegOwned<AVFormatContext> open_container(const fs::path& path) {
  // Containers of videos. Lists of other files, which FFmpeg would open, are none.
  constexpr const char* kContainers =
      "mov,mp4,m4a,3gp,3g2,mj2,matroska,webm,avi,mpeg,mpegts,asf,ogg,wav";
  load_ffmpeg<IoError>(path);
  AVDictionary* options = nullptr;
  ffmpeg().av_dict_set(&options, "protocol_whitelist", "file", 0);
  ffmpeg().av_dict_set(&options, "format_whitelist", kContainers, 0);
  AVFormatContext* opened = nullptr;
  const int error =
      ffmpeg().avformat_open_input(&opened, file_url(path).c_str(), nullptr, &options);
  ffmpeg().av_dict_free(&options);
  if (error < 0) {
    throw IoError(path.string(), "is no video that can be read, or was cut off (" +
                                     ffmpeg_error(error) + "); copy or export it again");
  }
  FfmpegOwned<AVFormatContext> format(opened);
  if (ffmpeg().avformat_find_stream_info(opened, nullptr) < 0) {
    throw IoError(path.string(), "is a video that says nothing of its streams; export it again");
  }
  return format;
}

}  // namespace mimetra
