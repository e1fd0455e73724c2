#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fitting/ffmpeg.h"
#include "fitting/video_codec.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// A context for writing, whose file is closed with it.
struct OutputClosed {
  void operator()(AVFormatContext* context) const {
    ffmpeg().avio_closep(&context->pb);
    ffmpeg().avformat_free_context(context);
  }
};

/// The sound of a video, packet by packet, as it is stored.
class SoundSource {
 public:
  explicit SoundSource(const fs::path& path) : format_(open_container(path)) {
    stream_ = ffmpeg().av_find_best_stream(format_.get(), AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
    packet_.reset(allocated(ffmpeg().av_packet_alloc()));
  }

  /// Null where the video has none.
  const AVStream* stream() const { return stream_ < 0 ? nullptr : format_->streams[stream_]; }

  /// The next packet with a time; null after the last one.
  AVPacket* next() {
    while (true) {
      ffmpeg().av_packet_unref(packet_.get());
      if (ffmpeg().av_read_frame(format_.get(), packet_.get()) < 0) return nullptr;
      if (packet_->stream_index == stream_ && packet_->pts != AV_NOPTS_VALUE) return packet_.get();
    }
  }
  /// Seconds from the video's beginning.
  double time() const {
    const std::int64_t start = format_->start_time == AV_NOPTS_VALUE ? 0 : format_->start_time;
    return seconds(packet_->pts, stream()->time_base) - seconds(start, {1, AV_TIME_BASE});
  }

 private:
  FfmpegOwned<AVFormatContext> format_;
  int stream_ = -1;
  FfmpegOwned<AVPacket> packet_;
};

const AVOutputFormat* container_of(const std::string& extension) {
  return ffmpeg().av_guess_format(nullptr, ("video" + extension).c_str(), nullptr);
}

bool holds_sound(const AVOutputFormat& container, const AVStream& sound) {
  // What a container's tables do not name it may still hold; that is not simple.
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
    // No times of day or random numbers: the same pictures give the same file.
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
    // Pairs of pixels share a colour.
    codec_->width = layout_.width + layout_.width % 2;
    codec_->height = layout_.height + layout_.height % 2;
    codec_->pix_fmt = AV_PIX_FMT_YUV420P;
    codec_->colorspace = AVCOL_SPC_BT709;
    codec_->color_primaries = AVCOL_PRI_BT709;
    codec_->color_trc = AVCOL_TRC_BT709;
    codec_->color_range = AVCOL_RANGE_MPEG;
    // Whole numbers for the usual rates; MPEG-4 counts to 65535.
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
    constexpr int kUnchanged = 1 << 16;
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

  /// What sounds before `end` and was not copied yet.
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

  /// Into frame_; what the coder needs beyond the right and lower edge repeats them.
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

  /// Null for the end.
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
  AVPacket* waiting_ = nullptr;  ///< of the source, not copied yet
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
