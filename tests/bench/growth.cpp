#include "tests/bench/growth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Core>

namespace mimetra::bench {
namespace {

double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto logs = [](const std::vector<double>& values) {
    const Eigen::Map<const Eigen::ArrayXd> all(values.data(),
                                               static_cast<Eigen::Index>(values.size()));
    const Eigen::ArrayXd log = all.log();
    return Eigen::ArrayXd(log - log.mean());
  };
  const Eigen::ArrayXd a = logs(x), b = logs(y);
  return (a * b).sum() / a.square().sum();
}

std::string with_exponent(const Growth& growth) {
  char text[32];
  std::snprintf(text, sizeof text, ": exponent %.2f", growth.exponent);
  return growth.what + text;
}

}  // namespace

std::vector<Growth> growths(const std::vector<Row>& rows, const std::string& against,
                            int Size::*size) {
  std::vector<Growth> all;
  for (const Row& row : rows) {
    auto found = std::ranges::find(all, row.what, &Growth::what);
    if (found == all.end()) found = all.insert(all.end(), {row.what, against, {}, {}, 0});
    found->sizes.push_back(row.size.*size);
    found->seconds.push_back(row.median());
  }
  std::erase_if(all, [](const Growth& growth) { return growth.sizes.size() < 2; });
  for (Growth& growth : all) growth.exponent = slope(growth.sizes, growth.seconds);
  return all;
}

Chart chart_of(const std::vector<Growth>& growths, const std::string& title) {
  Chart chart;
  chart.title = title;
  chart.x = {growths.front().against, ChartScale::logarithmic};
  chart.y = {"time (ms)", ChartScale::logarithmic};
  for (const Growth& growth : growths) {
    ChartSeries series{with_exponent(growth), growth.sizes, growth.seconds};
    for (double& y : series.y) y *= 1e3;
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace mimetra::bench
