#include "fitting/detector_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "fitting/image_files.h"

namespace mimetra {

namespace {

bool is_empty(const PixelArea& area) {
  return area.columns.size() <= 0 || area.rows.size() <= 0;
}

PixelRange joined(const PixelRange& a, const PixelRange& b) {
  return {std::min(a.first, b.first), std::max(a.last, b.last)};
}

/// Pixels of one level from one of its pixels to the next, measured in the level before.
double step_between(const PixelRange& before, const PixelRange& after) {
  return (before.last - 1) / static_cast<double>(std::max(after.last - 1, 1));
}

/// A pixel and the next one, and the share of the latter.
struct Between {
  int first;
  int second;
  float share;
};

std::vector<Between> places(const PixelRange& before, const PixelRange& after,
                            const PixelRange& wanted) {
  const double step = step_between(before, after);
  std::vector<Between> found;
  for (int i = wanted.first; i < wanted.last; ++i) {
    const double place = i * step;
    const int first = std::min(static_cast<int>(place), before.last - 1);
    found.push_back(
        {first, std::min(first + 1, before.last - 1), static_cast<float>(place - first)});
  }
  return found;
}

PixelRange source_of(const PixelRange& before, const PixelRange& after, const PixelRange& wanted) {
  const double step = step_between(before, after);
  return {std::min(static_cast<int>(wanted.first * step), before.last - 1),
          std::min(static_cast<int>((wanted.last - 1) * step) + 2, before.last)};
}

PyramidPart part_of(const PyramidPart& all, const PixelArea& area) {
  if (is_empty(area)) return {area, {}};
  return {area,
          cropped(all.pixels, area.columns.first - all.area.columns.first,
                  area.rows.first - all.area.rows.first, area.columns.size(), area.rows.size())};
}

}  // namespace

PixelArea joined(const PixelArea& a, const PixelArea& b) {
  if (is_empty(a)) return b;
  if (is_empty(b)) return a;
  return {joined(a.columns, b.columns), joined(a.rows, b.rows)};
}

DetectorPyramid::DetectorPyramid(const Image& image, int least) : image_(image) {
  int width = image.width, height = image.height;
  do {
    whole_.push_back({{0, width}, {0, height}});
    width = 5 * width / 6;
    height = 5 * height / 6;
  } while (width >= least && height >= least);
}

PixelArea DetectorPyramid::source_of(int level, const PixelArea& area) const {
  const PixelArea &before = whole(level - 1), &after = whole(level);
  return {mimetra::source_of(before.columns, after.columns, area.columns),
          mimetra::source_of(before.rows, after.rows, area.rows)};
}

Image DetectorPyramid::interpolated(const PyramidPart& before, int level,
                                    const PixelArea& area) const {
  const auto columns = places(whole(level - 1).columns, whole(level).columns, area.columns);
  const auto rows = places(whole(level - 1).rows, whole(level).rows, area.rows);
  Image image(area.columns.size(), area.rows.size());
  const int left = before.area.columns.first, top = before.area.rows.first;
  for (int y = 0; y < image.height; ++y) {
    const Between& row = rows[static_cast<std::size_t>(y)];
    const Color* upper = &before.pixels.at(0, row.first - top);
    const Color* lower = &before.pixels.at(0, row.second - top);
    for (int x = 0; x < image.width; ++x) {
      const Between& column = columns[static_cast<std::size_t>(x)];
      const float lower_left = row.share * (1 - column.share);
      const float lower_right = row.share * column.share;
      const float upper_left = (1 - row.share) * (1 - column.share);
      const float upper_right = (1 - row.share) * column.share;
      const auto mixed = [&](std::uint8_t Color::*channel) {
        // Cut off, not rounded: as dlib does it.
        return static_cast<std::uint8_t>(upper_left * float(upper[column.first - left].*channel) +
                                         upper_right * float(upper[column.second - left].*channel) +
                                         lower_left * float(lower[column.first - left].*channel) +
                                         lower_right * float(lower[column.second - left].*channel));
      };
      image.at(x, y) = {mixed(&Color::red), mixed(&Color::green), mixed(&Color::blue)};
    }
  }
  return image;
}

std::vector<PyramidPart> DetectorPyramid::parts(const std::vector<PixelArea>& wanted) const {
  std::vector<PyramidPart> parts;
  parts.reserve(wanted.size());
  for (const PixelArea& area : wanted) parts.push_back({area, {}});
  // A level needs what the next one is made of.
  for (int level = static_cast<int>(parts.size()) - 1; level > 0; --level) {
    const PixelArea& area = parts[static_cast<std::size_t>(level)].area;
    if (is_empty(area)) continue;
    PixelArea& before = parts[static_cast<std::size_t>(level) - 1].area;
    before = joined(before, source_of(level, area));
  }
  for (int level = 0; level < static_cast<int>(parts.size()); ++level) {
    auto& [area, pixels] = parts[static_cast<std::size_t>(level)];
    if (is_empty(area)) continue;
    if (level > 0) {
      pixels = interpolated(parts[static_cast<std::size_t>(level) - 1], level, area);
      continue;
    }
    pixels =
        cropped(image_, area.columns.first, area.rows.first, area.columns.size(), area.rows.size());
  }
  for (std::size_t level = 0; level < parts.size(); ++level) {
    parts[level] = part_of(parts[level], wanted[level]);
  }
  return parts;
}

}  // namespace mimetra
