#include "tests/bench/iterations_bench.h"

#include <algorithm>
#include <cstdio>
#include <ctime>

#include "toolkit/drawing/chart.h"
#include "toolkit/pipeline/measure.h"
#include "toolkit/pipeline/region_choice.h"

namespace mimetra::bench {
namespace {

/// A measure of the curves: its axis, and its value.
struct Measure {
  ChartAxis axis;
  std::optional<double> (*value)(const IterationPoint&);
};

const std::vector<Measure>& measures() {
  using Point = IterationPoint;
  static const std::vector<Measure> all = {
      {{"energy (%)"}, [](const Point& p) { return std::optional(p.energy); }},
      {{"DE above full (%)", ChartScale::logarithmic}, [](const Point& p) { return p.excess; }},
      {{"triangles (%)"}, [](const Point& p) { return std::optional(p.share); }},
      {{"processor time (s)", ChartScale::logarithmic},
       [](const Point& p) { return std::optional(p.seconds); }}};
  return all;
}

std::string in_digits(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

/// A star where the energy has converged.
std::string cell_of(const IterationPoint& point) {
  return in_digits(point.energy, "%.1f, ") +
         (point.excess ? in_digits(*point.excess, "%.2f, ") : "-, ") +
         in_digits(point.share, "%.1f, ") + in_digits(point.seconds, "%.2f") +
         (point.converged ? " *" + std::to_string(point.ran) : "");
}

std::vector<std::string> subjects_of(const std::vector<IterationCurve>& curves) {
  std::vector<std::string> names;
  for (const IterationCurve& curve : curves) {
    if (std::ranges::find(names, curve.subject) == names.end()) names.push_back(curve.subject);
  }
  return names;
}

/// A line for each K; a curve that converged early ends there.
Chart chart_of(const std::vector<IterationCurve>& curves, const std::string& subject,
               const Measure& measure) {
  Chart chart;
  chart.title = subject;
  chart.x = {"iterations", ChartScale::logarithmic};
  chart.y = measure.axis;
  for (const IterationCurve& curve : curves) {
    if (curve.subject != subject) continue;
    ChartSeries series{"K = " + std::to_string(curve.components), {}, {}};
    for (const IterationPoint& point : curve.points) {
      const auto value = measure.value(point);
      const bool is_shown = value && (measure.axis.scale == ChartScale::linear || *value > 0);
      if (!is_shown || (!series.x.empty() && series.x.back() == point.ran)) continue;
      series.x.push_back(point.ran);
      series.y.push_back(*value);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Image below_each_other(const std::vector<Image>& rows) {
  Image all(rows.front().width, 0);
  for (const Image& row : rows) {
    all.height += row.height;
    all.pixels.insert(all.pixels.end(), row.pixels.begin(), row.pixels.end());
  }
  return all;
}

}  // namespace

std::vector<IterationCurve> iteration_curves(const Subject& subject, bool quick) {
  const std::vector<int> counts = quick ? std::vector{5} : std::vector{10, 30, 40};
  const std::vector<int> iterations =
      quick ? std::vector{2, 4} : std::vector{10, 20, 30, 50, 100, 200};
  const Source source = prepare_source(subject.performance);
  const Target target{subject.name, subject.target};
  const EvaluatedTransfer full = evaluate_full(source, target);
  std::vector<IterationCurve> curves;
  for (const int count : counts) {
    IterationCurve curve{subject.name, count, {}};
    double first_energy = 0;
    for (const int allowed : iterations) {
      const AnalysisOptions options{.count = count, .iterations = allowed};
      const std::clock_t start = std::clock();
      const Analysis analysis = analyse(source, options);
      const Regions regions = RegionCompleter(analysis, {})(choose_regions(analysis), target, {});
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      const Components& components = analysis.components;
      const EvaluationRow row = evaluate_by(regions, full, source, target).row;
      const double energy = components.energies.at(components.iteration - 1);
      if (curve.points.empty()) first_energy = energy;
      curve.points.push_back({allowed, static_cast<int>(components.energies.size()),
                              *components.converged, 100 * energy / first_energy,
                              row.mpe_all ? std::optional(-*row.mpe_all) : std::nullopt,
                              100 * row.triangle_share, seconds});
      std::fprintf(stderr, "  %s, K %d, %d iterations: %s\n", subject.name.c_str(), count, allowed,
                   cell_of(curve.points.back()).c_str());
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

std::string table_of(const std::vector<IterationCurve>& curves) {
  std::string head = "| | K |", rule = "| --- | --- |", lines;
  for (const IterationPoint& point : curves.front().points) {
    head += ' ' + std::to_string(point.allowed) + " |";
    rule += " --- |";
  }
  for (const IterationCurve& curve : curves) {
    lines += "| " + curve.subject + " | " + std::to_string(curve.components) + " |";
    for (const IterationPoint& point : curve.points) lines += ' ' + cell_of(point) + " |";
    lines += '\n';
  }
  return head + '\n' + rule + '\n' + lines;
}

Image picture_of(const std::vector<IterationCurve>& curves) {
  ChartSize size{.width = 440, .height = 230, .letters = 17};
  std::vector<Image> rows;
  for (const Measure& measure : measures()) {
    std::vector<Chart> charts;
    const bool is_first = &measure == &measures().front(), is_last = &measure == &measures().back();
    for (const std::string& subject : subjects_of(curves)) {
      charts.push_back(chart_of(curves, subject, measure));
      // Columns are named at the top, lines and iterations at the bottom.
      if (!is_first) charts.back().title.clear();
      if (!is_last) charts.back().x.label.clear();
      charts.back().legend = is_last;
    }
    constexpr int kLegend = 100;
    if (is_last) size.height += kLegend;
    rows.push_back(draw(charts, size));
  }
  return below_each_other(rows);
}

}  // namespace mimetra::bench
