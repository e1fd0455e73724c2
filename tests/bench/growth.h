#pragma once

#include <string>
#include <vector>

#include "tests/bench/suite.h"
#include "toolkit/drawing/chart.h"

namespace mimetra::bench {

/// How the time of one computation grows with one size, all else equal.
struct Growth {
  std::string what;
  std::string against;          ///< "vertices", "frames", "K"
  std::vector<double> sizes;    ///< ascending
  std::vector<double> seconds;  ///< medians
  double exponent = 0;          ///< least squares line of log seconds over log size
};

/// One for each computation of which `rows` holds several sizes; `against` as in Growth.
std::vector<Growth> growths(const std::vector<Row>& rows, const std::string& against,
                            int Size::*size);

/// Times over sizes on logarithmic axes.
Chart chart_of(const std::vector<Growth>& growths, const std::string& title);

}  // namespace mimetra::bench
