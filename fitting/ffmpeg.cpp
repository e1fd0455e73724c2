#include "fitting/ffmpeg.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include <dlfcn.h>

#include "fitting/orientation.h"
#include "fitting/video_codec.h"
#include "toolkit/io/image_decoder.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

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

namespace {

namespace fs = std::filesystem;

/// Neutral contrast and saturation.
constexpr int kUnchanged = 1 << 16;

/// Message for an error code.
std::string ffmpeg_error(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  ffmpeg().av_strerror(error, text, sizeof text);
  return text;
}

double seconds(std::int64_t time, AVRational base) {
  return double(time) * base.num / base.den;
}

/// Seconds from the start of the file's contents.
double seconds_from_start(const AVFormatContext& format, std::int64_t time, AVRational base) {
  const std::int64_t start = format.start_time == AV_NOPTS_VALUE ? 0 : format.start_time;
  return seconds(time, base) - seconds(start, {1, AV_TIME_BASE});
}

/// URL that makes FFmpeg treat any name as a file.
std::string file_url(const fs::path& path) {
  return "file:" + path.string();
}

/// Opens a container and reads no other file. Throws IoError.
FfmpegOwned<AVFormatContext> open_container(const fs::path& path) {
  // Containers of videos. Playlists, which would make FFmpeg open other files, are not included.
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

/// Orientation that a player applies to the pictures of a stream.
Orientation orientation_of(const AVStream& stream) {
#if LIBAVFORMAT_VERSION_INT >= AV_VERSION_INT(60, 15, 100)
  const AVPacketSideData* data = ffmpeg().av_packet_side_data_get(
      stream.codecpar->coded_side_data, stream.codecpar->nb_coded_side_data,
      AV_PKT_DATA_DISPLAYMATRIX);
  const std::uint8_t* bytes = data ? data->data : nullptr;
#else
  const std::uint8_t* bytes =
      ffmpeg().av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
#endif
  if (!bytes) return {};
  std::int32_t matrix[9];
  std::memcpy(matrix, bytes, sizeof matrix);
  // The matrix maps columns to columns, or columns to rows. Cameras do not rotate by other angles.
  const std::int64_t a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
  const bool transposed = std::abs(b) + std::abs(c) > std::abs(a) + std::abs(d);
  return {transposed, (transposed ? c : a) < 0, (transposed ? b : d) < 0};
}

/// Colour matrix of the picture, or the usual one for its height if the file does not give one.
int colors_of(const AVFrame& frame) {
  if (frame.colorspace != AVCOL_SPC_UNSPECIFIED && frame.colorspace != AVCOL_SPC_RGB) {
    return frame.colorspace;
  }
  constexpr int kFirstLinesOfHd = 720;
  return frame.height >= kFirstLinesOfHd ? AVCOL_SPC_BT709 : AVCOL_SPC_SMPTE170M;
}

class Decoder final : public VideoDecoder {
 public:
  explicit Decoder(const fs::path& path) : path_(path), format_(open_container(path)) {
    const AVCodec* decoder = nullptr;
    const int best =
        ffmpeg().av_find_best_stream(format_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
    if (best < 0 || !decoder) {
      throw IoError(path_.string(), best == AVERROR_DECODER_NOT_FOUND
                                        ? "is a video of a kind that cannot be decoded here"
                                        : "holds no video");
    }
    stream_ = format_->streams[best];
    codec_.reset(allocated(ffmpeg().avcodec_alloc_context3(decoder)));
    ffmpeg().avcodec_parameters_to_context(codec_.get(), stream_->codecpar);
    codec_->max_pixels = kMostPixels;
    codec_->thread_count = 0;  // all cores; pictures do not depend on it
    codec_->pkt_timebase = stream_->time_base;
    const int error = ffmpeg().avcodec_open2(codec_.get(), decoder, nullptr);
    if (error < 0) throw IoError(path_.string(), "cannot be decoded: " + ffmpeg_error(error));
    orientation_ = orientation_of(*stream_);
    packet_.reset(allocated(ffmpeg().av_packet_alloc()));
    frame_.reset(allocated(ffmpeg().av_frame_alloc()));
  }

  std::optional<double> next() override {
    while (true) {
      const int error = ffmpeg().avcodec_receive_frame(codec_.get(), frame_.get());
      if (error == 0) return accepted();
      if (error == AVERROR_EOF) {
        check_end();
        return std::nullopt;
      }
      if (error != AVERROR(EAGAIN)) fail("cannot be decoded: " + ffmpeg_error(error));
      feed();
    }
  }

  Image image() override {
    const AVFrame& frame = *frame_;
    const AVRational shape =
        ffmpeg().av_guess_sample_aspect_ratio(format_.get(), stream_, frame_.get());
    const double stretch = shape.num > 0 && shape.den > 0 ? double(shape.num) / shape.den : 1;
    const double width = std::max(1.0, std::round(frame.width * stretch));
    if (width * frame.height > double(kMostPixels)) fail("has too many pixels");
    Image image(static_cast<int>(width), frame.height);
    prepare_scaler(image.width);
    // The scaler writes whole vectors past the end of a row, so it needs padded rows.
    constexpr int kAligned = 64;
    const int row = FFALIGN(3 * image.width, kAligned) + kAligned;
    rows_.resize(static_cast<std::size_t>(row) * static_cast<std::size_t>(image.height));
    std::uint8_t* const target[] = {rows_.data()};
    ffmpeg().sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, target, &row);
    static_assert(sizeof(Color) == 3);
    for (int y = 0; y < image.height; ++y) {
      std::memcpy(&image.at(0, y), rows_.data() + std::ptrdiff_t{row} * y,
                  sizeof(Color) * static_cast<std::size_t>(image.width));
    }
    return oriented(std::move(image), orientation_);
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    std::string place = "frame " + std::to_string(frames_);
    if (frames_ > 0) place += ", after " + readable(time_) + " s,";
    throw IoError(path_.string(), place + " " + problem);
  }

  double time_of(std::int64_t stamp, AVRational base) const {
    return seconds_from_start(*format_, stamp, base);
  }

  /// Sends the next packet of the stream, or its end, to the decoder.
  void feed() {
    while (true) {
      const int error = ffmpeg().av_read_frame(format_.get(), packet_.get());
      if (error == AVERROR_EOF) {
        ffmpeg().avcodec_send_packet(codec_.get(), nullptr);
        return;
      }
      if (error < 0) fail("cannot be read: " + ffmpeg_error(error));
      const AVPacket& packet = *packet_;
      const AVRational base = format_->streams[packet.stream_index]->time_base;
      if (packet.pts != AV_NOPTS_VALUE) {
        end_ = std::max(end_, time_of(packet.pts + packet.duration, base));
      }
      const bool is_ours = packet.stream_index == stream_->index;
      if (is_ours && (packet.flags & AV_PKT_FLAG_CORRUPT)) fail("was cut off or is damaged");
      const int refused = is_ours ? ffmpeg().avcodec_send_packet(codec_.get(), packet_.get()) : 0;
      ffmpeg().av_packet_unref(packet_.get());
      if (refused < 0) fail("is damaged: " + ffmpeg_error(refused));
      if (is_ours) return;
    }
  }

  double accepted() {
    const AVFrame& frame = *frame_;
    if (frame.decode_error_flags != 0 || (frame.flags & AV_FRAME_FLAG_CORRUPT)) fail("is damaged");
    if (frames_ == 0) {
      width_ = frame.width;
      height_ = frame.height;
      pixels_ = frame.format;
    } else if (frame.format != pixels_) {
      fail("has pixels of another kind than the first; cut the video there");
    } else if (frame.width != width_ || frame.height != height_) {
      fail("has " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
           " pixels, expected " + std::to_string(width_) + " x " + std::to_string(height_) +
           " as in the first; cut the video there");
    }
    const double time = time_of_frame();
    if (frames_ > 0 && !(time > time_)) {
      fail("is at " + readable(time) +
           " s, expected times that rise; 'ffmpeg -i IN -vsync vfr OUT.mp4' mends that");
    }
    ++frames_;
    return time_ = time;
  }

  /// Time stamp of the frame. Without one, the frame follows the last one at the video's rate.
  double time_of_frame() const {
    if (frame_->best_effort_timestamp != AV_NOPTS_VALUE) {
      return time_of(frame_->best_effort_timestamp, stream_->time_base);
    }
    const AVRational rate = stream_->avg_frame_rate;
    if (rate.num <= 0 || rate.den <= 0) fail("has no time, and the video no rate of frames");
    return frames_ == 0 ? 0 : time_ + double(rate.den) / rate.num;
  }

  /// Throws IoError if the file ends before the time in its header: it was cut off.
  void check_end() const {
    const bool is_known =
        format_->duration > 0 && format_->duration_estimation_method != AVFMT_DURATION_FROM_BITRATE;
    // The duration of the last picture may be missing, and times are rounded.
    const double tolerance = std::max(0.1, frames_ > 1 ? 2 * time_ / (frames_ - 1) : 0);
    const double said = is_known ? seconds(format_->duration, {1, AV_TIME_BASE}) : 0;
    if (end_ < said - tolerance) {
      fail("is missing: the video breaks off, its header says " + readable(said) + " s");
    }
  }

  void prepare_scaler(int width) {
    const AVFrame& frame = *frame_;
    const auto format = static_cast<AVPixelFormat>(frame.format);
    if (scaler_) return;
    scaler_.reset(ffmpeg().sws_getContext(frame.width, frame.height, format, width, frame.height,
                                          AV_PIX_FMT_RGB24, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr,
                                          nullptr, nullptr));
    if (!scaler_) fail("has pixels of a kind that cannot be converted");
    const int full_range = frame.color_range == AVCOL_RANGE_JPEG ? 1 : 0;
    ffmpeg().sws_setColorspaceDetails(scaler_.get(), ffmpeg().sws_getCoefficients(colors_of(frame)),
                                      full_range, ffmpeg().sws_getCoefficients(SWS_CS_DEFAULT), 1,
                                      0, kUnchanged, kUnchanged);
  }

  fs::path path_;
  FfmpegOwned<AVFormatContext> format_;
  AVStream* stream_ = nullptr;
  FfmpegOwned<AVCodecContext> codec_;
  FfmpegOwned<AVPacket> packet_;
  FfmpegOwned<AVFrame> frame_;
  FfmpegOwned<SwsContext> scaler_;
  std::vector<std::uint8_t> rows_;
  Orientation orientation_;
  int frames_ = 0;  ///< frames that next() returned
  double time_ = 0;
  double end_ = 0;  ///< end of the last packet of any stream
  int width_ = 0;
  int height_ = 0;
  int pixels_ = 0;
};

}  // namespace

std::unique_ptr<VideoDecoder> open_video(const fs::path& path) {
  return std::make_unique<Decoder>(path);
}

namespace {

/// Frees a context for writing and closes its file.
struct OutputClosed {
  void operator()(AVFormatContext* context) const {
    ffmpeg().avio_closep(&context->pb);
    ffmpeg().avformat_free_context(context);
  }
};

/// Sound of a video as packets, in stored form.
class SoundSource {
 public:
  explicit SoundSource(const fs::path& path) : format_(open_container(path)) {
    stream_ = ffmpeg().av_find_best_stream(format_.get(), AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
    packet_.reset(allocated(ffmpeg().av_packet_alloc()));
  }

  /// Null if the video has no sound.
  const AVStream* stream() const { return stream_ < 0 ? nullptr : format_->streams[stream_]; }

  /// Next packet with a time; null after the last one.
  AVPacket* next() {
    while (true) {
      ffmpeg().av_packet_unref(packet_.get());
      if (ffmpeg().av_read_frame(format_.get(), packet_.get()) < 0) return nullptr;
      if (packet_->stream_index == stream_ && packet_->pts != AV_NOPTS_VALUE) return packet_.get();
    }
  }
  /// Seconds from the start of the video.
  double time() const { return seconds_from_start(*format_, packet_->pts, stream()->time_base); }

 private:
  FfmpegOwned<AVFormatContext> format_;
  int stream_ = -1;
  FfmpegOwned<AVPacket> packet_;
};

const AVOutputFormat* container_of(const std::string& extension) {
  return ffmpeg().av_guess_format(nullptr, ("video" + extension).c_str(), nullptr);
}

bool holds_sound(const AVOutputFormat& container, const AVStream& sound) {
  // A container may also hold codecs that its tables lack, but FFmpeg cannot tell.
  return ffmpeg().avformat_query_codec(&container, sound.codecpar->codec_id,
                                       FF_COMPLIANCE_NORMAL) == 1;
}

class Encoder final : public VideoEncoder {
 public:
  Encoder(const fs::path& path, fs::path target, const VideoLayout& layout)
      : target_(std::move(target)), layout_(layout) {
    load_ffmpeg<OutputError>(target_);
    const AVOutputFormat* container = container_of(layout.extension);
    if (!container) fail("is no known kind of video");
    AVFormatContext* made = nullptr;
    check(
        ffmpeg().avformat_alloc_output_context2(&made, container, nullptr, file_url(path).c_str()));
    format_.reset(made);
    // Without times of day and random numbers, equal pictures give equal files.
    format_->flags |= AVFMT_FLAG_BITEXACT;
    packet_.reset(allocated(ffmpeg().av_packet_alloc()));
    add_pictures();
    if (!layout_.sound.empty()) add_sound();
    check(ffmpeg().avio_open(&format_->pb, file_url(path).c_str(), AVIO_FLAG_WRITE));
    check(ffmpeg().avformat_write_header(format_.get(), nullptr));
  }

