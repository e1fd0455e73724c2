#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include <Eigen/Core>

/// Pixels of image files, by the libraries of their formats. For readers.
namespace mimetra {

/// How bright pixels are, and how opaque. Of colours only that is kept: of large textures they
/// would be a gigabyte.
class Pixels {
 public:
  /// height x width, from the top left.
  using Plane = Eigen::Matrix<std::uint16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Without `has_opacity` all pixels are opaque.
  Pixels(std::uint64_t width, std::uint64_t height, bool has_opacity);

  /// Each pixel once, the first of the picture first: its red, green, blue and opacity.
  void set(Eigen::Index row, Eigen::Index column, const std::uint16_t* rgba);

  /// Of the colours, the luma.
  const Plane& luma() const { return luma_; }
  /// Empty where all are opaque.
  const Plane& opacity() const { return opacity_; }
  bool colors_differ() const { return colors_differ_; }
  bool opacities_differ() const { return opacities_differ_; }
  /// Without a copy, which leaves none behind.
  Plane take_luma() { return std::move(luma_); }
  Plane take_opacity() { return std::move(opacity_); }
  /// True where some are not grey.
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

/// More pixels come from a damaged header: textures have 8192 x 8192 at most.
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 26;

/// Both throw IoError for what is truncated, damaged, or has more than kMostPixels; they ask for
/// memory only where the file is long enough to fill it.
Pixels pixels_of_png(const std::string& path, const std::string& bytes);
Pixels pixels_of_jpeg(const std::string& path, const std::string& bytes);

}  // namespace mimetra
