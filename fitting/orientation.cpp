#include "fitting/orientation.h"

#include <array>
#include <cstddef>

namespace mimetra {

Orientation orientation_of_exif(int number) {
  static constexpr std::array<Orientation, 9> kTurns = {{{},
                                                         {},
                                                         {false, true, false},
                                                         {false, true, true},
                                                         {false, false, true},
                                                         {true, false, false},
                                                         {true, true, false},
                                                         {true, true, true},
                                                         {true, false, true}}};
  return kTurns.at(static_cast<std::size_t>(number));
}

Image oriented(Image stored, const Orientation& orientation) {
  if (orientation == Orientation()) return stored;
  const bool transposed = orientation.transposed;
  Image image(transposed ? stored.height : stored.width, transposed ? stored.width : stored.height);
  for (int y = 0; y < image.height; ++y) {
    const int row = orientation.bottom_up ? image.height - 1 - y : y;
    for (int x = 0; x < image.width; ++x) {
      const int column = orientation.right_to_left ? image.width - 1 - x : x;
      image.at(x, y) = transposed ? stored.at(row, column) : stored.at(column, row);
    }
  }
  return image;
}

}  // namespace mimetra
