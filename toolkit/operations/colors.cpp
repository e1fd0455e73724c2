#include "toolkit/operations/colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace mimetra {

namespace {

using Vector = Eigen::Vector3d;

double linear_of(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

double srgb_of(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

Vector oklab_of(const Color& color) {
  const Vector rgb(linear_of(color.red / 255.0), linear_of(color.green / 255.0),
                   linear_of(color.blue / 255.0));
  Eigen::Matrix3d to_cones, to_lab;
  to_cones << 0.4122214708, 0.5363325363, 0.0514459929,  //
      0.2119034982, 0.6806995451, 0.1073969566,          //
      0.0883024619, 0.2817188376, 0.6299787005;
  to_lab << 0.2104542553, 0.7936177850, -0.0040720468,  //
      1.9779984951, -2.4285922050, 0.4505937099,        //
      0.0259040371, 0.7827717662, -0.8086757660;
  const auto root = [](double x) { return std::cbrt(x); };
  return to_lab * (to_cones * rgb).unaryExpr(root);
}

Color color_of(const Vector& lab) {
  Eigen::Matrix3d to_cones, to_rgb;
  to_cones << 1, 0.3963377774, 0.2158037573,  //
      1, -0.1055613458, -0.0638541728,        //
      1, -0.0894841775, -1.2914855480;
  to_rgb << 4.0767416621, -3.3077115913, 0.2309699292,  //
      -1.2684380046, 2.6097574011, -0.3413193965,       //
      -0.0041960863, -0.7034186147, 1.7076147010;
  const Vector rgb = to_rgb * (to_cones * lab).array().cube().matrix();
  const auto byte = [](double linear) {
    return static_cast<std::uint8_t>(std::lround(255 * srgb_of(std::clamp(linear, 0.0, 1.0))));
  };
  return {byte(rgb[0]), byte(rgb[1]), byte(rgb[2])};
}

/// Polyline through Oklab for even_color(), with the length up to each corner.
struct Path {
  std::vector<Vector> corners;
  std::vector<double> lengths = {0};

  explicit Path(const std::vector<Color>& colors) {
    for (const Color& color : colors) {
      corners.push_back(oklab_of(color));
      if (corners.size() == 1) continue;
      const double step = (corners.back() - corners[corners.size() - 2]).norm();
      lengths.push_back(lengths.back() + step);
    }
  }

  Vector at(double share) const {
    const double length = share * lengths.back();
    const auto above = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, length);
    const auto i = static_cast<std::size_t>(above - lengths.begin());
    const double part = (length - lengths[i - 1]) / (lengths[i] - lengths[i - 1]);
    return corners[i - 1] + part * (corners[i] - corners[i - 1]);
  }
};

/// Rank of each vertex's category among the categories present; -1 for none.
std::vector<int> ranks_of(const std::vector<int>& categories) {
  std::map<int, int> rank;
  for (const int category : categories) {
    if (category >= 0) rank[category] = 0;
  }
  int next = 0;
  for (auto& [category, place] : rank) place = next++;
  std::vector<int> ranks;
  ranks.reserve(categories.size());
  for (const int category : categories) ranks.push_back(category < 0 ? -1 : rank[category]);
  return ranks;
}

/// Categories of lower rank that share an edge of a triangle with each category.
std::map<int, std::set<int>> touching(const std::vector<int>& ranks, const Triangles& triangles) {
  std::map<int, std::set<int>> lower;
  for (const int rank : ranks) lower[rank];
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const int a = ranks[static_cast<std::size_t>(triangles(t, i))];
      const int b = ranks[static_cast<std::size_t>(triangles(t, (i + 1) % 3))];
      if (std::min(a, b) >= 0 && a != b) lower[std::max(a, b)].insert(std::min(a, b));
    }
  }
  return lower;
}

}  // namespace

Color even_color(double share) {
  static const Path path(
      {{235, 226, 214}, {243, 178, 92}, {214, 84, 88}, {121, 42, 124}, {28, 16, 68}});
  if (std::isnan(share)) return kNoValue;
  return color_of(path.at(std::clamp(share, 0.0, 1.0)));
}

std::vector<Color> category_colors(const std::vector<int>& categories, const Triangles& triangles) {
  // The first seven colours alternate. The others serve categories that touch all seven.
  constexpr std::size_t kUsual = 7;
  constexpr std::array<Color, 11> kPalette = {{{230, 159, 0},
                                               {86, 180, 233},
                                               {0, 158, 115},
                                               {240, 228, 66},
                                               {0, 114, 178},
                                               {213, 94, 0},
                                               {204, 121, 167},
                                               {136, 34, 85},
                                               {80, 80, 80},
                                               {187, 204, 51},
                                               {51, 34, 136}}};
  const std::vector<int> ranks = ranks_of(categories);
  std::map<int, std::size_t> chosen;
  for (const auto& [rank, lower] : touching(ranks, triangles)) {
    if (rank < 0) continue;
    std::array<int, kPalette.size()> used{};
    for (const int neighbor : lower) ++used[chosen[neighbor]];
    // Takes the colour that neighbours use least. Starting at another colour each time spreads
    // colours.
    std::size_t best = static_cast<std::size_t>(rank) % kUsual;
    for (std::size_t i = 0; i < kUsual; ++i) {
      const std::size_t candidate = (static_cast<std::size_t>(rank) + i) % kUsual;
      if (used[candidate] < used[best]) best = candidate;
    }
    for (std::size_t i = kUsual; i < kPalette.size(); ++i) {
      if (used[i] < used[best]) best = i;
    }
    chosen[rank] = best;
  }
  std::vector<Color> colors;
  colors.reserve(ranks.size());
  for (const int rank : ranks) colors.push_back(rank < 0 ? kClay : kPalette[chosen[rank]]);
  return colors;
}

std::vector<Color> colors_by_category(const std::vector<int>& categories,
                                      const Triangles& triangles, std::size_t count) {
  const std::vector<Color> of_vertices = category_colors(categories, triangles);
  std::vector<Color> colors(count, kClay);
  for (std::size_t v = 0; v < categories.size(); ++v) {
    const int category = categories[v];
    if (category >= 0 && static_cast<std::size_t>(category) < count) {
      colors[static_cast<std::size_t>(category)] = of_vertices[v];
    }
  }
  return colors;
}

Field region_color_field(const Field& region, const Connectivity& connectivity) {
  std::vector<int> labels;
  for (const double value : region.values.col(0)) labels.push_back(static_cast<int>(value));
  const std::vector<Color> colors = category_colors(labels, connectivity.triangles);
  const Polygons& polygons = connectivity.polygons;
  Eigen::MatrixXd of_faces(polygons.size(), 3);
  for (int face = 0; face < polygons.size(); ++face) {
    // By region: number of corners, and one of them.
    std::map<int, std::pair<int, VertexIndex>> corners;
    for (int c = polygons.offsets[face]; c < polygons.offsets[face + 1]; ++c) {
      const VertexIndex vertex = polygons.corners[c];
      auto& [count, of_region] = corners[labels[static_cast<std::size_t>(vertex)]];
      ++count;
      of_region = vertex;
    }
    const auto most =
        std::ranges::max_element(corners, {}, [](const auto& entry) { return entry.second.first; });
    const Color& color = colors[static_cast<std::size_t>(most->second.second)];
    of_faces.row(face) << color.red, color.green, color.blue;
  }
  return {"region_color", Field::Location::triangles,
          of_faces(connectivity.polygon_of_triangle, Eigen::all), true};
}

}  // namespace mimetra
