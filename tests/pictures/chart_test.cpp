#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/option_ranges.h"
#include "tests/temporary_folder.h"
#include "toolkit/drawing/chart.h"
#include "toolkit/drawing/picture.h"

namespace mimetra {
namespace {

using test::message_of;
using testing::HasSubstr;

constexpr Color kRed = {255, 0, 0};

Chart chart_of(std::vector<double> x, std::vector<double> y, ChartScale scale) {
  Chart chart;
  chart.title = "time";
  chart.x = {"vertices", scale};
  chart.y = {"seconds", scale};
  chart.series.push_back({"decomposition", std::move(x), std::move(y), kRed});
  return chart;
}

/// Middle of the red pixels in each column of a picture's upper part, above the legend; -1 where
/// there are none.
std::vector<double> red_heights(const Image& image) {
  std::vector<double> heights;
  for (int x = 0; x < image.width; ++x) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < image.height * 9 / 10; ++y) {
      const Color& pixel = image.at(x, y);
      if (pixel.red < 200 || pixel.green > 60 || pixel.blue > 60) continue;
      sum += y;
      ++count;
    }
    heights.push_back(count > 0 ? sum / count : -1);
  }
  return heights;
}

/// Largest distance of the drawn curve from the straight line between its ends, pixels.
double bend(const Image& image) {
  const std::vector<double> heights = red_heights(image);
  const auto drawn = [](double height) { return height >= 0; };
  const auto first = std::ranges::find_if(heights, drawn) - heights.begin();
  const auto last =
      std::ranges::find_if(heights.rbegin(), heights.rend(), drawn).base() - heights.begin() - 1;
  double largest = 0;
  for (auto x = first; x <= last; ++x) {
    const double share = static_cast<double>(x - first) / static_cast<double>(last - first);
    const double straight = heights[first] + share * (heights[last] - heights[first]);
    largest = std::max(largest, std::abs(heights[x] - straight));
  }
  return largest;
}

// Half of a mark, which the middles of columns at its rim may be off.
constexpr double kMark = 5;

TEST(Chart, ShowsAPowerAsAStraightLineOnLogarithmicAxesOnly) {
  std::vector<double> x, y;
  for (double value = 1; value <= 1000; value *= 2) {
    x.push_back(value);
    y.push_back(1e-6 * std::pow(value, 3));
  }
  EXPECT_LT(bend(draw({chart_of(x, y, ChartScale::logarithmic)})), kMark);
  EXPECT_GT(bend(draw({chart_of(x, y, ChartScale::linear)})), 10 * kMark);
}

TEST(Chart, PutsLargerValuesHigherAndFartherRight) {
  const std::vector<double> heights =
      red_heights(draw({chart_of({1, 2, 3}, {5, 6, 7}, ChartScale::linear)}));
  std::vector<double> drawn;
  std::ranges::copy_if(heights, std::back_inserter(drawn), [](double h) { return h >= 0; });
  EXPECT_GT(drawn.size(), 300u);                 // of 640
  EXPECT_GT(drawn.front(), drawn.back() + 200);  // of 560, counted from above
}

TEST(Chart, LeavesOutMarksWhereNoneAreAskedFor) {
  Chart chart = chart_of({4}, {4}, ChartScale::linear);
  const auto drawn = [&chart] {
    const std::vector<double> heights = red_heights(draw({chart}));
    return std::ranges::count_if(heights, [](double height) { return height >= 0; });
  };
  const auto with_mark = drawn();
  chart.series[0].marked = false;
  EXPECT_LT(drawn(), with_mark);
}

TEST(Chart, HasMoreSpaceForItsCurveWithoutALegend) {
  Chart chart = chart_of({1, 2, 3}, {1, 2, 3}, ChartScale::linear);
  const auto lowest = [](const Image& image) {
    const std::vector<double> heights = red_heights(image);
    return *std::ranges::max_element(heights);
  };
  const double above_legend = lowest(draw({chart}));
  chart.legend = false;
  EXPECT_GT(lowest(draw({chart})), above_legend);
}

TEST(Chart, ShowsOnePointAlone) {
  for (const ChartScale scale : {ChartScale::linear, ChartScale::logarithmic}) {
    const std::vector<double> heights = red_heights(draw({chart_of({4}, {4}, scale)}));
    EXPECT_GT(*std::ranges::max_element(heights), 0);
  }
}

TEST(Chart, StandsBesideItsNeighbourOnWhite) {
  const Chart rising = chart_of({1, 2}, {1, 2}, ChartScale::linear);
  Chart blue = rising;
  blue.series[0].color = Color{0, 0, 255};
  const ChartSize size{300, 250};
  const Image image = draw({rising, blue}, size);
  ASSERT_EQ(image.width, 600);
  ASSERT_EQ(image.height, 250);
  EXPECT_EQ(image.at(0, 0), (Color{255, 255, 255}));
  const std::vector<double> heights = red_heights(image);
  EXPECT_GE(*std::max_element(heights.begin(), heights.begin() + 300), 0);
  EXPECT_EQ(*std::max_element(heights.begin() + 300, heights.end()), -1);
}

std::string refusal(const std::vector<Chart>& row, const ChartSize& size = {}) {
  return message_of<std::invalid_argument>([&] { draw(row, size); });
}

TEST(Chart, NamesWhatItCannotShow) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  test::expect_ranges<ChartSize>();
  EXPECT_THAT(refusal({}), HasSubstr("needs a chart"));
  EXPECT_THAT(refusal({Chart{"empty", {}, {}, {}}}), HasSubstr("chart 'empty' has no points"));
  EXPECT_THAT(refusal({chart_of({1, 2}, {1}, ChartScale::linear)}),
              HasSubstr("series 'decomposition': 2 x and 1 y"));
  EXPECT_THAT(refusal({chart_of({1}, {nan}, ChartScale::linear)}),
              HasSubstr("nan has no place on the axis 'seconds'"));
  EXPECT_THAT(refusal({chart_of({0}, {1}, ChartScale::logarithmic)}),
              HasSubstr("0 has no place on the axis 'vertices'"));
  const Chart sound = chart_of({1}, {1}, ChartScale::linear);
  EXPECT_THAT(refusal({sound}, {100, 500}), HasSubstr("at least 200"));
  EXPECT_THAT(refusal({sound, sound}, {9000, 500}), HasSubstr("at most 16384"));
}

}  // namespace
}  // namespace mimetra
