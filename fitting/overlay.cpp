#include "fitting/overlay.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "fitting/image_files.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

constexpr Color kEdges = {0, 255, 255};
constexpr Color kFound = {255, 230, 0};
constexpr Color kModel = {255, 0, 255};
constexpr Color kResidual = {255, 0, 0};
constexpr Color kRim = {0, 0, 0};

/// Coordinates beyond this are outside every image.
constexpr double kFarAway = 1e6;

struct Pixel {
  int x;
  int y;
};

std::optional<Pixel> nearest_pixel(const Eigen::RowVector2d& point) {
  if (!point.allFinite() || point.lpNorm<Eigen::Infinity>() > kFarAway) return std::nullopt;
  return Pixel{static_cast<int>(std::lround(point.x())), static_cast<int>(std::lround(point.y()))};
}

/// Calls `visit(x, y)` for the pixels of a line, including its ends (Bresenham).
template <typename Visit>
void for_each_on_line(Pixel at, const Pixel& end, Visit visit) {
  const int dx = std::abs(end.x - at.x), dy = -std::abs(end.y - at.y);
  const int step_x = at.x < end.x ? 1 : -1, step_y = at.y < end.y ? 1 : -1;
  int error = dx + dy;
  while (true) {
    visit(at.x, at.y);
    if (at.x == end.x && at.y == end.y) return;
    const int doubled = 2 * error;
    if (doubled >= dy) {
      error += dy;
      at.x += step_x;
    }
    if (doubled <= dx) {
      error += dx;
      at.y += step_y;
    }
  }
}

/// True if the whole line is on one side of the image.
bool misses(const Image& image, const Pixel& a, const Pixel& b) {
  return std::max(a.x, b.x) < 0 || std::max(a.y, b.y) < 0 || std::min(a.x, b.x) >= image.width ||
         std::min(a.y, b.y) >= image.height;
}

void draw_line(Image& image, const Pixel& a, const Pixel& b, const Color& color) {
  if (misses(image, a, b)) return;
  for_each_on_line(a, b, [&](int x, int y) {
    if (image.contains(x, y)) image.at(x, y) = color;
  });
}

void draw_square(Image& image, const Pixel& middle, int half, const Color& color) {
  for (int y = middle.y - half; y <= middle.y + half; ++y) {
    draw_line(image, {middle.x - half, y}, {middle.x + half, y}, color);
  }
}

void draw_cross(Image& image, const Pixel& middle, int half, const Color& color) {
  draw_line(image, {middle.x - half, middle.y}, {middle.x + half, middle.y}, color);
  draw_line(image, {middle.x, middle.y - half}, {middle.x, middle.y + half}, color);
}

/// y points down, so counter-clockwise corners have a negative area.
bool shows_front(const ImagePoints& points, const Triangles& triangles, Eigen::Index t) {
  const Eigen::RowVector2d a = points.row(triangles(t, 0));
  const Eigen::RowVector2d ab = points.row(triangles(t, 1)) - a,
                           ac = points.row(triangles(t, 2)) - a;
  return ab.x() * ac.y() - ab.y() * ac.x() < 0;
}

/// Pixels covered by edges. Each is mixed only once, so a face shows through dense edges.
std::vector<bool> edge_pixels(const Image& image, const Triangles& triangles,
                              const ImagePoints& points) {
  std::vector<bool> covered(image.pixels.size());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    if (!shows_front(points, triangles, t)) continue;
    for (int corner = 0; corner < 3; ++corner) {
      const auto a = nearest_pixel(points.row(triangles(t, corner)));
      const auto b = nearest_pixel(points.row(triangles(t, (corner + 1) % 3)));
      if (!a || !b || misses(image, *a, *b)) continue;
      for_each_on_line(*a, *b, [&](int x, int y) {
        if (image.contains(x, y)) covered[image.index(x, y)] = true;
      });
    }
  }
  return covered;
}

/// Mixes two thirds of `under` with one third of `over`.
std::uint8_t mixed(int under, int over) {
  return static_cast<std::uint8_t>((2 * under + over) / 3);
}

void mix_in(Image& image, const std::vector<bool>& covered, const Color& color) {
  for (std::size_t i = 0; i < covered.size(); ++i) {
    if (!covered[i]) continue;
    Color& pixel = image.pixels[i];
    pixel = {mixed(pixel.red, color.red), mixed(pixel.green, color.green),
             mixed(pixel.blue, color.blue)};
  }
}

void check(const Triangles& triangles, const FittedView& view) {
  const Eigen::Index vertices = view.vertices.rows();
  const auto is_vertex = [&](int v) { return v >= 0 && v < vertices; };
  const auto corners = triangles.reshaped();
  if (!std::all_of(corners.begin(), corners.end(), is_vertex) ||
      !std::ranges::all_of(view.landmark_vertices, is_vertex)) {
    throw std::invalid_argument("a triangle or landmark has a vertex that is none of the " +
                                std::to_string(vertices));
  }
  const auto own = static_cast<Eigen::Index>(view.landmark_vertices.size());
  if (own != 0 && own != view.landmarks.rows()) {
    throw std::invalid_argument(std::to_string(own) + " vertices for " +
                                std::to_string(view.landmarks.rows()) + " landmarks");
  }
}

