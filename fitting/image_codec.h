#pragma once

#include <cstdint>
#include <string>

#include "toolkit/operations/image.h"

/// Decoding of image files, with dlib if it is available. Internal to image_files.h.
namespace mimetra {

/// Limit of 800 MB of pixels. An image or video frame beyond it has a damaged header.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

/// Orientation of the stored pixels. To get the picture, swap columns and rows, then reverse the
/// order of columns, then of rows.
struct Orientation {
  bool transposed = false;
  bool right_to_left = false;
  bool bottom_up = false;
  bool operator==(const Orientation&) const = default;
};

/// Applies the orientation to the stored pixels.
Image oriented(Image stored, const Orientation& orientation);

/// Header of an image file.
struct ImageHeader {
  bool is_png = false;  ///< otherwise JPEG
  unsigned width = 0;
  unsigned height = 0;
  Orientation orientation = {};  ///< from Exif data, as phones write it
};

/// Reads the header and follows the parts of the file to its end. `name` is for messages. Throws
/// IoError if the file is neither PNG nor JPEG, is truncated, or exceeds kMostPixels.
ImageHeader checked_image_header(const std::string& name, const std::string& bytes);

/// Throws IoError that names the missing packages if mimetra was built without dlib.
void require_dlib(const std::string& name);

/// Decodes an image. Throws IoError. \pre `bytes` passed checked_image_header()
Image decoded_image(const std::string& name, const std::string& bytes, const ImageHeader& header);

}  // namespace mimetra
