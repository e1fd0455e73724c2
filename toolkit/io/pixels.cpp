#include "toolkit/io/pixels.h"

#include <algorithm>

#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// Weights of Rec. 601 in thousandths. Grey stays what it is, bit by bit.
std::uint16_t luma_of(const std::uint16_t* rgb) {
  return static_cast<std::uint16_t>((299U * rgb[0] + 587U * rgb[1] + 114U * rgb[2] + 500U) / 1000U);
}

/// Above it channels differ by more than compression makes of grey.
constexpr int kColored = 65535 / 16;

}  // namespace

Pixels::Pixels(std::uint64_t width, std::uint64_t height, bool has_opacity)
    : luma_(height, width), opacity_(has_opacity ? height : 0, has_opacity ? width : 0) {}

void Pixels::set(Eigen::Index row, Eigen::Index column, const std::uint16_t* rgba) {
  luma_(row, column) = luma_of(rgba);
  if (opacity_.size() > 0) opacity_(row, column) = rgba[3];
  if (!has_first_) std::copy_n(rgba, 4, first_.begin());
  has_first_ = true;
  colors_differ_ = colors_differ_ || !std::equal(rgba, rgba + 3, first_.begin());
  opacities_differ_ = opacities_differ_ || rgba[3] != first_[3];
  const auto [least, most] = std::minmax({rgba[0], rgba[1], rgba[2]});
  is_colored_ = is_colored_ || most - least > kColored;
}

void check_pixel_count(const std::string& path, std::uint64_t width, std::uint64_t height,
                       std::uint64_t bytes, std::uint64_t most_per_byte) {
  if (width * height > kMostPixels) {
    throw IoError(path, "says it has " + std::to_string(width) + " x " + std::to_string(height) +
                            " pixels, and " + std::to_string(kMostPixels) +
                            " can be read; make it smaller, or is it damaged?");
  }
  if (width * height / most_per_byte <= bytes) return;
  throw IoError(path, "the image is truncated after " + std::to_string(bytes) +
                          " bytes; copy or export it again");
}

}  // namespace mimetra
