#include "toolkit/io/painting_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <zlib.h>

#include "tests/image_bytes.h"
#include "tests/temporary_folder.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using test::png_bytes;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

using Bytes = std::vector<std::uint8_t>;

class BrightnessTest : public testing::Test {
 protected:
  Brightness read(const std::string& bytes, const std::string& name = "image.png") const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return read_brightness(path);
  }
  static std::vector<int> pixels_of(const Brightness& brightness) {
    const auto values = brightness.pixels.reshaped<Eigen::RowMajor>();
    return {values.begin(), values.end()};
  }

  const test::TemporaryFolder folder_;
};

TEST_F(BrightnessTest, OfGreyIsItsValueRowByRowFromTheTop) {
  const Brightness read =
      this->read(png_bytes(3, 2, PNG_FORMAT_GRAY, Bytes{0, 1, 2, 51, 254, 255}));
  EXPECT_EQ(read.pixels.rows(), 2);
  EXPECT_THAT(pixels_of(read),
              ElementsAre(0, 257, 2 * 257, 51 * 257, 254 * 257, Brightness::kWhite));
  EXPECT_THAT(read.notes, IsEmpty());
  EXPECT_EQ(read.at(1.0 / 6, 0.25), 51 / 255.0);
}

TEST_F(BrightnessTest, KeepsAllOf16Bits) {
  const std::vector<std::uint16_t> values = {0, 1, 32768, 65535};
  EXPECT_THAT(pixels_of(read(png_bytes(2, 2, PNG_FORMAT_LINEAR_Y, values))),
              ElementsAre(0, 1, 32768, 65535));
}

TEST_F(BrightnessTest, OfColoursIsTheirLumaAndIsNoted) {
  const Brightness read = this->read(
      png_bytes(4, 1, PNG_FORMAT_RGB, Bytes{255, 0, 0, 0, 255, 0, 0, 0, 255, 70, 70, 70}));
  EXPECT_THAT(pixels_of(read), ElementsAre(19595, 38469, 7471, 70 * 257));
  EXPECT_THAT(read.notes, ElementsAre(HasSubstr("is coloured")));
}

TEST_F(BrightnessTest, OfAPaletteIsThatOfItsColours) {
  const Bytes palette = {0, 0, 0, 90, 90, 90, 255, 255, 255};
  EXPECT_THAT(pixels_of(read(png_bytes(3, 1, PNG_FORMAT_RGB_COLORMAP, Bytes{2, 0, 1}, palette))),
              ElementsAre(65535, 0, 90 * 257));
}

TEST_F(BrightnessTest, OfTransparentPixelsIsAsIfTheyLayOnBlack) {
  // What is not painted may have any colour: opaque grey on transparent white.
  const Brightness drawn = read(png_bytes(3, 1, PNG_FORMAT_GA, Bytes{51, 255, 255, 0, 255, 102}));
  EXPECT_THAT(pixels_of(drawn), ElementsAre(51 * 257, 0, 102 * 257));
  EXPECT_THAT(drawn.notes, ElementsAre(HasSubstr("transparent in places")));
  const Brightness veiled = read(png_bytes(2, 1, PNG_FORMAT_GA, Bytes{0, 102, 255, 102}));
  EXPECT_THAT(pixels_of(veiled), ElementsAre(0, 102 * 257));
}

TEST_F(BrightnessTest, IsTheOpacityWhereNothingElseDiffers) {
  const Brightness stencil = read(png_bytes(2, 1, PNG_FORMAT_RGBA, Bytes{9, 9, 9, 0, 9, 9, 9, 51}));
  EXPECT_THAT(pixels_of(stencil), ElementsAre(0, 51 * 257));
  EXPECT_THAT(stencil.notes, ElementsAre(HasSubstr("its opacity is taken")));
}

