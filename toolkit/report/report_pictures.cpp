#include "toolkit/report/report_page.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Maximum number of lines that remain distinguishable in a chart.
constexpr std::size_t kMostLines = 6;

Sheet sheet_seen_from(const ReportView& view) {
  Sheet sheet;
  sheet.viewpoint = view.viewpoint;
  sheet.unit = view.unit;
  return sheet;
}

Tile component_tile(const Components& components, int component, const std::string& unit) {
  const Eigen::Map<const Positions> moved(components.displacements.row(component).data(),
                                          components.vertices(), 3);
  const Eigen::VectorXd lengths = moved.rowwise().norm();
  const double largest = lengths.maxCoeff();
  Tile tile;
  tile.title =
      std::to_string(component) + ": " + readable(largest, 2) + (unit.empty() ? "" : " " + unit);
  tile.positions = components.rest + moved;
  for (const double length : lengths) {
    tile.colors.push_back(even_color(largest > 0 ? length / largest : 0));
  }
  return tile;
}

std::vector<double> to_vector(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

/// Chart of the `columns` of `weights` over time.
Chart weight_chart(const std::string& title, const Eigen::VectorXd& times,
                   const Eigen::MatrixXd& weights, const std::vector<int>& columns,
                   const std::vector<std::string>& names) {
  Chart chart{title, {"time, s"}, {"weight"}, {}};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    chart.series.push_back(
        {names[i], to_vector(times), to_vector(weights.col(columns[i])), {}, false});
  }
  return chart;
}

/// Columns with the largest energy over time, at most kMostLines.
std::vector<int> strongest_columns(const Eigen::MatrixXd& weights) {
  const Eigen::VectorXd energy = weights.colwise().squaredNorm();
  std::vector<int> columns(static_cast<std::size_t>(weights.cols()));
  std::iota(columns.begin(), columns.end(), 0);
  std::ranges::stable_sort(columns, std::greater<>(), [&energy](int j) { return energy[j]; });
  columns.resize(std::min(columns.size(), kMostLines));
  return columns;
}

/// Middle frame of each of `count` equal parts, because performances mostly start and end at rest.
std::vector<int> middle_frames(int frames, int count) {
  const int kept = std::min(frames, count);
  std::vector<int> middles;
  middles.reserve(static_cast<std::size_t>(kept));
  for (int i = 0; i < kept; ++i) {
    middles.push_back(static_cast<int>((2 * std::int64_t{i} + 1) * frames / (2 * kept)));
  }
  return middles;
}

}  // namespace

Sheet report_strip(const ReportStudy& study, const ReportView& view, int columns) {
  StripOptions options;
  options.frames = middle_frames(study.sequence.frames(), columns);
  options.viewpoint = view.viewpoint;
  options.unit = view.unit;
  options.colors = {StripColor::none, "region"};
  options.titles = {"source: " + study.source, "regions of the source that move"};
  std::vector<FieldSequence> rows = {{study.sequence, {}, false},
                                     {study.sequence, fields_of(study.regions), false}};
  const auto add = [&](const MeshSequence& sequence, StripColor color, const std::string& title) {
    rows.push_back({sequence, {}, false});
    options.colors.emplace_back(color);
    options.titles.push_back(title);
  };
  if (study.transfer) {
    const ReportedTransfer& transfer = *study.transfer;
    add(transfer.full, StripColor::none, "target by all triangles: " + transfer.target);
    add(transfer.by_regions, StripColor::none, "target by these regions only");
    // The row above is the transfer by regions.
    add(transfer.full, StripColor::difference, "distance between the two");
  } else {
    add(study.sequence, StripColor::displacement, "distance from the rest pose");
  }
  return film_strip(rows, options);
}

std::vector<int> strongest_components(const Components& components, std::size_t most) {
  const Eigen::VectorXd energy = motion_energy(components);
  std::vector<int> order;
  for (int k = 0; k < components.count(); ++k) {
    if (energy[k] > 0) order.push_back(k);
  }
  std::ranges::stable_sort(order, std::greater<>(), [&energy](int k) { return energy[k]; });
  order.resize(std::min(order.size(), most));
  return order;
}

Sheet component_gallery(const Components& components, const std::vector<int>& shown,
                        const ReportView& view, int columns) {
  Sheet sheet = sheet_seen_from(view);
  const auto connectivity = std::make_shared<const Connectivity>(
      Connectivity::from_triangles(components.vertices(), components.triangles));
  for (std::size_t i = 0; i < shown.size(); ++i) {
    if (i % static_cast<std::size_t>(columns) == 0) {
      sheet.rows.push_back({"", connectivity, {}, {}});
    }
    sheet.rows.back().tiles.push_back(component_tile(components, shown[i], view.unit));
  }
  return sheet;
}

std::vector<Chart> weight_charts(const ReportStudy& study) {
  std::vector<Chart> charts;
  const Eigen::VectorXd& times = study.sequence.times();
  if (study.components) {
    const std::vector<int> columns = strongest_components(*study.components, kMostLines);
    std::vector<std::string> names;
    names.reserve(columns.size());
    for (const int k : columns) names.push_back("component " + std::to_string(k));
    charts.push_back(weight_chart("Weights of the strongest components", times,
                                  study.components->weights, columns, names));
  }
  if (study.transfer && !study.transfer->expressions.empty()) {
    const Eigen::MatrixXd& weights = study.transfer->weights;
    const std::vector<int> columns = strongest_columns(weights);
    std::vector<std::string> names;
    names.reserve(columns.size());
    for (const int column : columns) {
      names.push_back(study.transfer->expressions[static_cast<std::size_t>(column)]);
    }
    charts.push_back(
        weight_chart("Weights of the target's expressions", times, weights, columns, names));
  }
  return charts;
}

std::vector<Chart> table_charts(const ReportedTransfer& transfer, const std::string& unit) {
  ChartSeries error{"over all triangles", {}, {}}, time{"transfer", {}, {}},
      search{"regions", {}, {}};
  for (const EvaluationRow& row : transfer.rows) {
    const double share = 100 * row.triangle_share;
    error.x.push_back(share);
    error.y.push_back(row.de_all);
    time.x.push_back(share);
    time.y.push_back(row.transfer_seconds);
    if (!row.decompose_seconds) continue;
    search.x.push_back(share);
    search.y.push_back(*row.decompose_seconds);
  }
  const ChartAxis share{"triangles in regions, %"};
  std::vector<Chart> charts = {
      {"Error", share, {unit.empty() ? "DE" : "DE, " + unit + " squared"}, {error}},
      {"Time", share, {"seconds"}, {time}}};
  if (!search.x.empty()) charts.back().series.push_back(search);
  return charts;
}

}  // namespace mimetra