  void add(const Image& image, double time) override {
    if (image.width != layout_.width || image.height != layout_.height) {
      throw std::invalid_argument("a picture of another size than the video's");
    }
    copy_sound(time);
    fill(image);
    frame_->pts = std::llround((time - layout_.first_time) * codec_->time_base.den);
    encode(frame_.get());
  }

  void finish() override {
    encode(nullptr);
    copy_sound(layout_.end_time);
    check(ffmpeg().av_write_trailer(format_.get()));
    check(ffmpeg().avio_closep(&format_->pb));
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw OutputError(target_.string(), problem);
  }
  void check(int error) const {
    if (error < 0) fail("cannot be written: " + ffmpeg_error(error));
  }

  void add_pictures() {
    const AVCodec* encoder = ffmpeg().avcodec_find_encoder_by_name("libx264");
    const bool is_x264 = encoder != nullptr;
    if (!encoder) encoder = ffmpeg().avcodec_find_encoder(AV_CODEC_ID_MPEG4);
    if (!encoder) fail("there is no encoder of H.264 or MPEG-4; name a folder of pictures");
    codec_.reset(allocated(ffmpeg().avcodec_alloc_context3(encoder)));
    // 2 x 2 pixels share a colour, so width and height must be even.
    codec_->width = layout_.width + layout_.width % 2;
    codec_->height = layout_.height + layout_.height % 2;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    codec_->color_range = AVCOL_RANGE_MPEG;
    // These are multiples of the usual rates. MPEG-4 counts to 65535.
    codec_->time_base = {1, is_x264 ? 120000 : 60000};
    codec_->framerate = ffmpeg().av_d2q(layout_.fps, 100000);
    codec_->thread_count = 1;  // the bytes depend on it
    if (format_->oformat->flags & AVFMT_GLOBALHEADER) {
      codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    }
    AVDictionary* options = nullptr;
    if (is_x264) {
      ffmpeg().av_dict_set(&options, "preset", "veryfast", 0);
      ffmpeg().av_dict_set(&options, "crf", "18", 0);
    } else {
      codec_->flags |= AV_CODEC_FLAG_QSCALE;
      codec_->global_quality = 3 * FF_QP2LAMBDA;
    }
    const int error = ffmpeg().avcodec_open2(codec_.get(), encoder, &options);
    ffmpeg().av_dict_free(&options);
    check(error);
    pictures_ = allocated(ffmpeg().avformat_new_stream(format_.get(), nullptr));
    check(ffmpeg().avcodec_parameters_from_context(pictures_->codecpar, codec_.get()));
    pictures_->time_base = codec_->time_base;
    pictures_->avg_frame_rate = codec_->framerate;
    frame_.reset(allocated(ffmpeg().av_frame_alloc()));
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    check(ffmpeg().av_frame_get_buffer(frame_.get(), 0));
    scaler_.reset(ffmpeg().sws_getContext(
        codec_->width, codec_->height, AV_PIX_FMT_RGB24, codec_->width, codec_->height,
        codec_->pix_fmt, SWS_BICUBIC | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
    if (!scaler_) fail("its pictures cannot be converted");
    ffmpeg().sws_setColorspaceDetails(scaler_.get(), ffmpeg().sws_getCoefficients(SWS_CS_DEFAULT),
                                      1, ffmpeg().sws_getCoefficients(SWS_CS_ITU709), 0, 0,
                                      kUnchanged, kUnchanged);
  }

  void add_sound() {
    auto source = std::make_unique<SoundSource>(layout_.sound);
    if (!source->stream() || !holds_sound(*format_->oformat, *source->stream())) return;
    sound_ = allocated(ffmpeg().avformat_new_stream(format_.get(), nullptr));
    check(ffmpeg().avcodec_parameters_copy(sound_->codecpar, source->stream()->codecpar));
    sound_->codecpar->codec_tag = 0;  // each container has its own
    sound_->time_base = source->stream()->time_base;
    source_ = std::move(source);
  }

  /// Copies sound before `end` that was not copied yet.
  void copy_sound(double end) {
    if (!source_) return;
    while (true) {
      if (!waiting_) waiting_ = source_->next();
      if (!waiting_ || source_->time() >= end) return;
      if (source_->time() >= layout_.first_time) {
        const AVRational base = source_->stream()->time_base;
        const std::int64_t first =
            waiting_->pts -
            std::llround((source_->time() - layout_.first_time) * base.den / base.num);
        waiting_->pts -= first;
        if (waiting_->dts != AV_NOPTS_VALUE) waiting_->dts -= first;
        waiting_->stream_index = sound_->index;
        waiting_->pos = -1;
        ffmpeg().av_packet_rescale_ts(waiting_, base, sound_->time_base);
        check(ffmpeg().av_interleaved_write_frame(format_.get(), waiting_));
      }
      waiting_ = nullptr;
    }
  }

  /// Fills frame_. Extra pixels at the right and lower edge repeat the edge.
  void fill(const Image& image) {
    check(ffmpeg().av_frame_make_writable(frame_.get()));
    const int width = codec_->width, height = codec_->height;
    const std::size_t row = 3 * static_cast<std::size_t>(width);
    constexpr std::size_t kReadBeyond = 64;
    rows_.resize(row * static_cast<std::size_t>(height) + kReadBeyond);
    for (int y = 0; y < height; ++y) {
      std::uint8_t* target = rows_.data() + row * static_cast<std::size_t>(y);
      const int from = std::min(y, image.height - 1);
      const auto* source = reinterpret_cast<const std::uint8_t*>(&image.at(0, from));
      const std::size_t size = 3 * static_cast<std::size_t>(image.width);
      std::memcpy(target, source, size);
      if (size < row) std::memcpy(target + size, target + size - 3, 3);
    }
    const std::uint8_t* const data[] = {rows_.data()};
    const int stride = 3 * width;
    ffmpeg().sws_scale(scaler_.get(), data, &stride, 0, height, frame_->data, frame_->linesize);
  }

  /// Null ends the video.
  void encode(const AVFrame* frame) {
    check(ffmpeg().avcodec_send_frame(codec_.get(), frame));
    while (true) {
      const int error = ffmpeg().avcodec_receive_packet(codec_.get(), packet_.get());
      if (error == AVERROR(EAGAIN) || error == AVERROR_EOF) return;
      check(error);
      packet_->stream_index = pictures_->index;
      ffmpeg().av_packet_rescale_ts(packet_.get(), codec_->time_base, pictures_->time_base);
      check(ffmpeg().av_interleaved_write_frame(format_.get(), packet_.get()));
    }
  }

  fs::path target_;
  VideoLayout layout_;
  std::unique_ptr<AVFormatContext, OutputClosed> format_;
  FfmpegOwned<AVCodecContext> codec_;
  FfmpegOwned<AVPacket> packet_;
  FfmpegOwned<AVFrame> frame_;
  FfmpegOwned<SwsContext> scaler_;
  std::vector<std::uint8_t> rows_;
  AVStream* pictures_ = nullptr;
  AVStream* sound_ = nullptr;
  std::unique_ptr<SoundSource> source_;
  AVPacket* waiting_ = nullptr;  ///< packet of the source that was not copied yet
};

}  // namespace

std::unique_ptr<VideoEncoder> create_video(const fs::path& path, const fs::path& target,
                                           const VideoLayout& layout) {
  return std::make_unique<Encoder>(path, target, layout);
}

bool can_keep_sound(const fs::path& video, const std::string& extension) {
  const SoundSource source(video);
  const AVOutputFormat* container = container_of(extension);
  return !source.stream() || (container && holds_sound(*container, *source.stream()));
}

}  // namespace mimetra