/// The bits of an interlaced picture: the rows of each of the seven passes, packed by zlib.
std::string interlaced(int width, int height, const Bytes& grey) {
  std::string made;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &made,
      [](png_structp state, png_bytep data, std::size_t size) {
        static_cast<std::string*>(png_get_io_ptr(state))
            ->append(reinterpret_cast<const char*>(data), size);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_ADAM7, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  Bytes copy = grey;
  std::vector<png_bytep> rows;
  rows.reserve(static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) rows.push_back(copy.data() + y * width);
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return made;
}

TEST_F(BrightnessTest, OfAnInterlacedPictureIsThatOfTheSameRows) {
  for (const auto& [width, height] : std::vector<std::pair<int, int>>{{1, 1}, {3, 2}, {11, 19}}) {
    Bytes grey;
    for (int i = 0; i < width * height; ++i) grey.push_back(static_cast<std::uint8_t>(i));
    EXPECT_EQ(read(interlaced(width, height, grey)).pixels,
              read(png_bytes(width, height, PNG_FORMAT_GRAY, grey)).pixels)
        << width;
  }
}

TEST_F(BrightnessTest, OfAJpegIsNearWhatWasCompressed) {
  Bytes grey;
  for (int i = 0; i < 16 * 8; ++i) grey.push_back(static_cast<std::uint8_t>(i % 16 * 17));
  const Brightness read = this->read(test::jpeg_bytes(16, 8, grey), "image.jpg");
  ASSERT_EQ(read.pixels.cols(), 16);
  for (int x = 0; x < 16; ++x) EXPECT_NEAR(read.pixels(3, x), 257 * 17 * x, 2 * 257) << x;
  EXPECT_THAT(read.notes, IsEmpty());
}

TEST_F(BrightnessTest, IsLinearBetweenTheCentresOfPixels) {
  Bytes ramp;
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 8; ++x) ramp.push_back(static_cast<std::uint8_t>(10 + 20 * x + 5 * y));
  }
  const Brightness read = this->read(png_bytes(8, 5, PNG_FORMAT_GRAY, ramp));
  for (double u = 0.0625; u <= 0.9375; u += 0.01) {
    for (double v = 0.1; v <= 0.9; v += 0.07) {
      const double expected = 10 + 20 * (8 * u - 0.5) + 5 * (5 * (1 - v) - 0.5);
      EXPECT_NEAR(read.at(u, v), expected / 255, 1e-14) << u << ' ' << v;
    }
  }
}

TEST_F(BrightnessTest, EndsAtItsEdgesAndIsRepeatedBeyond) {
  const Brightness read = this->read(png_bytes(2, 2, PNG_FORMAT_GRAY, Bytes{0, 255, 51, 102}));
  EXPECT_EQ(read.at(0, 1), 0);
  EXPECT_EQ(read.at(1, 1), 1);
  EXPECT_EQ(read.at(0, 0), 0.2);
  EXPECT_EQ(read.at(1, 0), 0.4);
  for (const double u : {0.125, 0.5, 0.875}) {
    for (const double v : {0.125, 0.25, 0.75}) {
      EXPECT_EQ(read.at(u + 3, v), read.at(u, v));
      EXPECT_EQ(read.at(u - 1, v - 2), read.at(u, v));
      EXPECT_EQ(read.at(u, v + 1), read.at(u, v));
    }
  }
}

TEST_F(BrightnessTest, TakesTheEdgeForCoordinatesThatAreRounded) {
  const Brightness read = this->read(png_bytes(2, 2, PNG_FORMAT_GRAY, Bytes{0, 255, 51, 102}));
  for (const double rounding : {1e-12, 1e-6, 0.9e-4}) {
    EXPECT_EQ(read.at(1 + rounding, 1 + rounding), read.at(1, 1));
    EXPECT_EQ(read.at(-rounding, -rounding), read.at(0, 0));
    EXPECT_FALSE(Brightness::is_beyond(1 + rounding, -rounding));
  }
  EXPECT_TRUE(Brightness::is_beyond(1.001, 0.5));
  EXPECT_TRUE(Brightness::is_beyond(0.5, -0.001));
}

TEST_F(BrightnessTest, IsRefusedForWhatIsNoImage) {
  EXPECT_THAT([&] { read("v 0 0 0\n"); },
              ThrowsMessage<IoError>(HasSubstr("image.png: is no image that can be read")));
  EXPECT_THAT([&] { read(""); }, ThrowsMessage<IoError>(HasSubstr("expected PNG or JPEG")));
}

TEST_F(BrightnessTest, IsRefusedForEveryTruncatedPrefix) {
  const std::string png = png_bytes(5, 4, PNG_FORMAT_GRAY, Bytes(20, 7));
  for (std::size_t size = 0; size < png.size(); ++size) {
    EXPECT_THROW(read(png.substr(0, size)), IoError) << size;
  }
  const std::string jpeg = test::jpeg_bytes(16, 8, Bytes(16 * 8, 90));
  for (std::size_t size = 0; size < jpeg.size(); ++size) {
    EXPECT_THROW(read(jpeg.substr(0, size)), IoError) << size;
  }
}

