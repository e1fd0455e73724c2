#include "toolkit/io/image_decoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include <jpeglib.h>
#include <png.h>

#include "toolkit/io/bytes.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

constexpr std::string_view kPngStart = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kJpegStart = "\xff\xd8";

[[noreturn]] void fail_truncated(const std::string& path, std::uint64_t bytes) {
  throw IoError(path, "the image is truncated after " + std::to_string(bytes) +
                          " bytes; copy or export it again");
}

/// Throws IoError if there are no pixels or more than kMostPixels. Also throws it, as for a
/// truncated file, if there are more than `most_per_byte` pixels for each of the file's `bytes`.
void check_pixel_count(const std::string& path, const PictureSize& size, std::uint64_t bytes,
                       std::uint64_t most_per_byte) {
  const std::uint64_t pixels = size.width * size.height;
  if (pixels == 0 || pixels > kMostPixels) {
    throw IoError(path, "says it has " + std::to_string(size.width) + " x " +
                            std::to_string(size.height) + " pixels, expected 1 to " +
                            std::to_string(kMostPixels) + " in all");
  }
  if (pixels / most_per_byte > bytes) fail_truncated(path, bytes);
}

/// Decodes PNG. libpng leaves its functions by longjmp if a file is damaged. Functions that a jump
/// leaves or enters must not have variables with destructors, so these are all members.
class PngDecoder {
 public:
  explicit PngDecoder(const std::string& bytes) : bytes_(bytes) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    if (png_) info_ = png_create_info_struct(png_);
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, this, read);
    // Skip texts and profiles of any length; unpacked, they may be a thousand times longer.
    constexpr int kAllButPixelsAndOpacity = -1, kUnlimited = 0;
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, kAllButPixelsAndOpacity);
    png_set_chunk_malloc_max(png_, kUnlimited);
    // Refuse damage that libpng would repair or drop, such as in palette or opacity, since it would
    // change weights.
    png_set_benign_errors(png_, 0);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// Returns false on failure; see message().
  bool read_header() {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_info(png_, info_);
    return true;
  }
  /// \pre read_header() succeeded
  PictureSize size() const {
    return {png_get_image_width(png_, info_), png_get_image_height(png_, info_),
            (png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA) != 0 ||
                png_get_valid(png_, info_, PNG_INFO_tRNS) != 0};
  }
  std::uint64_t bits_per_pixel() const {
    return std::uint64_t{png_get_channels(png_, info_)} * png_get_bit_depth(png_, info_);
  }

  /// Returns false on failure. Reads row by row; an interlaced picture arrives as seven smaller
  /// ones.
  /// \pre read_header() succeeded
  bool read_pixels(PixelSink& sink) {
    row_.resize(4 * size().width);
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_expand_16(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    png_read_update_info(png_, info_);
    if (png_get_interlace_type(png_, info_) == PNG_INTERLACE_NONE) {
      read_grid(sink, {0, 0, 1, 1});
    } else {
      for (int pass = 0; pass < PNG_INTERLACE_ADAM7_PASSES; ++pass) {
        read_grid(sink,
                  {std::uint64_t(PNG_PASS_START_ROW(pass)), std::uint64_t(PNG_PASS_START_COL(pass)),
                   std::uint64_t{1} << PNG_PASS_ROW_SHIFT(pass),
                   std::uint64_t{1} << PNG_PASS_COL_SHIFT(pass)});
      }
    }
    png_read_end(png_, nullptr);
    return true;
  }

  const std::string& message() const { return message_; }
  bool is_truncated() const { return is_truncated_; }

 private:
  /// Pixels of the picture that the next pass sets.
  struct Grid {
    std::uint64_t row, column, row_step, column_step;
  };
  /// \pre setjmp() was called
  void read_grid(PixelSink& sink, const Grid& grid) {
    const std::uint64_t rows = png_get_image_height(png_, info_);
    const std::uint64_t columns = png_get_image_width(png_, info_);
    if (grid.column >= columns) return;
    const std::uint64_t count = (columns - grid.column + grid.column_step - 1) / grid.column_step;
    for (std::uint64_t y = grid.row; y < rows; y += grid.row_step) {
      png_read_row(png_, reinterpret_cast<png_bytep>(row_.data()), nullptr);
      sink.take(y, grid.column, grid.column_step, {row_.data(), 4 * count});
    }
  }

  static void read(png_structp png, png_bytep data, std::size_t size) {
    auto& self = *static_cast<PngDecoder*>(png_get_io_ptr(png));
    if (size > self.bytes_.size() - self.at_) {
      self.is_truncated_ = true;
      png_error(png, "end of file");
    }
    std::memcpy(data, self.bytes_.data() + self.at_, size);
    self.at_ += size;
  }
  [[noreturn]] static void fail(png_structp png, png_const_charp message) {
    static_cast<PngDecoder*>(png_get_error_ptr(png))->message_ = message;
    png_longjmp(png, 1);
  }
  static void ignore(png_structp, png_const_charp) {}

  const std::string& bytes_;
  std::size_t at_ = 0;
  std::vector<std::uint16_t> row_;
  std::string message_;
  bool is_truncated_ = false;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

[[noreturn]] void fail_to_decode(const std::string& path, const std::string& bytes,
                                 const PngDecoder& decoder) {
  if (decoder.is_truncated()) fail_truncated(path, bytes.size());
  throw IoError(path, "is a damaged PNG file (" + decoder.message() + "); export it again");
}

/// Decodes into `sink`, or only the header without one.
PictureSize decode_png(const std::string& path, const std::string& bytes, PixelSink* sink) {
  PngDecoder decoder(bytes);
  if (!decoder.read_header()) fail_to_decode(path, bytes, decoder);
  const PictureSize size = decoder.size();
  check_pixel_count(path, size, bytes.size(), 8 * kMostInflated / decoder.bits_per_pixel());
  if (!sink) return size;
  sink->begin(size);
  if (!decoder.read_pixels(*sink)) fail_to_decode(path, bytes, decoder);
  return size;
}

/// Decodes JPEG. If a file is damaged, libjpeg calls an error function that must not return, so it
/// leaves by longjmp. Functions that a jump leaves or enters must not have variables with
/// destructors.
class JpegDecoder {
 public:
  explicit JpegDecoder(const std::string& bytes) : bytes_(bytes) {
    state_.err = jpeg_std_error(&errors_);
    errors_.error_exit = fail;
    errors_.emit_message = refuse_warnings;
    state_.client_data = this;
  }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&state_); }

  /// Returns false on failure; see message().
  bool read_header() {
    if (setjmp(on_error_)) return false;
    jpeg_create_decompress(&state_);
    progress_.progress_monitor = refuse_many_scans;
    state_.progress = &progress_;
    jpeg_mem_src(&state_, reinterpret_cast<const unsigned char*>(bytes_.data()),
                 static_cast<unsigned long>(bytes_.size()));
    jpeg_read_header(&state_, TRUE);
    return true;
  }
  PictureSize size() const { return {state_.image_width, state_.image_height}; }

  /// True for arithmetic coding, which needs less than a bit for a block of pixels.
  bool is_arithmetic() const { return state_.arith_code; }

  /// Returns false on failure.
  /// \pre read_header() succeeded
  bool read_pixels(PixelSink& sink) {
    row_.resize(3 * size().width);
    rgba_.assign(4 * size().width, 0xffff);
    if (setjmp(on_error_)) return false;
    state_.out_color_space = JCS_RGB;
    jpeg_start_decompress(&state_);
    while (state_.output_scanline < state_.output_height) {
      const std::uint64_t y = state_.output_scanline;
      JSAMPROW row = row_.data();
      jpeg_read_scanlines(&state_, &row, 1);
      widen();
      sink.take(y, 0, 1, rgba_);
    }
    jpeg_finish_decompress(&state_);
    return true;
  }

  std::string message() const { return message_.data(); }

 private:
  void widen() {
    constexpr std::uint16_t kTo16Bits = 257;  // maps 255 to 65535
    for (std::size_t x = 0; x < row_.size() / 3; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        rgba_[4 * x + c] = static_cast<std::uint16_t>(kTo16Bits * row_[3 * x + c]);
      }
    }
  }

  [[noreturn]] static void fail(j_common_ptr state) {
    auto& self = *static_cast<JpegDecoder*>(state->client_data);
    state->err->format_message(state, self.message_.data());
    longjmp(self.on_error_, 1);
  }
  /// Fails on warnings, since libjpeg would fill missing data with grey.
  static void refuse_warnings(j_common_ptr state, int level) {
    if (level < 0) fail(state);
  }

  /// Fails on too many scans, since scans of a few bytes each make libjpeg process all blocks.
  /// Encoders make about ten scans, and a few dozen at most.
  static void refuse_many_scans(j_common_ptr state) {
    constexpr int kMostScans = 100;
    if (reinterpret_cast<j_decompress_ptr>(state)->input_scan_number <= kMostScans) return;
    auto& self = *static_cast<JpegDecoder*>(state->client_data);
    std::snprintf(self.message_.data(), self.message_.size(), "more than %d scans", kMostScans);
    longjmp(self.on_error_, 1);
  }

  const std::string& bytes_;
  std::vector<unsigned char> row_;
  std::vector<std::uint16_t> rgba_;
  jpeg_decompress_struct state_ = {};
  jpeg_progress_mgr progress_ = {};
  jpeg_error_mgr errors_ = {};
  std::jmp_buf on_error_ = {};
  std::array<char, JMSG_LENGTH_MAX> message_ = {};
};

