#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace mimetra {

/// Red, green, blue.
using Colour = std::array<std::uint8_t, 3>;

/// A picture: its pixels row after row, from the top left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Colour> pixels;

  Image() = default;
  /// Of one colour.
  Image(int columns, int rows, Colour colour);

  bool contains(int x, int y) const { return x >= 0 && x < width && y >= 0 && y < height; }
  /// \pre contains(x, y)
  Colour& at(int x, int y) { return pixels[index(x, y)]; }
  const Colour& at(int x, int y) const { return pixels[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

/// Reads a PNG or JPEG file of 8 bits a channel, whatever its extension. Throws IoError for one
/// that is truncated, damaged or of another type, and where mimetra was built without dlib.
Image read_image(const std::filesystem::path& path);

/// Writes a PNG file, atomically. Throws OutputError, also for an image without pixels and where
/// mimetra was built without dlib.
void write_png(const Image& image, const std::filesystem::path& target, bool overwrite = false);

/// The part of columns left .. left + width - 1 and rows top .. top + height - 1 that is inside the
/// image. Throws std::invalid_argument where nothing is.
Image cropped(const Image& image, int left, int top, int width, int height);

/// The image at another height (>= 1), its sides in proportion: each pixel is the mean of what it
/// covers. Throws std::invalid_argument for an image without pixels.
Image scaled_to_height(const Image& image, int height);

/// The images side by side, each scaled to `height` (0: that of the lowest), `gap` white columns
/// between them. Throws std::invalid_argument for no images, one without pixels, or a negative
/// height or gap.
Image strip(const std::vector<Image>& images, int height = 0, int gap = 8);

}  // namespace mimetra