TEST_F(BrightnessTest, IsRefusedForDamagedPixels) {
  std::string png = png_bytes(5, 4, PNG_FORMAT_GRAY, Bytes(20, 7));
  png[png.find("IDAT") + 8] ^= 0x55;
  EXPECT_THAT([&] { read(png); }, ThrowsMessage<IoError>(HasSubstr("is a damaged PNG file")));
}

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
  return bytes;
}

/// The sum that ends a chunk, of its name and content.
std::string checksum(const std::string& chunk) {
  return big_endian(static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const unsigned char*>(chunk.data()), uInt(chunk.size()))));
}

/// A picture with one more chunk before its pixels.
std::string with_chunk(std::string png, const std::string& name, const std::string& content) {
  return png.insert(png.find("IDAT") - 4, big_endian(static_cast<std::uint32_t>(content.size())) +
                                              name + content + checksum(name + content));
}

TEST_F(BrightnessTest, IsThatOfPixelsWhateverElseThePictureHolds) {
  std::string png = png_bytes(2, 1, PNG_FORMAT_GRAY, Bytes{51, 255});
  png = with_chunk(png, "tEXt", "Comment" + std::string(9 << 20, '\0'));
  // That this text cannot be unpacked shows that none is: it could be a thousand times as long.
  png = with_chunk(png, "zTXt", "Comment" + std::string(2, '\0') + "not packed");
  EXPECT_THAT(pixels_of(read(png)), ElementsAre(51 * 257, 65535));
}

TEST_F(BrightnessTest, IsRefusedForDamagedOpacity) {
  const Bytes palette = {0, 0, 0, 90, 90, 90, 255, 255, 255};
  const std::string opaque = png_bytes(3, 1, PNG_FORMAT_RGB_COLORMAP, Bytes{2, 0, 1}, palette);
  const std::string clear = with_chunk(opaque, "tRNS", std::string("\xff\x33\0", 3));
  EXPECT_THAT(pixels_of(read(clear)), ElementsAre(0, 0, 90 * 257 / 5));
  std::string damaged = clear;
  damaged[damaged.find("tRNS") + 4] ^= 1;
  EXPECT_THAT([&] { read(damaged); },
              ThrowsMessage<IoError>(HasSubstr("is a damaged PNG file (tRNS: CRC error)")));
  EXPECT_THAT([&] { read(with_chunk(opaque, "tRNS", "1234")); },
              ThrowsMessage<IoError>(HasSubstr("is a damaged PNG file (tRNS: ")));
}

TEST_F(BrightnessTest, IsRefusedForAPictureOfMoreScansThanEncodersMake) {
  const Bytes grey(16 * 8, 90);
  EXPECT_THAT([&] { read(test::jpeg_bytes(16, 8, grey, true)); },
              ThrowsMessage<IoError>(HasSubstr("more than 100 scans")));
}

TEST_F(BrightnessTest, IsRefusedForSizesThatCannotBe) {
  std::string png = png_bytes(5, 4, PNG_FORMAT_GRAY, Bytes(20, 7));
  // Width and height, and the checksum of the header, which libpng looks at before the size.
  const auto resize = [&png](const std::string& width_and_height) {
    png.replace(16, 8, width_and_height);
    png.replace(29, 4, checksum(png.substr(12, 17)));
  };
  resize(std::string("\0\x01\0\0\0\x01\0\0", 8));
  EXPECT_THAT([&] { read(png); }, ThrowsMessage<IoError>(HasSubstr("65536 x 65536 pixels")));
  resize(std::string("\0\0\x40\0\0\0\x40\1", 8));
  EXPECT_THAT([&] { read(png); }, ThrowsMessage<IoError>(HasSubstr("16384 x 16385 pixels")));
  // 4096 x 4096 could be, but not of so few bytes.
  resize(std::string("\0\0\x10\0\0\0\x10\0", 8));
  EXPECT_THAT([&] { read(png); }, ThrowsMessage<IoError>(HasSubstr("truncated")));
  std::string jpeg = test::jpeg_bytes(16, 8, Bytes(16 * 8, 90));
  // Height and width of the frame's header.
  jpeg.replace(jpeg.find("\xff\xc0") + 5, 4, std::string("\x20\0\x20\0", 4));
  EXPECT_THAT([&] { read(jpeg, "image.jpg"); },
              ThrowsMessage<IoError>(HasSubstr("image.jpg: the image is truncated")));
}

}  // namespace
}  // namespace mimetra
