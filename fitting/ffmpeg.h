#pragma once

#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/imgutils.h>
#include <libswscale/swscale.h>
}

/// Functions of FFmpeg, looked up when the first video is opened. The codecs bring a hundred
/// libraries, so other commands and the hosts of plugins do not wait for them. Internal to
/// video_codec.h.
namespace mimetra {

/// Shared library that stays loaded. Throws std::runtime_error if it or a function is missing.
class SharedLibrary {
 public:
  explicit SharedLibrary(const std::string& name);
  template <typename Function>
  Function function(const char* name) const {
    return reinterpret_cast<Function>(symbol(name));
  }

 private:
  void* symbol(const char* name) const;

  std::string name_;
  void* handle_;
};

/// Libraries of the same major versions as the headers, since the structs of others may differ.
struct Ffmpeg {
  SharedLibrary util{"libavutil.so." AV_STRINGIFY(LIBAVUTIL_VERSION_MAJOR)};
  SharedLibrary codec{"libavcodec.so." AV_STRINGIFY(LIBAVCODEC_VERSION_MAJOR)};
  SharedLibrary format{"libavformat.so." AV_STRINGIFY(LIBAVFORMAT_VERSION_MAJOR)};
  SharedLibrary scale{"libswscale.so." AV_STRINGIFY(LIBSWSCALE_VERSION_MAJOR)};

// NOLINTBEGIN(bugprone-macro-parentheses): a member's name
#define MIMETRA_OF(library, name) \
  decltype(&::name) name = library.function<decltype(&::name)>(#name)
  // NOLINTEND(bugprone-macro-parentheses)
  MIMETRA_OF(util, av_d2q);
  MIMETRA_OF(util, av_dict_free);
  MIMETRA_OF(util, av_dict_set);
  MIMETRA_OF(util, av_frame_alloc);
  MIMETRA_OF(util, av_frame_free);
  MIMETRA_OF(util, av_frame_get_buffer);
  MIMETRA_OF(util, av_frame_make_writable);
  MIMETRA_OF(util, av_log_set_level);
  MIMETRA_OF(util, av_strerror);
  MIMETRA_OF(codec, av_packet_alloc);
  MIMETRA_OF(codec, av_packet_free);
  MIMETRA_OF(codec, av_packet_rescale_ts);
  MIMETRA_OF(codec, av_packet_unref);
  MIMETRA_OF(codec, avcodec_alloc_context3);
  MIMETRA_OF(codec, avcodec_find_encoder);
  MIMETRA_OF(codec, avcodec_find_encoder_by_name);
  MIMETRA_OF(codec, avcodec_free_context);
  MIMETRA_OF(codec, avcodec_open2);
  MIMETRA_OF(codec, avcodec_parameters_copy);
  MIMETRA_OF(codec, avcodec_parameters_from_context);
  MIMETRA_OF(codec, avcodec_parameters_to_context);
  MIMETRA_OF(codec, avcodec_receive_frame);
  MIMETRA_OF(codec, avcodec_receive_packet);
  MIMETRA_OF(codec, avcodec_send_frame);
  MIMETRA_OF(codec, avcodec_send_packet);
  MIMETRA_OF(format, av_find_best_stream);
  MIMETRA_OF(format, av_guess_format);
  MIMETRA_OF(format, av_guess_sample_aspect_ratio);
  MIMETRA_OF(format, av_interleaved_write_frame);
  MIMETRA_OF(format, av_read_frame);
  MIMETRA_OF(format, av_write_trailer);
  MIMETRA_OF(format, avformat_alloc_output_context2);
  MIMETRA_OF(format, avformat_close_input);
  MIMETRA_OF(format, avformat_find_stream_info);
  MIMETRA_OF(format, avformat_free_context);
  MIMETRA_OF(format, avformat_new_stream);
  MIMETRA_OF(format, avformat_open_input);
  MIMETRA_OF(format, avformat_query_codec);
  MIMETRA_OF(format, avformat_write_header);
  MIMETRA_OF(format, avio_closep);
  MIMETRA_OF(format, avio_open);
  MIMETRA_OF(scale, sws_freeContext);
  MIMETRA_OF(scale, sws_getCoefficients);
  MIMETRA_OF(scale, sws_getContext);
  MIMETRA_OF(scale, sws_scale);
  MIMETRA_OF(scale, sws_setColorspaceDetails);
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(60, 15, 100)
  MIMETRA_OF(codec, av_packet_side_data_get);
#else
  MIMETRA_OF(format, av_stream_get_side_data);
#endif
#undef MIMETRA_OF
};

/// Loads FFmpeg at the first call. \pre load_ffmpeg() returned; it reports missing libraries.
const Ffmpeg& ffmpeg();

/// Throws `Error` for `file` if FFmpeg's libraries are not installed. Afterwards they are loaded,
/// and FFmpeg reports errors only through return values.
template <typename Error>
void load_ffmpeg(const std::filesystem::path& file) {
  try {
    ffmpeg().av_log_set_level(AV_LOG_QUIET);
  } catch (const std::runtime_error& missing) {
    throw Error(file.string(),
                std::string("videos need FFmpeg's libraries, and one is missing (") +
                    missing.what() +
                    "); install FFmpeg, in Debian with 'apt-get install ffmpeg', or use a folder "
                    "of pictures");
  }
}

struct FreedByFfmpeg {
  void operator()(AVFormatContext* context) const { ffmpeg().avformat_close_input(&context); }
  void operator()(AVCodecContext* context) const { ffmpeg().avcodec_free_context(&context); }
  void operator()(AVPacket* packet) const { ffmpeg().av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { ffmpeg().av_frame_free(&frame); }
  void operator()(SwsContext* scaler) const { ffmpeg().sws_freeContext(scaler); }
};
template <typename T>
using FfmpegOwned = std::unique_ptr<T, FreedByFfmpeg>;

template <typename T>
T* allocated(T* made) {
  if (!made) throw std::bad_alloc();
  return made;
}

}  // namespace mimetra