/// Half the side of a landmark's square: visible, but smaller than what it marks.
int marker_size(const ImagePoints& vertices) {
  const double extent = (vertices.colwise().maxCoeff() - vertices.colwise().minCoeff()).maxCoeff();
  return extent < kFarAway ? std::max(1, static_cast<int>(extent / 300)) : 1;
}

/// Smaller parts, in pixels, show nothing. Flat ones would grow beyond all bounds when scaled.
constexpr int kLeastPart = 4;

struct Box {
  int left;
  int top;
  int width;
  int height;
};

/// Box of the points with a margin of a tenth on each side.
Box box_with_margin(const ImagePoints& points) {
  if (points.rows() == 0 || !points.allFinite()) {
    throw std::invalid_argument("the mesh has no finite vertices to look at");
  }
  const Eigen::RowVector2d low = points.colwise().minCoeff(), high = points.colwise().maxCoeff();
  const Eigen::RowVector2d margin = (high - low) / 10;
  const auto pixel = [](double value) {
    return static_cast<int>(std::lround(std::clamp(value, -kFarAway, kFarAway)));
  };
  const int left = pixel(low.x() - margin.x()), top = pixel(low.y() - margin.y());
  return {left, top, pixel(high.x() + margin.x()) - left + 1,
          pixel(high.y() + margin.y()) - top + 1};
}

}  // namespace

Image draw_fit(const Image& image, const Triangles& triangles, const FittedView& view) {
  check(triangles, view);
  Image drawn = image;
  mix_in(drawn, edge_pixels(image, triangles, view.vertices), kEdges);
  const int half = view.vertices.rows() == 0 ? 1 : marker_size(view.vertices);
  for (Eigen::Index i = 0; i < view.landmarks.rows(); ++i) {
    const auto found = nearest_pixel(view.landmarks.row(i));
    std::optional<Pixel> own;
    if (!view.landmark_vertices.empty()) {
      own = nearest_pixel(view.vertices.row(view.landmark_vertices[static_cast<std::size_t>(i)]));
    }
    if (found && own) draw_line(drawn, *found, *own, kResidual);
    if (found) {
      draw_square(drawn, *found, half + 1, kRim);
      draw_square(drawn, *found, half, kFound);
    }
    if (own) draw_cross(drawn, *own, half + 1, kModel);
  }
  return drawn;
}

Image draw_close_up(const Image& image, const Triangles& triangles, const FittedView& view,
                    int height) {
  const Box box = box_with_margin(view.vertices);
  const Image part = cropped(image, box.left, box.top, box.width, box.height);
  if (part.width < kLeastPart || part.height < kLeastPart) {
    throw std::invalid_argument("hardly anything of the mesh is inside the image");
  }
  const Image scaled = scaled_to_height(part, height);
  const Eigen::RowVector2d corner(std::max(box.left, 0), std::max(box.top, 0));
  const Eigen::Array2d scale(double(scaled.width) / part.width,
                             double(scaled.height) / part.height);
  // Pixels are squares around their middles, so the image's corner is at -0.5.
  const auto moved = [&](const ImagePoints& points) -> ImagePoints {
    return (((points.rowwise() - corner).array() + 0.5).rowwise() * scale.transpose() - 0.5)
        .matrix();
  };
  return draw_fit(scaled, triangles,
                  {moved(view.vertices), moved(view.landmarks), view.landmark_vertices});
}

FitPictures::FitPictures(std::shared_ptr<const ImageSequence> images, MeshSequence sequence,
                         const FittedCoefficients& fit, MappedLandmarks mapped) {
  Triangles triangles = sequence.triangles();
  clip_ = std::make_shared<const Clip>(Clip{std::move(images), std::move(sequence), fit.cameras,
                                            fit.depths, std::move(mapped), std::move(triangles)});
}

Image FitPictures::image(int frame) const {
  return clip_->images->image(frame);
}

FittedView FitPictures::view(int frame) const {
  const MappedLandmarks& mapped = clip_->mapped;
  const Eigen::RowVector4d depth =
      clip_->depths.rows() > 0 ? clip_->depths.row(frame) : Eigen::RowVector4d(0, 0, 0, 1);
  return {
      project(clip_->cameras[static_cast<std::size_t>(frame)], clip_->sequence.frame(frame), depth),
      points_of_frame(mapped.points, frame), mapped.vertices};
}

Image FitPictures::overlay(int frame) const {
  return draw_fit(image(frame), clip_->triangles, view(frame));
}

Image FitPictures::strip(const std::vector<int>& frames) const {
  constexpr std::size_t kMost = 5;
  constexpr int kHeight = 400;
  const std::size_t count = std::min(kMost, frames.size());
  std::vector<Image> parts;
  for (std::size_t i = 0; i < count; ++i) {
    const int frame = frames[count == 1 ? 0 : i * (frames.size() - 1) / (count - 1)];
    try {
      parts.push_back(draw_close_up(image(frame), clip_->triangles, view(frame), kHeight));
    } catch (const std::invalid_argument&) {
      throw MismatchError(clip_->images->name(frame) +
                          ": the fitted face is outside the image; do the landmarks belong to it?");
    }
  }
  return mimetra::strip(parts, kHeight);
}

}  // namespace mimetra
