#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace mimetra {

/// An sRGB colour.
struct Color {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  bool operator==(const Color&) const = default;
};

/// A picture, with pixels row by row from the top left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Color> pixels;

  Image() = default;
  /// Makes an image of one colour. \pre columns >= 0, rows >= 0
  Image(int columns, int rows, const Color& color = {})
      : width(columns),
        height(rows),
        pixels(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), color) {}

  bool contains(int x, int y) const { return x >= 0 && x < width && y >= 0 && y < height; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  /// \pre contains(x, y)
  Color& at(int x, int y) { return pixels[index(x, y)]; }
  const Color& at(int x, int y) const { return pixels[index(x, y)]; }
};

/// Images of the frames of a clip, each read on demand.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;

  virtual int frames() const = 0;
  /// Reads a frame; consecutive frames are fastest. Safe to call from several threads. Throws
  /// IoError, and std::out_of_range for a frame that does not exist.
  virtual Image image(int frame) const = 0;
  /// Name of a frame in messages: "a/1.png", "clip.mp4, frame 12".
  virtual std::string name(int frame) const = 0;
  /// True for frames of one recording: things are near their place in the previous frame.
  virtual bool is_recording() const { return false; }
  /// File with the sound of the frames, or empty.
  virtual std::filesystem::path sound() const { return {}; }
  /// Throws IoError for images that image() would refuse, as far as this shows without decoding.
  virtual void check() const = 0;

 protected:
  ImageSequence() = default;
  ImageSequence(const ImageSequence&) = default;
  ImageSequence& operator=(const ImageSequence&) = default;
};

/// Returns the frames `chosen` of a sequence, in this order. Throws std::out_of_range for frames
/// that do not exist.
std::shared_ptr<const ImageSequence> selected(std::shared_ptr<const ImageSequence> images,
                                              std::vector<int> chosen);

/// The axis that points up. Faces look along +z, or along -y if z points up.
enum class UpAxis { y, z };

constexpr std::string_view choice_name(UpAxis value) {
  switch (value) {
    case UpAxis::y:
      return "y";
    case UpAxis::z:
      return "z";
  }
  return {};
}

}  // namespace mimetra
