#include <bit>
#include <csetjmp>
#include <cstring>
#include <vector>

#include <png.h>

#include "toolkit/io/pixels.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// libpng jumps out of its functions where a file is damaged. No function that it may jump out of,
/// or into, has a variable with a destructor; all of those are members.
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
    // Texts and profiles are read over, however long: packed, they may be a thousand times longer.
    constexpr int kAllButPixelsAndOpacity = -1, kUnlimited = 0;
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, kAllButPixelsAndOpacity);
    png_set_chunk_malloc_max(png_, kUnlimited);
    // What libpng would mend or leave out, as a damaged palette or opacity, makes other weights.
    png_set_benign_errors(png_, 0);
    png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }

  /// False where it failed: message().
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

  /// \pre read_header(), and `pixels` are width() x height(). The same. Row by row: an interlaced
  /// picture comes as seven smaller ones.
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
  /// Which pixels of the picture come next.
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
  if (decoder.is_truncated()) {
    throw IoError(path, "the image is truncated after " + std::to_string(bytes.size()) +
                            " bytes; copy or export it again");
  }
  throw IoError(path, "is a damaged PNG file (" + decoder.message() + "); export it again");
}

}  // namespace

Pixels pixels_of_png(const std::string& path, const std::string& bytes) {
  PngDecoder decoder(bytes);
  if (!decoder.read_header()) fail_to_decode(path, bytes, decoder);
  // Deflate makes no more than 1032 bytes of one.
  constexpr std::uint64_t kDeflate = 1032;
  check_pixel_count(path, decoder.width(), decoder.height(), bytes.size(),
                    8 * kDeflate / decoder.bits_per_pixel());
  Pixels pixels(decoder.width(), decoder.height(), decoder.has_opacity());
  if (!decoder.read_pixels(pixels)) fail_to_decode(path, bytes, decoder);
  return pixels;
}

}  // namespace mimetra
