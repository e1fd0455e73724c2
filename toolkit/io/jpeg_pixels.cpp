#include <array>
#include <csetjmp>
#include <cstdio>
#include <vector>

#include <jpeglib.h>

#include "toolkit/io/pixels.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// libjpeg calls back where a file is damaged, and must not return from there: it is jumped out of.
/// No function that is jumped out of, or into, has a variable with a destructor.
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

  /// False where it failed: message().
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

  /// Arithmetic coding needs less than a bit for a block of pixels.
  bool is_arithmetic() const { return state_.arith_code; }

  /// \pre read_header(), and `pixels` are width() x height(). The same.
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
    // 255 is 65535.
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
  /// What is missing would be filled with grey.
  static void refuse_warnings(j_common_ptr state, int level) {
    if (level < 0) fail(state);
  }

  /// Scans of a few bytes each go over all blocks: encoders make ten, the most careful of them some
  /// dozens.
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
  // Huffman's codes need a bit or more for each block of 8 x 8, of which there is one for 16 of
  // them where colours are sampled more coarsely.
  constexpr std::uint64_t kHuffman = 8 * 64 * 16;
  check_pixel_count(path, decoder.width(), decoder.height(), bytes.size(),
                    decoder.is_arithmetic() ? kMostPixels : kHuffman);
  Pixels pixels(decoder.width(), decoder.height(), false);
  if (!decoder.read_pixels(pixels)) fail_to_decode(path, decoder);
  return pixels;
}

}  // namespace mimetra
