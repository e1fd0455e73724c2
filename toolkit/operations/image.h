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

/// A picture: its pixels row after row, from the top left.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<Color> pixels;

  Image() = default;
  /// Of one colour. \pre columns >= 0, rows >= 0
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

/// What the frames of a clip show, each image read when it is asked for.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;

  virtual int frames() const = 0;
  /// Quickest frame after frame. May be called from several threads. Throws IoError;
  /// std::out_of_range for a frame that is not there.
  virtual Image image(int frame) const = 0;
  /// What messages call a frame: "a/1.png", "clip.mp4, frame 12".
  virtual std::string name(int frame) const = 0;
  /// True for frames of one recording: what one shows is near where the last one showed it.
  virtual bool is_recording() const { return false; }
  /// The file whose sound belongs to the frames, or none.
  virtual std::filesystem::path sound() const { return {}; }
  /// Throws IoError for what image() would refuse, as far as that shows without decoding.
  virtual void check() const = 0;

 protected:
  ImageSequence() = default;
  ImageSequence(const ImageSequence&) = default;
  ImageSequence& operator=(const ImageSequence&) = default;
};

/// The frames `chosen` of a sequence, in this order. Throws std::out_of_range for frames that are
/// not there.
std::shared_ptr<const ImageSequence> selected(std::shared_ptr<const ImageSequence> images,
                                              std::vector<int> chosen);

/// The axis that points up; faces look along +z, or -y where z is up.
enum class UpAxis { y, z };

/// As people choose it.
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
