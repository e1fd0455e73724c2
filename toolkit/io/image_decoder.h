#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

/// Decoders of PNG and JPEG files.
namespace mimetra {

/// Limit that only damaged headers exceed: 268 million pixels, which take 800 MB as RGB.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

/// Size of a picture as its file stores it.
struct PictureSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  /// The file stores an opacity; otherwise all pixels are opaque.
  bool has_opacity = false;
};

/// Receives the pixels of a picture.
class PixelSink {
 public:
  virtual ~PixelSink() = default;
  /// Comes before all pixels.
  virtual void begin(const PictureSize& size) = 0;
  /// Takes red, green, blue and opacity of pixels of a row, from 0 to 65535: at columns `column`,
  /// `column` + `step` and so on. Each pixel comes once, and the upper left one first. Must not
  /// throw.
  virtual void take(std::uint64_t row, std::uint64_t column, std::uint64_t step,
                    std::span<const std::uint16_t> rgba) = 0;

 protected:
  PixelSink() = default;
  PixelSink(const PixelSink&) = default;
  PixelSink& operator=(const PixelSink&) = default;
};

/// Decodes a PNG or JPEG file, whatever its name. Throws IoError if the bytes are neither, are
/// truncated or damaged, or have more than kMostPixels. Calls `begin` only if the file is long
/// enough for its pixels.
void decode_picture(const std::string& path, const std::string& bytes, PixelSink& sink);

/// Size of a PNG or JPEG file. Throws as decode_picture() for what the header shows.
PictureSize picture_size(const std::string& path, const std::string& bytes);

/// How a camera was held, as Exif data in a JPEG file counts it, from 1 to 8; 1 for other files and
/// damaged data.
/// [CIPA DC-008, Exchangeable image file format for digital still cameras, 2.3], 4.5 and 4.6.4
int exif_orientation(std::string_view bytes);

}  // namespace mimetra
