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
  /// A JPEG whose camera was turned, as Exif counts it, in the order of bytes of "II" or "MM".
  void write_turned(char orientation, const std::string& order) {
    const bool little = order == "II";
    const auto number = [&](unsigned value, int size) {
      std::string bytes;
      for (int i = 0; i < size; ++i) {
        bytes += static_cast<char>(value >> (8 * (little ? i : size - 1 - i)));
      }
      return bytes;
    };
    std::string exif = std::string("Exif\0\0", 6) + order + number(42, 2) + number(8, 4) +
                       number(1, 2) + number(0x0112, 2) + number(3, 2) + number(1, 4) +
                       number(static_cast<unsigned>(orientation), 2) + number(0, 2) + number(0, 4);
    const std::string segment =
        std::string("\xff\xe1\0", 3) + static_cast<char>(exif.size() + 2) + exif;
    std::string bytes = write_jpeg();
    write_bytes(path("turned.jpg"), bytes.insert(2, segment));
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

TEST_F(ImageFile, WithSixteenBitsIsRounded) {
  dlib::save_png(pixels<dlib::uint16>([](long x, long) { return dlib::uint16(1000 * x); }),
                 path("deep.png"));
  const auto of_eight_bits = static_cast<std::uint8_t>(std::lround(7000 / 257.0));
  EXPECT_EQ(read_image(path("deep.png")).at(7, 3),
            (Color{of_eight_bits, of_eight_bits, of_eight_bits}));
}

TEST_F(ImageFile, TruncatedAnywhereIsAnError) {
  expect_no_prefix_is_read(write_png(), "cut.png");
  expect_no_prefix_is_read(write_jpeg(), "cut.jpg");
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("cut.jpg")); }),
              AllOf(StartsWith(path("cut.jpg")), HasSubstr("Premature end of JPEG file")));
}

TEST_F(ImageFile, WithDamagedPixelsIsAnError) {
  std::string bytes = write_png();
  bytes[bytes.find("IDAT") + 20] ^= 0x55;
  write_bytes(path("damaged.png"), bytes);
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("damaged.png")); }),
              AllOf(StartsWith(path("damaged.png")), HasSubstr("damaged")));
}

TEST_F(ImageFile, OfJpegWithTwoSizesIsRefused) {
  std::string bytes = write_jpeg();
  const auto frame = bytes.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  const std::string header = bytes.substr(frame, 19);
  bytes.insert(frame, header).replace(frame + 5, 4, "\xff\xdc\xff\xdc");
  write_bytes(path("two.jpg"), bytes);
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("two.jpg")); }),
              AllOf(StartsWith(path("two.jpg")), HasSubstr("two SOF markers")));
  const auto found = test::shared_path("data/hostile/dbl.jpg");
  if (!std::filesystem::exists(found)) return;
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(found); }),
              HasSubstr("65500 x 65500 pixels"));
}

TEST_F(ImageFile, OfAnotherTypeOrMissingIsAnError) {
  write_bytes(path("a.txt"), "no image");
  EXPECT_THAT(test::message_of<IoError>([&] { read_image(path("a.txt")); }),
              HasSubstr("expected PNG or JPEG"));
  EXPECT_THROW(read_image(path("none.png")), IoError);
  EXPECT_THROW(read_image(folder_.path()), IoError);
}

TEST_F(ImageFile, IsTurnedAsItsCameraWas) {
  write_jpeg();
  const Image stored = read_image(path("a.jpg"));
  const auto at = [&](double x, double y) {
    return stored.at(static_cast<int>(x * (stored.width - 1)),
                     static_cast<int>(y * (stored.height - 1)));
  };
  struct Turn {
    char number;
    bool is_upright;   ///< columns stay columns
    double left, top;  ///< where the stored image's left upper corner is seen
  };
  for (const Turn& turn :
       {Turn{1, true, 0, 0}, Turn{2, true, 1, 0}, Turn{3, true, 1, 1}, Turn{4, true, 0, 1},
        Turn{5, false, 0, 0}, Turn{6, false, 1, 0}, Turn{7, false, 1, 1}, Turn{8, false, 0, 1}}) {
    for (const char* order : {"II", "MM"}) {
      write_turned(turn.number, order);
      const Image seen = read_image(path("turned.jpg"));
      const std::string which = order + std::to_string(int{turn.number});
      ASSERT_EQ(seen.width, turn.is_upright ? stored.width : stored.height) << which;
      ASSERT_EQ(seen.height, turn.is_upright ? stored.height : stored.width) << which;
      const auto corner = [&](double x, double y) {
        return seen.at(static_cast<int>(x * (seen.width - 1)),
                       static_cast<int>(y * (seen.height - 1)));
      };
      EXPECT_EQ(corner(turn.left, turn.top), at(0, 0)) << which;
      EXPECT_EQ(corner(1 - turn.left, 1 - turn.top), at(1, 1)) << which;
      EXPECT_EQ(corner(1 - turn.left, turn.top), turn.is_upright ? at(1, 0) : at(0, 1)) << which;
    }
  }
  write_turned(9, "II");  // no turn that there is
  EXPECT_EQ(read_image(path("turned.jpg")).width, stored.width);
}

}  // namespace
}  // namespace mimetra
