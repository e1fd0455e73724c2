#pragma once

#include <cstdint>
#include <string>

#include "toolkit/operations/image.h"

/// Bytes of image files to pixels, where dlib is there. Internal to image_files.h.
namespace mimetra {

/// 800 MB of pixels: an image or a video's frame with more comes from a damaged header.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28;

/// How stored pixels lie in the picture that is meant: columns and rows change places first, then
/// the order of the columns, and of the rows, is turned round.
struct Orientation {
  bool transposed = false;
  bool right_to_left = false;
  bool bottom_up = false;
  bool operator==(const Orientation&) const = default;
};

/// The picture that is meant.
Image oriented(Image stored, const Orientation& orientation);

/// What an image file says about itself.
struct ImageHeader {
  bool is_png = false;  ///< JPEG otherwise
  unsigned width = 0;
  unsigned height = 0;
  Orientation orientation = {};  ///< of the camera, which JPEGs of phones hold
};

/// Reads the header, and follows the file's parts to the end. Throws IoError where the type is
/// neither PNG nor JPEG, the file is truncated, or it holds more than can be handled. `name` is for
/// messages.
ImageHeader checked_image_header(const std::string& name, const std::string& bytes);

/// Throws IoError that says which packages are missing, where mimetra was built without dlib.
void require_dlib(const std::string& name);

/// `bytes` are whole. Throws IoError.
Image decoded_image(const std::string& name, const std::string& bytes, const ImageHeader& header);

}  // namespace mimetra
