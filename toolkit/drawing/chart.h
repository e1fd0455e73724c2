#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/option.h"
#include "toolkit/operations/colors.h"
#include "toolkit/operations/data.h"

namespace mimetra {

enum class ChartScale { linear, logarithmic };

struct ChartAxis {
  std::string label;  ///< with the unit
  ChartScale scale = ChartScale::linear;
};

/// A line through points.
struct ChartSeries {
  std::string name;  ///< in the legend
  std::vector<double> x;
  std::vector<double> y;  ///< as many as x
  /// By default that of the series' place in the chart: told apart with any kind of colour vision.
  /// From the eighth series on the colours repeat, and lines are dashed.
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
  int letters = 0;   ///< height of letters, pixels; 0 for what suits the height

  static constexpr Option kWidth{"width", &ChartSize::width, {.minimum = 200}, "pixels"};
  static constexpr Option kHeight{"height", &ChartSize::height, {.minimum = 200}, "pixels"};
  static constexpr Option kLetters{"letters", &ChartSize::letters, {.minimum = 0}, "pixels"};
  static constexpr auto declared() { return std::tuple(kWidth, kHeight, kLetters); }
};

/// Draws charts in a row, each with its title, axes and, below them, its legend where it has one.
/// Throws std::invalid_argument for no chart, a chart without points, a series whose x and y differ
/// in number, a number that the scale cannot show (not finite, or not positive on a logarithmic
/// one), and a picture larger than kLargestPicture or smaller than charts may be;
/// std::runtime_error where there is no OpenGL.
Image draw(const std::vector<Chart>& row, const ChartSize& size = {});

}  // namespace mimetra
