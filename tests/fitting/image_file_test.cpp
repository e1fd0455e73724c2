#include <cmath>
#include <fstream>

#include <dlib/image_saver/save_jpeg.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fitting/image_files.h"
#include "tests/fitting/saved_image.h"
#include "tests/temporary_folder.h"
#include "tests/test_folders.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Smooth, so that JPEG keeps it.
Image gradient() {
  Image image(40, 30);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y) = {static_cast<std::uint8_t>(6 * x), static_cast<std::uint8_t>(8 * y), 90};
    }
  }
  return image;
}

template <typename Pixel, typename Make>
dlib::array2d<Pixel> pixels(Make make) {
  dlib::array2d<Pixel> result(30, 40);
  for (long y = 0; y < result.nr(); ++y) {
    for (long x = 0; x < result.nc(); ++x) result[y][x] = make(x, y);
  }
  return result;
}

class ImageFile : public testing::Test {
 protected:
  std::string write_jpeg() {
    const auto image = pixels<dlib::rgb_pixel>([](long x, long y) {
      return dlib::rgb_pixel(static_cast<unsigned char>(6 * x), static_cast<unsigned char>(8 * y),
                             90);
    });
    dlib::save_jpeg(image, path("a.jpg"), 95);
    return read_file(path("a.jpg"));
  }
  std::string write_png() {
    test::save_png(gradient(), path("a.png"));
    return read_file(path("a.png"));
  }
  void expect_no_prefix_is_read(const std::string& bytes, const std::string& name) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      write_bytes(path(name), bytes.substr(0, size));
      EXPECT_THROW(read_image(path(name)), IoError) << size << " of " << bytes.size();
    }
  }
  std::string path(const std::string& name) { return (folder_ / name).string(); }
  test::TemporaryFolder folder_;
};

TEST_F(ImageFile, OfPngComesBackAsItWasWritten) {
  write_png();
  const Image read = read_image(path("a.png"));
  EXPECT_EQ(read.width, 40);
  EXPECT_EQ(read.height, 30);
  EXPECT_EQ(read.pixels, gradient().pixels);
}

TEST_F(ImageFile, OfJpegIsReadWhateverItsName) {
  write_bytes(path("b.png"), write_jpeg());
  const Image read = read_image(path("b.png")), truth = gradient();
  ASSERT_EQ(read.width, 40);
  ASSERT_EQ(read.height, 30);
  double sum = 0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    const Color &found = read.pixels[i], &expected = truth.pixels[i];
    sum += std::abs(found.red - expected.red) + std::abs(found.green - expected.green) +
           std::abs(found.blue - expected.blue);
  }
  // Color has half the resolution: a step of 6 or 8 a pixel is off by half a step on average.
  EXPECT_LT(sum / (3.0 * double(truth.pixels.size())), 4);
}

TEST_F(ImageFile, OfGreyOrWithTransparencyIsRead) {
  dlib::save_png(pixels<unsigned char>([](long x, long) { return static_cast<unsigned char>(x); }),
                 path("grey.png"));
  EXPECT_EQ(read_image(path("grey.png")).at(7, 3), (Color{7, 7, 7}));
  dlib::save_png(pixels<dlib::rgb_alpha_pixel>(
                     [](long, long) { return dlib::rgb_alpha_pixel(10, 20, 30, 255); }),
                 path("alpha.png"));
  EXPECT_EQ(read_image(path("alpha.png")).at(7, 3), (Color{10, 20, 30}));
}

TEST_F(ImageFile, WithSixteenBitsIsRefused) {
  dlib::save_png(pixels<dlib::uint16>([](long x, long) { return dlib::uint16(1000 * x); }),
                 path("deep.png"));
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("deep.png")); }),
              AllOf(StartsWith(path("deep.png")), HasSubstr("16 bits a channel, expected 8")));
}

TEST_F(ImageFile, TruncatedAnywhereIsAnError) {
  expect_no_prefix_is_read(write_png(), "cut.png");
  expect_no_prefix_is_read(write_jpeg(), "cut.jpg");
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("cut.jpg")); }),
              AllOf(StartsWith(path("cut.jpg")), HasSubstr("truncated after")));
}

TEST_F(ImageFile, WithDamagedPixelsIsAnError) {
  std::string bytes = write_png();
  bytes[bytes.find("IDAT") + 20] ^= 0x55;
  write_bytes(path("damaged.png"), bytes);
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("damaged.png")); }),
              AllOf(StartsWith(path("damaged.png")), HasSubstr("damaged")));
}

TEST_F(ImageFile, WithAnImpossibleSizeIsAnError) {
  std::string bytes = write_png();
  bytes.replace(16, 8, "\x7f\xff\xff\xff\x7f\xff\xff\xff", 8);
  write_bytes(path("huge.png"), bytes);
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("huge.png")); }),
              HasSubstr("2147483647 x 2147483647 pixels"));
}

/// The decoder takes the first frame header, and a check of the last one would take the other.
TEST_F(ImageFile, OfJpegWithTwoSizesIsRefused) {
  std::string bytes = write_jpeg();
  const auto frame = bytes.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  const std::string header = bytes.substr(frame, 19);
  bytes.insert(frame, header).replace(frame + 5, 4, "\xff\xdc\xff\xdc");
  write_bytes(path("two.jpg"), bytes);
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("two.jpg")); }),
              AllOf(StartsWith(path("two.jpg")), HasSubstr("two frame headers")));
  const auto found = test::shared_path("data/hostile/dbl.jpg");
  if (!std::filesystem::exists(found)) return;
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(found); }),
              HasSubstr("two frame headers"));
}

TEST_F(ImageFile, OfAnotherTypeOrMissingIsAnError) {
  write_bytes(path("a.txt"), "no image");
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("a.txt")); }),
              HasSubstr("expected PNG or JPEG"));
  EXPECT_THROW(read_image(path("none.png")), IoError);
  EXPECT_THROW(read_image(folder_.path()), IoError);
}

}  // namespace
}  // namespace mimetra
