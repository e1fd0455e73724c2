#include <stdexcept>

#include <gtest/gtest.h>

#include "fitting/image_files.h"

namespace mimetra {
namespace {

constexpr Color kWhite = {255, 255, 255};

/// Red counts columns, green rows.
Image chart(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 7};
    }
  }
  return image;
}

TEST(Image, IsCroppedToWhatIsInside) {
  const Image part = cropped(chart(10, 8), 7, -2, 100, 5);
  EXPECT_EQ(part.width, 3);
  EXPECT_EQ(part.height, 3);
  EXPECT_EQ(part.at(0, 0), (Color{7, 0, 7}));
  EXPECT_EQ(part.at(2, 2), (Color{9, 2, 7}));
  EXPECT_THROW(cropped(chart(10, 8), 10, 0, 5, 5), std::invalid_argument);
  EXPECT_THROW(cropped(chart(10, 8), 0, 0, -5, 5), std::invalid_argument);
}

TEST(Image, TakesTheMeanOfWhatASmallerOneCovers) {
  const Image half = scaled_to_height(chart(8, 4), 2);
  EXPECT_EQ(half.width, 4);
  EXPECT_EQ(half.at(1, 1), (Color{3, 3, 7}));  // of 2, 3 and of 2, 3, rounded
  const Image same = scaled_to_height(chart(8, 4), 4);
  EXPECT_EQ(same.pixels, chart(8, 4).pixels);
}

TEST(Image, RepeatsPixelsInALargerOne) {
  const Image doubled = scaled_to_height(chart(3, 2), 4);
  EXPECT_EQ(doubled.width, 6);
  EXPECT_EQ(doubled.at(5, 3), (Color{2, 1, 7}));
  EXPECT_EQ(doubled.at(4, 2), (Color{2, 1, 7}));
}

TEST(Image, StandsInAStripAsHighAsTheLowest) {
  const Image joined = strip({chart(8, 4), chart(3, 2)}, 0, 5);
  EXPECT_EQ(joined.height, 2);
  EXPECT_EQ(joined.width, 4 + 5 + 3);
  EXPECT_EQ(joined.at(4, 0), kWhite);
  EXPECT_EQ(joined.at(8, 1), kWhite);
  EXPECT_EQ(joined.at(9, 0), (Color{0, 0, 7}));
  EXPECT_EQ(strip({chart(8, 4)}, 1).height, 1);
}

TEST(Image, IsNeededForAStrip) {
  EXPECT_THROW(strip({}), std::invalid_argument);
  EXPECT_THROW(strip({Image()}), std::invalid_argument);
  EXPECT_THROW(strip({chart(2, 2)}, -1), std::invalid_argument);
  EXPECT_THROW(strip({chart(2, 2)}, 0, -1), std::invalid_argument);
  EXPECT_THROW(scaled_to_height(chart(2, 2), 0), std::invalid_argument);
}

}  // namespace
}  // namespace mimetra
