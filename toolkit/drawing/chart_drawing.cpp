#include "toolkit/drawing/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include "toolkit/drawing/offscreen_window.h"
#include "toolkit/mesh/text.h"
#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {

namespace {

/// A chart is this many letters high, but letters stay large enough to read.
constexpr int kLettersPerChart = 36;
constexpr int kSmallestChartLetters = 11;

/// The palette of [Okabe, Ito. Color universal design. 2008] without yellow, which is invisible on
/// white.
constexpr std::array<Color, 7> kSeriesColors = {{{0, 114, 178},
                                                 {213, 94, 0},
                                                 {0, 158, 115},
                                                 {204, 121, 167},
                                                 {86, 180, 233},
                                                 {230, 159, 0},
                                                 {60, 60, 60}}};

/// Position of a value along an axis. VTK's own logarithmic axes omit decades and labels.
double scaled(double value, const ChartAxis& axis) {
  return axis.scale == ChartScale::logarithmic ? std::log10(value) : value;
}

struct Range {
  double first = std::numeric_limits<double>::infinity();
  double last = -std::numeric_limits<double>::infinity();

  void add(double value) {
    first = std::min(first, value);
    last = std::max(last, value);
  }
  double length() const { return last - first; }
};

/// Range of an axis for all values, scaled, with some space at the ends.
Range range_of(const Chart& chart, const ChartAxis& axis,
               std::vector<double> ChartSeries::*values) {
  constexpr double kSpace = 0.06;
  Range range;
  for (const ChartSeries& series : chart.series) {
    for (const double value : series.*values) range.add(scaled(value, axis));
  }
  const double space =
      range.length() > 0 ? kSpace * range.length() : std::max(0.1, 0.1 * std::abs(range.first));
  return {range.first - space, range.last + space};
}

/// About five round numbers at even distances, which are 1, 2 or 5 times a power of ten.
std::vector<double> even_ticks(const Range& range) {
  constexpr double kTicks = 5;
  const double rough = range.length() / kTicks;
  const double decade = std::pow(10, std::floor(std::log10(rough)));
  double step = decade;
  for (const double factor : {2, 5, 10}) {
    const double larger = factor * decade;
    if (larger * step <= rough * rough) step = larger;
  }
  std::vector<double> ticks;
  for (double i = std::ceil(range.first / step); i * step <= range.last; ++i) {
    ticks.push_back(i * step);
  }
  return ticks;
}

/// Decades, and multiples of them if there are few; values, not logarithms.
std::vector<double> decade_ticks(const Range& range) {
  constexpr double kManyDecades = 2.2, kOneDecade = 1, kHalfDecade = 0.5;
  const std::vector<int> factors = range.length() > kManyDecades ? std::vector{1}
                                   : range.length() > kOneDecade ? std::vector{1, 2, 5}
                                   : range.length() > kHalfDecade
                                       ? std::vector{1, 2, 3, 5, 7}
                                       : std::vector{1, 2, 3, 4, 5, 6, 7, 8, 9};
  std::vector<double> ticks;
  for (double exponent = std::floor(range.first); exponent <= range.last; ++exponent) {
    for (const int factor : factors) {
      const double position = exponent + std::log10(factor);
      if (position < range.first || position > range.last) continue;
      ticks.push_back(factor * std::pow(10, exponent));
    }
  }
  return ticks;
}

std::string tick_label(double value) {
  constexpr int kDigits = 6;
  return readable(value, kDigits);
}

void set_text(vtkTextProperty& look, int size, bool bold) {
  look.SetFontSize(size);
  look.SetBold(bold);
  look.SetColor(0.1, 0.1, 0.1);
}

void set_axis(vtkAxis& shown, const ChartAxis& axis, const Range& range, int letters) {
  const bool logarithmic = axis.scale == ChartScale::logarithmic;
  vtkNew<vtkDoubleArray> positions;
  vtkNew<vtkStringArray> labels;
  for (const double tick : logarithmic ? decade_ticks(range) : even_ticks(range)) {
    positions->InsertNextValue(scaled(tick, axis));
    labels->InsertNextValue(tick_label(std::abs(tick) < 1e-9 * range.length() ? 0 : tick));
  }
  shown.SetTitle(axis.label);
  shown.SetBehavior(vtkAxis::FIXED);
  shown.SetRange(range.first, range.last);
  shown.SetCustomTickPositions(positions, labels);
  shown.GetGridPen()->SetColor(225, 225, 225);
  shown.GetPen()->SetColor(90, 90, 90);
  set_text(*shown.GetTitleProperties(), letters, false);
  set_text(*shown.GetLabelProperties(), letters, false);
}

void add_series(vtkChartXY& shown, const Chart& chart, std::size_t number, int letters) {
  const ChartSeries& series = chart.series[number];
  const Color color = series.color.value_or(kSeriesColors[number % kSeriesColors.size()]);
  vtkNew<vtkDoubleArray> x, y;
  x->SetName("x");
  y->SetName(series.name.c_str());
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    x->InsertNextValue(scaled(series.x[i], chart.x));
    y->InsertNextValue(scaled(series.y[i], chart.y));
  }
  vtkNew<vtkTable> table;
  table->AddColumn(x);
  table->AddColumn(y);
  auto& plot = dynamic_cast<vtkPlotPoints&>(*shown.AddPlot(vtkChart::LINE));
  plot.SetInputData(table, 0, 1);
  plot.SetLabel(series.name);
  plot.SetColor(color.red, color.green, color.blue, 255);
  plot.SetWidth(static_cast<float>(letters) / 7);
  if (number >= kSeriesColors.size()) plot.GetPen()->SetLineType(vtkPen::DASH_LINE);
  plot.SetMarkerStyle(series.marked ? vtkPlotPoints::CIRCLE : vtkPlotPoints::NONE);
  plot.SetMarkerSize(static_cast<float>(letters) / 2);
}

