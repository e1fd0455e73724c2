#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "fitting/ffmpeg.h"
#include "fitting/image_orientation.h"
#include "fitting/video_codec.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

namespace fs = std::filesystem;

/// As of images: more comes from a damaged header.
constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;

/// The turn that a player gives the pictures of a stream.
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
  // Column to column and row to row; or columns to rows. Turns between them are none of a camera.
  const std::int64_t a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
  const bool transposed = std::abs(b) + std::abs(c) > std::abs(a) + std::abs(d);
  return {transposed, (transposed ? c : a) < 0, (transposed ? b : d) < 0};
}

/// The matrix of the picture's colours where the file does not say: that of its size.
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
    codec_->thread_count = 0;  // as many as there are; pictures do not depend on it
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
    // Rows of its own, because whole vectors are written at their ends.
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
    const std::int64_t start = format_->start_time == AV_NOPTS_VALUE ? 0 : format_->start_time;
    return seconds(stamp, base) - seconds(start, {1, AV_TIME_BASE});
  }

  /// The next packet of the stream, or its end, goes to the decoder.
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

  /// Its stamp; without one it follows the last frame at the video's rate.
  double time_of_frame() const {
    if (frame_->best_effort_timestamp != AV_NOPTS_VALUE) {
      return time_of(frame_->best_effort_timestamp, stream_->time_base);
    }
    const AVRational rate = stream_->avg_frame_rate;
    if (rate.num <= 0 || rate.den <= 0) fail("has no time, and the video no rate of frames");
    return frames_ == 0 ? 0 : time_ + double(rate.den) / rate.num;
  }

  /// A file that was cut ends like any other, but before the time that its header says.
  void check_end() const {
    const bool is_known =
        format_->duration > 0 && format_->duration_estimation_method != AVFMT_DURATION_FROM_BITRATE;
    // The last picture's duration may be missing, and times are rounded.
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
    constexpr int kUnchanged = 1 << 16;
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
  int frames_ = 0;  ///< that next() came to
  double time_ = 0;
  double end_ = 0;  ///< where the last packet of any stream ends
  int width_ = 0;
  int height_ = 0;
  int pixels_ = 0;
};

}  // namespace

std::unique_ptr<VideoDecoder> open_video(const fs::path& path) {
  return std::make_unique<Decoder>(path);
}

}  // namespace mimetra
