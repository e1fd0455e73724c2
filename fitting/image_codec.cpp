#include "fitting/image_codec.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "toolkit/mesh/errors.h"

namespace mimetra {

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

namespace {

constexpr std::string_view kPngStart = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kJpegStart = "\xff\xd8";

/// Reads big-endian numbers of a file up to its end.
class ByteReader {
 public:
  ByteReader(const std::string& name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  std::size_t left() const { return bytes_.size() - at_; }
  void skip(std::uint64_t count) {
    if (count > left()) fail_truncated();
    at_ += static_cast<std::size_t>(count);
  }
  std::uint32_t number(int size) {
    std::uint32_t value = 0;
    for (int i = 0; i < size; ++i) value = value << 8 | byte();
    return value;
  }
  std::uint8_t byte() {
    if (left() == 0) fail_truncated();
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }
  std::string_view text(std::size_t size) {
    const std::size_t begin = at_;
    skip(size);
    return bytes_.substr(begin, size);
  }
  [[noreturn]] void fail_truncated() const {
    throw IoError(name_, "the image is truncated after " + std::to_string(bytes_.size()) +
                             " bytes; copy or export it again");
  }

 private:
  const std::string& name_;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// Follows the chunks: length, type, content, checksum. The decoder checks the content.
ImageHeader png_header(const std::string& name, ByteReader bytes) {
  bytes.skip(kPngStart.size() +
             8);  // signature, and length and type of the first chunk, the header
  ImageHeader header{.is_png = true, .width = bytes.number(4), .height = bytes.number(4)};
  const int bits = bytes.byte();
  if (bits > 8) {
    throw IoError(name, "has " + std::to_string(bits) +
                            " bits a channel, expected 8; convert it, as with 'ffmpeg -i IN "
                            "-pix_fmt rgb24 OUT.png'");
  }
  bytes.skip(4 + 4);  // rest of the header's content, and its checksum
  while (true) {
    const std::uint32_t length = bytes.number(4);
    const bool last = bytes.text(4) == "IEND";
    bytes.skip(std::uint64_t{length} + 4);
    if (last) return header;
  }
}

bool is_restart(std::uint8_t marker) {
  return marker >= 0xd0 && marker <= 0xd7;
}

/// True for a segment that begins with the image's size.
bool is_frame_header(std::uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

/// Next marker. Skips compressed pixels, which contain 0xff 0x00 for the byte 0xff.
std::uint8_t next_marker(ByteReader& bytes) {
  while (true) {
    while (bytes.byte() != 0xff) continue;
    std::uint8_t marker = 0xff;
    while (marker == 0xff) marker = bytes.byte();
    if (marker != 0 && !is_restart(marker)) return marker;
  }
}

/// Orientation for Exif's numbers 1 to 8.
Orientation exif_orientation(unsigned number) {
  switch (number) {
    case 2:
      return {false, true, false};
    case 3:
      return {false, true, true};
    case 4:
      return {false, false, true};
    case 5:
      return {true, false, false};
    case 6:
      return {true, true, false};
    case 7:
      return {true, true, true};
    case 8:
      return {true, false, true};
    default:
      return {};
  }
}

/// Orientation in the first list of Exif data, or the default if the data is damaged.
///
/// [CIPA DC-008, Exchangeable image file format for digital still cameras, 2.3], 4.5 and 4.6.4
Orientation orientation_of_exif(std::string_view data) {
  constexpr std::string_view kStart("Exif\0\0", 6);
  constexpr unsigned kOrientation = 0x0112;
  if (!data.starts_with(kStart)) return {};
  data.remove_prefix(kStart.size());
  const bool little = data.starts_with("II");
  const auto number = [&](std::size_t at, std::size_t size) -> std::uint64_t {
    std::uint64_t value = 0;
    if (at > data.size() || size > data.size() - at) return value;
    for (std::size_t i = 0; i < size; ++i) {
      const auto byte = static_cast<unsigned char>(data[at + (little ? size - 1 - i : i)]);
      value = value << 8 | byte;
    }
    return value;
  };
  const std::size_t list = number(4, 4), entries = number(list, 2);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t entry = list + 2 + 12 * i;
    if (number(entry, 2) == kOrientation) {
      return exif_orientation(static_cast<unsigned>(number(entry + 8, 2)));
    }
  }
  return {};
}

/// Follows the segments to the end, because the decoder fills missing pixels with grey.
ImageHeader jpeg_header(const std::string& name, ByteReader bytes) {
  constexpr std::uint8_t kEnd = 0xd9, kExif = 0xe1;
  ImageHeader header;
  bytes.skip(kJpegStart.size());
  while (true) {
    const std::uint8_t marker = next_marker(bytes);
    if (marker == kEnd) return header;
    const std::uint32_t length = bytes.number(2);
    if (length < 2) bytes.fail_truncated();
    ByteReader content = bytes;
    bytes.skip(length - 2);
    if (marker == kExif) {
      const std::string_view data = content.text(length - 2);
      if (data.starts_with("Exif")) header.orientation = orientation_of_exif(data);
    }
    if (is_frame_header(marker)) {
      // The decoder uses the first frame header, so the limit on pixels must apply to it.
      if (header.width != 0 || header.height != 0) {
        throw IoError(name, "holds two frame headers, expected one; save the image again");
      }
      content.skip(1);  // bits a channel
      header.height = content.number(2);
      header.width = content.number(2);
    }
  }
}

}  // namespace

ImageHeader checked_image_header(const std::string& name, const std::string& bytes) {
  const std::string_view view = bytes;
  const bool is_png = view.starts_with(kPngStart);
  if (!is_png && !view.starts_with(kJpegStart)) {
    throw IoError(name, "is no image that can be read; expected PNG or JPEG");
  }
  const ByteReader reader(name, view);
  const ImageHeader header = is_png ? png_header(name, reader) : jpeg_header(name, reader);
  const std::uint64_t pixels = std::uint64_t{header.width} * header.height;
  if (pixels == 0 || pixels > kMostPixels) {
    throw IoError(name, "says it has " + std::to_string(header.width) + " x " +
                            std::to_string(header.height) + " pixels, expected 1 to " +
                            std::to_string(kMostPixels) + " in all");
  }
  return header;
}

}  // namespace mimetra
