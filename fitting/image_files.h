#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/operations/image.h"

namespace mimetra {

/// Those of images that can be read, in lower case.
std::vector<std::string> image_extensions();

/// True for NAME.png, NAME.jpg and NAME.jpeg in any case.
bool is_image(const std::filesystem::path& path);

/// The images that `text` names: a PNG or JPEG file, a folder of them or a pattern, in natural
/// order (2 before 10). Throws IoError where there is none.
std::vector<std::filesystem::path> image_files(const std::string& text);

/// Reads a PNG or JPEG file of 8 bits a channel, whatever its extension, turned as the Exif data of
/// a JPEG say. Throws IoError for one
/// that is truncated, damaged or of another type, and where mimetra was built without dlib.
Image read_image(const std::filesystem::path& path);

/// A frame from each of some files.
class ImageFiles final : public ImageSequence {
 public:
  explicit ImageFiles(std::vector<std::filesystem::path> files) : files_(std::move(files)) {}

  int frames() const override { return static_cast<int>(files_.size()); }
  /// Throws as read_image.
  Image image(int frame) const override { return read_image(file(frame)); }
  std::string name(int frame) const override { return file(frame).string(); }
  /// Throws as read_image for a file that is no such image or was cut; its pixels are not decoded.
  void check() const override;

 private:
  const std::filesystem::path& file(int frame) const {
    return files_.at(static_cast<std::size_t>(frame));
  }

  std::vector<std::filesystem::path> files_;
};

/// The part of columns left .. left + width - 1 and rows top .. top + height - 1 that is inside the
/// image. Throws std::invalid_argument where nothing is.
Image cropped(const Image& image, int left, int top, int width, int height);

/// The image at another height (>= 1), its sides in proportion: each pixel is the mean of what it
/// covers. Throws std::invalid_argument for an image without pixels.
Image scaled_to_height(const Image& image, int height);

/// The images side by side, each scaled to `height` (0: that of the lowest), `gap` white columns
/// between them. Throws std::invalid_argument for no images, one without pixels, or a negative
/// height or gap.
Image strip(const std::vector<Image>& images, int height = 0, int gap = 8);

}  // namespace mimetra
