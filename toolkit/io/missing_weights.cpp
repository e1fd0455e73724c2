#include "toolkit/io/missing_weights.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

std::vector<int> rows_without_weights(const Eigen::MatrixXd& weights) {
  std::vector<int> rows;
  for (int row = 0; row < weights.rows(); ++row) {
    if (weights.row(row).array().isNaN().all()) rows.push_back(row);
  }
  return rows;
}

/// \pre one weight at least is not NaN
void fill_gaps(const Eigen::VectorXd& times, Eigen::Ref<Eigen::VectorXd> weights) {
  std::vector<Eigen::Index> seen;
  for (Eigen::Index f = 0; f < weights.size(); ++f) {
    if (!std::isnan(weights[f])) seen.push_back(f);
  }
  for (Eigen::Index f = 0; f < weights.size(); ++f) {
    if (!std::isnan(weights[f])) continue;
    const auto next = std::ranges::lower_bound(seen, f);
    const Eigen::Index after = next == seen.end() ? seen.back() : *next;
    const Eigen::Index before = next == seen.begin() ? after : *std::prev(next);
    const double share =
        after > before ? (times[f] - times[before]) / (times[after] - times[before]) : 0;
    weights[f] = (1 - share) * weights[before] + share * weights[after];
  }
}

}  // namespace

void fill_missing_weights(WeightTrack& track) {
  const std::vector<int> lost = rows_without_weights(track.weights);
  const Eigen::Index rows = track.weights.rows();
  const Eigen::VectorXd times =
      track.times.size() > 0 ? track.times
                             : Eigen::VectorXd::LinSpaced(rows, 0, static_cast<double>(rows - 1));
  std::vector<std::string> gaps;
  for (Eigen::Index column = 0; column < track.weights.cols(); ++column) {
    const auto missing = track.weights.col(column).array().isNaN().count();
    if (missing > std::ssize(lost)) gaps.push_back(track.names[static_cast<std::size_t>(column)]);
    if (missing > 0) fill_gaps(times, track.weights.col(column));
  }
  if (!lost.empty()) {
    track.notes.push_back("rows without weights, which are taken from between their neighbours': " +
                          listed(words_of(lost)));
  }
  if (!gaps.empty()) {
    track.notes.push_back(
        "columns in which weights are missing, which are taken from between their neighbours': " +
        listed(gaps));
  }
}

}  // namespace mimetra
