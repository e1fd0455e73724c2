#pragma once

#include "toolkit/io/image.h"

/// Turns of pictures as cameras store them. Internal to image_files.h and video_file.h.
namespace mimetra {

/// Orientation of the stored pixels. To get the picture, swap columns and rows, then reverse the
/// order of columns, then of rows.
struct Orientation {
  bool transposed = false;
  bool right_to_left = false;
  bool bottom_up = false;
  bool operator==(const Orientation&) const = default;
};

/// Orientation for Exif's numbers 1 to 8.
Orientation orientation_of_exif(int number);

/// Applies the orientation to the stored pixels.
Image oriented(Image stored, const Orientation& orientation);

}  // namespace mimetra
