#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include <Eigen/Core>

/// Decoders of image files.
namespace mimetra {

/// Brightness and opacity of pixels. Colours are not kept, since large textures would need a
/// gigabyte.
class Pixels {
 public:
  /// height x width, from the top left.
  using Plane = Eigen::Matrix<std::uint16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Without `has_opacity`, all pixels are opaque.
  Pixels(std::uint64_t width, std::uint64_t height, bool has_opacity);

  /// Sets red, green, blue and opacity of a pixel. Each pixel must be set once, and the picture's
  /// first pixel first.
  void set(Eigen::Index row, Eigen::Index column, const std::uint16_t* rgba);

  const Plane& luma() const { return luma_; }
  /// Opacity; empty if the file has none.
  const Plane& opacity() const { return opacity_; }
  bool colors_differ() const { return colors_differ_; }
  bool opacities_differ() const { return opacities_differ_; }
  /// Move the planes out of this object.
  Plane take_luma() { return std::move(luma_); }
  Plane take_opacity() { return std::move(opacity_); }
  /// True if some pixels are not grey.
  bool is_colored() const { return is_colored_; }

 private:
  Plane luma_;
  Plane opacity_;
  std::array<std::uint16_t, 4> first_ = {};
  bool has_first_ = false;
  bool colors_differ_ = false;
  bool opacities_differ_ = false;
  bool is_colored_ = false;
};

/// Limit that only damaged headers exceed: textures have at most 8192 x 8192 pixels.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;

/// Decode an image. Throw IoError if it is truncated, damaged, or has more than kMostPixels. Memory
/// is allocated only if the file is long enough for its pixels.
Pixels pixels_of_png(const std::string& path, const std::string& bytes);
Pixels pixels_of_jpeg(const std::string& path, const std::string& bytes);

}  // namespace mimetra