[[noreturn]] void fail_to_decode(const std::string& path, const JpegDecoder& decoder) {
  throw IoError(path, "is a damaged JPEG file, or of a kind that cannot be read (" +
                          decoder.message() + "); export it again as RGB or grey");
}

PictureSize decode_jpeg(const std::string& path, const std::string& bytes, PixelSink* sink) {
  JpegDecoder decoder(bytes);
  if (!decoder.read_header()) fail_to_decode(path, decoder);
  // Huffman codes need at least a bit for each 8 x 8 block. With coarsely sampled colours, one such
  // block covers up to 16 blocks of pixels.
  constexpr std::uint64_t kHuffman = 8 * 64 * 16;
  const PictureSize size = decoder.size();
  check_pixel_count(path, size, bytes.size(), decoder.is_arithmetic() ? kMostPixels : kHuffman);
  if (!sink) return size;
  sink->begin(size);
  if (!decoder.read_pixels(*sink)) fail_to_decode(path, decoder);
  return size;
}

PictureSize decode(const std::string& path, const std::string& bytes, PixelSink* sink) {
  if (bytes.starts_with(kPngStart)) return decode_png(path, bytes, sink);
  if (bytes.starts_with(kJpegStart)) return decode_jpeg(path, bytes, sink);
  throw IoError(path, "is no image that can be read; expected PNG or JPEG");
}