vtkSmartPointer<vtkChartXY> chart_item(const Chart& chart, int letters) {
  const auto shown = vtkSmartPointer<vtkChartXY>::New();
  shown->SetTitle(chart.title);
  set_text(*shown->GetTitleProperties(), letters * 6 / 5, true);
  for (std::size_t i = 0; i < chart.series.size(); ++i) add_series(*shown, chart, i, letters);
  set_axis(*shown->GetAxis(vtkAxis::BOTTOM), chart.x, range_of(chart, chart.x, &ChartSeries::x),
           letters);
  set_axis(*shown->GetAxis(vtkAxis::LEFT), chart.y, range_of(chart, chart.y, &ChartSeries::y),
           letters);
  shown->SetShowLegend(chart.legend);
  vtkChartLegend& legend = *shown->GetLegend();
  legend.SetInline(false);  // below the axes, clear of all curves
  legend.SetHorizontalAlignment(vtkChartLegend::CENTER);
  legend.SetVerticalAlignment(vtkChartLegend::BOTTOM);
  legend.GetPen()->SetOpacity(0);
  set_text(*legend.GetLabelProperties(), letters, false);
  legend.SetLabelSize(letters);
  return shown;
}

void check_values(const std::vector<double>& values, const ChartAxis& axis,
                  const ChartSeries& series) {
  for (const double value : values) {
    const bool positive = axis.scale == ChartScale::linear || value > 0;
    if (std::isfinite(value) && positive) continue;
    throw std::invalid_argument("series '" + series.name + "': " + tick_label(value) +
                                " has no place on the axis '" + axis.label + "'");
  }
}

void check(const Chart& chart) {
  const auto has_points = [](const ChartSeries& series) { return !series.x.empty(); };
  if (std::ranges::none_of(chart.series, has_points)) {
    throw std::invalid_argument("chart '" + chart.title + "' has no points");
  }
  for (const ChartSeries& series : chart.series) {
    if (series.x.size() != series.y.size()) {
      throw std::invalid_argument("series '" + series.name +
                                  "': " + std::to_string(series.x.size()) + " x and " +
                                  std::to_string(series.y.size()) + " y");
    }
    check_values(series.x, chart.x, series);
    check_values(series.y, chart.y, series);
  }
}

void check(const std::vector<Chart>& row, const ChartSize& size) {
  if (row.empty()) throw std::invalid_argument("a picture of charts needs a chart");
  check_options(size);
  const auto largest = static_cast<std::size_t>(kLargestPicture);
  if (row.size() * static_cast<std::size_t>(size.width) > largest ||
      size.height > kLargestPicture) {
    throw std::invalid_argument(std::to_string(row.size()) + " charts of " +
                                std::to_string(size.width) + " x " + std::to_string(size.height) +
                                " pixels, at most " + std::to_string(kLargestPicture) +
                                " each way can be drawn");
  }
  for (const Chart& chart : row) check(chart);
}

}  // namespace

Image drawn(const std::vector<Chart>& row, const ChartSize& size) {
  check(row, size);
  const int letters = size.letters > 0
                          ? size.letters
                          : std::max(kSmallestChartLetters, size.height / kLettersPerChart);
  const OffscreenWindow offscreen(size.width * static_cast<int>(row.size()), size.height);
  const SilentVtk silent;
  vtkNew<vtkContextActor> actor;
  const int height = size.height - letters / 2;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto shown = chart_item(row[i], letters);
    shown->SetAutoSize(false);
    // Leave space for the last tick's label, which is centred on the end of its axis.
    const double left = static_cast<double>(i) * size.width;
    shown->SetSize(vtkRectf(static_cast<float>(left), 0, static_cast<float>(size.width - letters),
                            static_cast<float>(height)));
    actor->GetScene()->AddItem(shown);
  }
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  renderer->AddActor(actor);
  actor->GetScene()->SetRenderer(renderer);
  offscreen.window().AddRenderer(renderer);
  return offscreen.image();
}

}  // namespace mimetra
