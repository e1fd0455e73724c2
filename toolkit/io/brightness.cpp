#include "toolkit/io/brightness.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "toolkit/io/pixels.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

constexpr std::string_view kPngStart = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kJpegStart = "\xff\xd8";

Pixels pixels_of(const std::string& path, const std::string& bytes) {
  if (bytes.starts_with(kPngStart)) return pixels_of_png(path, bytes);
  if (bytes.starts_with(kJpegStart)) return pixels_of_jpeg(path, bytes);
  throw IoError(path, "is no image that can be read; expected PNG or JPEG");
}

/// Exact where it is opaque.
std::uint16_t over_black(std::uint32_t value, std::uint32_t opacity) {
  constexpr std::uint32_t kOpaque = 65535;
  return static_cast<std::uint16_t>((value * opacity + kOpaque / 2) / kOpaque);
}

/// The pixel at or before a place, and how far it is to the next one.
struct Between {
  Eigen::Index first;
  Eigen::Index second;
  double share;
};

bool is_within(double place) {
  return place >= -Brightness::kRounding && place <= 1 + Brightness::kRounding;
}

/// A place of the texture as one of the picture, in [0, 1].
double in_picture(double place) {
  return is_within(place) ? std::clamp(place, 0.0, 1.0) : place - std::floor(place);
}

Between pixels_around(double place, Eigen::Index count) {
  const double last = static_cast<double>(count) - 1;
  const double from_center = std::clamp(place * static_cast<double>(count) - 0.5, 0.0, last);
  const double whole = std::floor(from_center);
  const auto first = static_cast<Eigen::Index>(whole);
  return {first, std::min(first + 1, count - 1), from_center - whole};
}

}  // namespace

bool Brightness::is_beyond(double u, double v) {
  return !is_within(u) || !is_within(v);
}

double Brightness::at(double u, double v) const {
  const Between x = pixels_around(in_picture(u), pixels.cols());
  const Between y = pixels_around(1 - in_picture(v), pixels.rows());
  const auto in_row = [&](Eigen::Index row) {
    const double left = pixels(row, x.first), right = pixels(row, x.second);
    return left + x.share * (right - left);
  };
  const double upper = in_row(y.first), lower = in_row(y.second);
  return (upper + y.share * (lower - upper)) / kWhite;
}

Brightness read_brightness(const std::filesystem::path& path) {
  const std::string name = path.string();
  Pixels pixels = pixels_of(name, read_file(path));
  const bool by_opacity = pixels.opacities_differ() && !pixels.colors_differ();
  Brightness brightness{by_opacity ? pixels.take_opacity() : pixels.take_luma()};
  if (by_opacity) {
    brightness.notes.push_back(name + ": all of it has one colour; its opacity is taken");
    return brightness;
  }
  if (pixels.is_colored()) {
    brightness.notes.push_back(name + ": is coloured; how bright its colours are is taken");
  }
  if (pixels.opacity().size() == 0) return brightness;
  for (Eigen::Index i = 0; i < brightness.pixels.size(); ++i) {
    brightness.pixels(i) = over_black(brightness.pixels(i), pixels.opacity()(i));
  }
  if (pixels.opacities_differ()) {
    brightness.notes.push_back(name +
                               ": is transparent in places, which count as if they lay on black");
  }
  return brightness;
}

std::vector<std::string> brightness_extensions() {
  return {".png", ".jpg", ".jpeg"};
}

}  // namespace mimetra
