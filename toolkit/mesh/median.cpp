#include "toolkit/mesh/median.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace mimetra {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double median_difference(const Eigen::VectorXd& values) {
  std::vector<double> differences;
  differences.reserve(static_cast<std::size_t>(values.size()));
  for (Eigen::Index i = 1; i < values.size(); ++i) {
    differences.push_back(values[i] - values[i - 1]);
  }
  return median(std::move(differences));
}

}  // namespace mimetra
