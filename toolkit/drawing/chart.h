#pragma once

#include <string>
#include <vector>

#include "toolkit/io/data.h"
#include "toolkit/mesh/option.h"
#include "toolkit/operations/colors.h"

namespace mimetra {

enum class ChartScale { linear, logarithmic };

struct ChartAxis {
  std::string label;  ///< with the unit
  ChartScale scale = ChartScale::linear;
};

struct ChartSeries {
  std::string name;  ///< in the legend
  std::vector<double> x;
  std::vector<double> y;  ///< as many as x
  /// By default a colour for the series' place in the chart, distinguishable with any kind of
  /// colour vision. From the eighth series on, colours repeat and lines are dashed.
  std::optional<Color> color = {};
  bool marked = true;  ///< a mark at each point
};

struct Chart {
  std::string title;
  ChartAxis x;
  ChartAxis y;
  std::vector<ChartSeries> series;
  bool legend = true;  ///< below the axes
};

struct ChartSize {
  int width = 640;   ///< pixels of one chart, >= 200
  int height = 560;  ///< >= 200
  int letters = 0;   ///< height of letters, pixels; 0 to fit the chart's height

  static constexpr Option kWidth{"width", &ChartSize::width, {.minimum = 200}, "pixels"};
  static constexpr Option kHeight{"height", &ChartSize::height, {.minimum = 200}, "pixels"};
  static constexpr Option kLetters{"letters", &ChartSize::letters, {.minimum = 0}, "pixels"};
  static constexpr auto declared() { return std::tuple(kWidth, kHeight, kLetters); }
};

/// Draws charts in a row, each with its title, axes and optional legend below them.
///
/// Throws std::invalid_argument for no chart, a chart without points, or a series whose x and y
/// differ in number. Throws it also for a picture outside the limits of ChartSize and
/// kLargestPicture. Numbers that the scale cannot show are refused as well: not finite, or not
/// positive on a logarithmic scale. Throws std::runtime_error if there is no OpenGL.
Image draw(const std::vector<Chart>& row, const ChartSize& size = {});

}  // namespace mimetra
