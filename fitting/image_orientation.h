#pragma once

#include "toolkit/operations/image.h"

namespace mimetra {

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

}  // namespace mimetra
