#pragma once

#include <filesystem>

#include <dlib/array2d.h>
#include <dlib/image_saver/save_png.h>

#include "toolkit/io/image.h"

namespace mimetra::test {

inline void save_png(const Image& image, const std::filesystem::path& path) {
  dlib::array2d<dlib::rgb_pixel> pixels(image.height, image.width);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Color& color = image.at(x, y);
      pixels[y][x] = dlib::rgb_pixel(color.red, color.green, color.blue);
    }
  }
  dlib::save_png(pixels, path.string());
}

}  // namespace mimetra::test
