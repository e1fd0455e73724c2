#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace mimetra {

/// An sRGB colour.
struct Color {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool operator==(const Color&) const = default;
};

/// A picture: its pixels row after row, from the top left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Color> pixels;

  Image() = default;
  /// Of one colour. \pre columns >= 0, rows >= 0
  Image(int columns, int rows, const Color& color = {})
      : width(columns),
        height(rows),
        pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), color) {}

  bool contains(int x, int y) const { return x >= 0 && x < width && y >= 0 && y < height; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  /// \pre contains(x, y)
  Color& at(int x, int y) { return pixels[index(x, y)]; }
  const Color& at(int x, int y) const { return pixels[index(x, y)]; }
};

}  // namespace mimetra
