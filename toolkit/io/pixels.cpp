#include "toolkit/io/pixels.h"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <vector>

#include <jpeglib.h>
#include <png.h>

#include "toolkit/io/bytes.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// Luma with the weights of Rec. 601 in thousandths. Grey values stay exact.
std::uint16_t luma_of(const std::uint16_t* rgb) {
  return static_cast<std::uint16_t>((299U * rgb[0] + 587U * rgb[1] + 114U * rgb[2] + 500U) / 1000U);
}

/// Channels of a grey image differ by at most this much after compression.
constexpr int kColored = 65535 / 16;

[[noreturn]] void fail_truncated(const std::string& path, std::uint64_t bytes) {
  throw IoError(path, "the image is truncated after " + std::to_string(bytes) +
                          " bytes; copy or export it again");
}

/// Throws IoError if there are more than kMostPixels. Also throws it, as for a truncated file, if
/// there are more than `most_per_byte` pixels for each of the file's `bytes`.
void check_pixel_count(const std::string& path, std::uint64_t width, std::uint64_t height,
                       std::uint64_t bytes, std::uint64_t most_per_byte) {
  if (width * height > kMostPixels) {
    throw IoError(path, "says it has " + std::to_string(width) + " x " + std::to_string(height) +
                            " pixels, and " + std::to_string(kMostPixels) +
                            " can be read; make it smaller, or is it damaged?");
  }
  if (width * height / most_per_byte > bytes) fail_truncated(path, bytes);
}

}  // namespace

Pixels::Pixels(std::uint64_t width, std::uint64_t height, bool has_opacity)
    : luma_(height, width), opacity_(has_opacity ? height : 0, has_opacity ? width : 0) {}

void Pixels::set(Eigen::Index row, Eigen::Index column, const std::uint16_t* rgba) {
  luma_(row, column) = luma_of(rgba);
  if (opacity_.size() > 0) opacity_(row, column) = rgba[3];
  if (!has_first_) std::copy_n(rgba, 4, first_.begin());
  has_first_ = true;
  colors_differ_ = colors_differ_ || !std::equal(rgba, rgba + 3, first_.begin());
  opacities_differ_ = opacities_differ_ || rgba[3] != first_[3];
  const auto [least, most] = std::minmax({rgba[0], rgba[1], rgba[2]});
  is_colored_ = is_colored_ || most - least > kColored;
}

namespace {

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
  std::uint64_t width() const { return png_get_image_width(png_, info_); }
  std::uint64_t height() const { return png_get_image_height(png_, info_); }

  std::uint64_t bits_per_pixel() const {
    return std::uint64_t{png_get_channels(png_, info_)} * png_get_bit_depth(png_, info_);
  }
  bool has_opacity() const {
    return (png_get_color_type(png_, info_) & PNG_COLOR_MASK_ALPHA) != 0 ||
           png_get_valid(png_, info_, PNG_INFO_tRNS) != 0;
  }

  /// Returns false on failure. Reads row by row; an interlaced picture arrives as seven smaller
  /// ones.
  /// \pre read_header() succeeded, and `pixels` are width() x height()
  bool read_pixels(Pixels& pixels) {
    row_.resize(4 * width());
    if (setjmp(png_jmpbuf(png_))) return false;
    png_set_expand_16(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xffff, PNG_FILLER_AFTER);
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    png_read_update_info(png_, info_);
    if (png_get_interlace_type(png_, info_) == PNG_INTERLACE_NONE) {
      read_grid(pixels, {0, 0, 1, 1});
    } else {
      for (int pass = 0; pass < PNG_INTERLACE_ADAM7_PASSES; ++pass) {
        read_grid(pixels, {PNG_PASS_START_ROW(pass), PNG_PASS_START_COL(pass),
                           1 << PNG_PASS_ROW_SHIFT(pass), 1 << PNG_PASS_COL_SHIFT(pass)});
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
    Eigen::Index row, column, row_step, column_step;
  };
  /// \pre setjmp() was called
  void read_grid(Pixels& pixels, const Grid& grid) {
    const Eigen::Index rows = pixels.luma().rows(), columns = pixels.luma().cols();
    if (grid.column >= columns) return;
    for (Eigen::Index y = grid.row; y < rows; y += grid.row_step) {
      png_read_row(png_, reinterpret_cast<png_bytep>(row_.data()), nullptr);
      const std::uint16_t* rgba = row_.data();
      for (Eigen::Index x = grid.column; x < columns; x += grid.column_step, rgba += 4) {
        pixels.set(y, x, rgba);
      }
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

}  // namespace

Pixels pixels_of_png(const std::string& path, const std::string& bytes) {
  PngDecoder decoder(bytes);
  if (!decoder.read_header()) fail_to_decode(path, bytes, decoder);
  check_pixel_count(path, decoder.width(), decoder.height(), bytes.size(),
                    8 * kMostInflated / decoder.bits_per_pixel());
  Pixels pixels(decoder.width(), decoder.height(), decoder.has_opacity());
  if (!decoder.read_pixels(pixels)) fail_to_decode(path, bytes, decoder);
  return pixels;
}

namespace {

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
  std::uint64_t width() const { return state_.image_width; }
  std::uint64_t height() const { return state_.image_height; }

  /// True for arithmetic coding, which needs less than a bit for a block of pixels.
  bool is_arithmetic() const { return state_.arith_code; }

  /// Returns false on failure.
  /// \pre read_header() succeeded, and `pixels` are width() x height()
  bool read_pixels(Pixels& pixels) {
    row_.resize(3 * width());
    if (setjmp(on_error_)) return false;
    state_.out_color_space = JCS_RGB;
    jpeg_start_decompress(&state_);
    while (state_.output_scanline < state_.output_height) {
      const Eigen::Index y = state_.output_scanline;
      JSAMPROW row = row_.data();
      jpeg_read_scanlines(&state_, &row, 1);
      for (Eigen::Index x = 0; x < pixels.luma().cols(); ++x) set(pixels, y, x);
    }
    jpeg_finish_decompress(&state_);
    return true;
  }

  std::string message() const { return message_.data(); }

 private:
  void set(Pixels& pixels, Eigen::Index y, Eigen::Index x) const {
    // Maps 255 to 65535.
    constexpr std::uint16_t kTo16Bits = 257;
    std::array<std::uint16_t, 4> rgba = {0, 0, 0, 0xffff};
    for (std::size_t c = 0; c < 3; ++c) {
      rgba[c] = static_cast<std::uint16_t>(kTo16Bits * row_[3 * static_cast<std::size_t>(x) + c]);
    }
    pixels.set(y, x, rgba.data());
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

}  // namespace

Pixels pixels_of_jpeg(const std::string& path, const std::string& bytes) {
  JpegDecoder decoder(bytes);
  if (!decoder.read_header()) fail_to_decode(path, decoder);
  // Huffman codes need at least a bit for each 8 x 8 block. With coarsely sampled colours, one such
  // block covers up to 16 blocks of pixels.
  constexpr std::uint64_t kHuffman = 8 * 64 * 16;
  check_pixel_count(path, decoder.width(), decoder.height(), bytes.size(),
                    decoder.is_arithmetic() ? kMostPixels : kHuffman);
  Pixels pixels(decoder.width(), decoder.height(), false);
  if (!decoder.read_pixels(pixels)) fail_to_decode(path, decoder);
  return pixels;
}

}  // namespace mimetra
