#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/io/image.h"

namespace mimetra {

/// Extensions of readable images, in lower case.
std::vector<std::string> image_extensions();

/// True for NAME.png, NAME.jpg and NAME.jpeg in any case.
bool is_image(const std::filesystem::path& path);

/// Image files for `text`: a file, or the PNG and JPEG files of a folder or pattern in natural
/// order (2 before 10). Throws IoError if there are none.
std::vector<std::filesystem::path> image_files(const std::string& text);

/// Reads a PNG or JPEG file with 8 bits a channel, whatever its extension, and applies the
/// orientation in the Exif data of a JPEG. Throws IoError if the file is truncated, damaged or of
/// another type, or if mimetra was built without dlib.
Image read_image(const std::filesystem::path& path);

/// Images in files, one frame a file.
class ImageFiles final : public ImageSequence {
 public:
  explicit ImageFiles(std::vector<std::filesystem::path> files) : files_(std::move(files)) {}

  int frames() const override { return static_cast<int>(files_.size()); }
  /// Throws as read_image().
  Image image(int frame) const override { return read_image(file(frame)); }
  std::string name(int frame) const override { return file(frame).string(); }
  /// Checks all files without decoding their pixels. Throws as read_image().
  void check() const override;

 private:
  const std::filesystem::path& file(int frame) const {
    return files_.at(static_cast<std::size_t>(frame));
  }

  std::vector<std::filesystem::path> files_;
};

/// Part of the image in columns left .. left + width - 1 and rows top .. top + height - 1, clipped
/// to the image. Throws std::invalid_argument if nothing is left.
Image cropped(const Image& image, int left, int top, int width, int height);

/// Scales the image to a height (>= 1) and keeps its proportions. Each pixel is the mean of the
/// pixels that it covers. Throws std::invalid_argument for an image without pixels.
Image scaled_to_height(const Image& image, int height);

/// Puts images side by side, with `gap` white columns between them. Each is scaled to `height`, and
/// 0 means the height of the lowest image. Throws std::invalid_argument if there are no images, an
/// image has no pixels, or height or gap is negative.
Image strip(const std::vector<Image>& images, int height = 0, int gap = 8);

}  // namespace mimetra