/// Number of `size` bytes at `at`; 0 behind the end.
std::uint64_t exif_number(std::string_view data, std::uint64_t at, std::uint64_t size,
                          bool is_little_endian) {
  std::uint64_t value = 0;
  if (at > data.size() || size > data.size() - at) return value;
  for (std::uint64_t i = 0; i < size; ++i) {
    value =
        value << 8 | static_cast<unsigned char>(data[at + (is_little_endian ? size - 1 - i : i)]);
  }
  return value;
}

/// Exif data of a JPEG file, from its byte order on; empty if there is none.
std::string_view exif_data(std::string_view bytes) {
  constexpr std::string_view kExif("Exif\0\0", 6);
  constexpr unsigned char kApp1 = 0xe1, kScan = 0xda;
  if (!bytes.starts_with(kJpegStart)) return {};
  // Segments: a marker, the length with its own two bytes, content.
  for (std::size_t at = 2; at + 4 <= bytes.size() && bytes[at] == '\xff';) {
    const auto marker = static_cast<unsigned char>(bytes[at + 1]);
    const auto length = exif_number(bytes, at + 2, 2, false);
    if (marker == kScan || length < 2) return {};
    const std::string_view content = bytes.substr(at + 4, length - 2);
    if (marker == kApp1 && content.starts_with(kExif)) return content.substr(kExif.size());
    at += 2 + length;
  }
  return {};
}

}  // namespace

void decode_picture(const std::string& path, const std::string& bytes, PixelSink& sink) {
  decode(path, bytes, &sink);
}

PictureSize picture_size(const std::string& path, const std::string& bytes) {
  return decode(path, bytes, nullptr);
}

int exif_orientation(std::string_view bytes) {
  constexpr std::uint64_t kOrientation = 0x0112;
  const std::string_view data = exif_data(bytes);
  const bool is_little = data.starts_with("II");
  const std::uint64_t list = exif_number(data, 4, 4, is_little);
  const std::uint64_t entries = exif_number(data, list, 2, is_little);
  for (std::uint64_t i = 0; i < entries; ++i) {
    const std::uint64_t entry = list + 2 + 12 * i;
    if (exif_number(data, entry, 2, is_little) != kOrientation) continue;
    const std::uint64_t number = exif_number(data, entry + 8, 2, is_little);
    return number >= 1 && number <= 8 ? static_cast<int>(number) : 1;
  }
  return 1;
}

}  // namespace mimetra
