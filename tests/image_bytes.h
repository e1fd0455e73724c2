#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <jpeglib.h>
#include <png.h>

/// Image files, made by the libraries of their formats.
namespace mimetra::test {

/// A PNG file of some format of libpng's: PNG_FORMAT_GRAY, PNG_FORMAT_RGBA, PNG_FORMAT_LINEAR_Y
/// (std::uint16_t), ...; `values` are row after row from the top left, all channels of a pixel side
/// by side. With a palette of RGB they are its indices.
template <typename Value>
std::string png_bytes(int width, int height, std::uint32_t format, const std::vector<Value>& values,
                      const std::vector<std::uint8_t>& palette = {}) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = format;
  image.colormap_entries = static_cast<png_uint_32>(palette.size() / 3);
  const void* const colors = palette.empty() ? nullptr : palette.data();
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&image, nullptr, &size, 0, values.data(), 0, colors);
  std::string bytes(size, '\0');
  png_image_write_to_memory(&image, bytes.data(), &size, 0, values.data(), 0, colors);
  return bytes;
}

/// A grey JPEG file of the best quality; in scans of its own each is a bit of one frequency.
inline std::string jpeg_bytes(int width, int height, std::vector<std::uint8_t> grey,
                              bool in_scans = false) {
  jpeg_compress_struct state = {};
  jpeg_error_mgr errors = {};
  state.err = jpeg_std_error(&errors);
  jpeg_create_compress(&state);
  unsigned char* made = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&state, &made, &size);
  state.image_width = static_cast<JDIMENSION>(width);
  state.image_height = static_cast<JDIMENSION>(height);
  state.input_components = 1;
  state.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&state);
  jpeg_set_quality(&state, 100, TRUE);
  std::vector<jpeg_scan_info> scans = {{1, {0}, 0, 0, 0, 0}};
  for (int frequency = 1; frequency < DCTSIZE2; ++frequency) {
    scans.push_back({1, {0}, frequency, frequency, 0, 1});
    scans.push_back({1, {0}, frequency, frequency, 1, 0});
  }
  if (in_scans) {
    state.scan_info = scans.data();
    state.num_scans = static_cast<int>(scans.size());
  }
  jpeg_start_compress(&state, TRUE);
  for (int y = 0; y < height; ++y) {
    JSAMPROW row = grey.data() + static_cast<std::ptrdiff_t>(y) * width;
    jpeg_write_scanlines(&state, &row, 1);
  }
  jpeg_finish_compress(&state);
  std::string bytes(reinterpret_cast<const char*>(made), size);
  jpeg_destroy_compress(&state);
  std::free(made);
  return bytes;
}

}  // namespace mimetra::test
