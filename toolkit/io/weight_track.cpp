#include "toolkit/io/weight_track.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "toolkit/io/frame_times.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/model/expression_names.h"

namespace mimetra {

namespace {

int column_of(const std::vector<std::string>& names, const std::string& expression) {
  using Spelling = std::string (*)(const std::string&);
  const Spelling as_is = [](const std::string& name) { return name; };
  for (const Spelling spelling : {as_is, Spelling(spelled_out), Spelling(without_side)}) {
    const std::string wanted = spelling(expression);
    const auto exact = std::ranges::find(names, wanted);
    if (exact != names.end()) return static_cast<int>(exact - names.begin());
    const auto loose = std::ranges::find(names, folded_name(wanted), folded_name);
    if (loose != names.end()) return static_cast<int>(loose - names.begin());
    if (spelling != Spelling(spelled_out)) continue;
    const auto of_column =
        std::ranges::find(names, folded_name(wanted),
                          [](const std::string& name) { return folded_name(spelled_out(name)); });
    if (of_column != names.end()) return static_cast<int>(of_column - names.begin());
  }
  const std::string shape = without_node(expression);
  return shape == expression ? -1 : column_of(names, shape);
}

/// Column names without the node at their start, if they stay unique.
std::vector<std::string> shapes_of_nodes(const std::vector<std::string>& columns) {
  std::map<std::string, int> times;
  for (const std::string& column : columns) ++times[without_node(column)];
  std::vector<std::string> shapes;
  for (const std::string& column : columns) {
    const std::string shape = without_node(column);
    shapes.push_back(times[shape] == 1 ? shape : column);
  }
  return shapes;
}

}  // namespace

WeightMatch match_weights(const WeightTrack& track, const std::vector<std::string>& expressions) {
  WeightMatch match;
  std::vector<bool> used(track.names.size(), false);
  const std::vector<std::string> shapes = shapes_of_nodes(track.names);
  for (const std::string& expression : expressions) {
    int column = column_of(track.names, expression);
    // The model and the columns may use different nodes.
    if (column < 0 && without_node(expression) == expression) {
      column = column_of(shapes, expression);
    }
    match.column.push_back(column);
    if (column >= 0)
      used[static_cast<std::size_t>(column)] = true;
    else
      match.undriven_expressions.push_back(expression);
  }
  for (std::size_t column = 0; column < used.size(); ++column) {
    if (!used[column]) match.unmatched_columns.push_back(track.names[column]);
  }
  return match;
}

Eigen::MatrixXd weights_for(const WeightTrack& track, const std::vector<std::string>& expressions) {
  if (expressions.empty()) {
    throw MismatchError("the model has no expressions that weights could drive");
  }
  const WeightMatch match = match_weights(track, expressions);
  if (match.undriven_expressions.size() == expressions.size()) {
    throw MismatchError(
        "no weight is named like an expression of the model: the weights begin with '" +
        (track.names.empty() ? "" : track.names.front()) + "', the expressions with '" +
        expressions.front() + "'");
  }
  Eigen::MatrixXd weights =
      Eigen::MatrixXd::Zero(track.weights.rows(), static_cast<Eigen::Index>(expressions.size()));
  for (std::size_t j = 0; j < expressions.size(); ++j) {
    if (match.column[j] >= 0) {
      weights.col(static_cast<Eigen::Index>(j)) = track.weights.col(match.column[j]);
    }
  }
  return weights;
}

namespace {

std::vector<int> rows_without_weights(const Eigen::MatrixXd& weights) {
  std::vector<int> rows;
  for (int row = 0; row < weights.rows(); ++row) {
    if (weights.row(row).array().isNaN().all()) rows.push_back(row);
  }
  return rows;
}

/// \pre at least one weight is not NaN
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

void note_odd_times(WeightTrack& track) {
  const std::string odd = note_on_steps(track.times);
  if (odd.empty() || std::ranges::find(track.notes, odd) != track.notes.end()) return;
  track.notes.push_back(odd);
}

void scale_weights(const std::string& name, WeightTrack& track,
                   const std::vector<std::string>& expressions, std::optional<double> scale) {
  if (scale) {
    track.weights *= *scale;
    return;
  }
  if (track.is_fit) return;
  constexpr double kLargest = 2;  // usual weights are 0 to 1, or slightly beyond
  for (const int column : match_weights(track, expressions).column) {
    if (column < 0 || track.weights.rows() == 0) continue;
    Eigen::Index frame = 0;
    if (!(track.weights.col(column).cwiseAbs().maxCoeff(&frame) > kLargest)) continue;
    throw IoError(name, "the weight of '" + track.names[static_cast<std::size_t>(column)] +
                            "' is " + readable(track.weights(frame, column)) + " in frame " +
                            std::to_string(frame) +
                            ", expected 0 to 1; option 'weight-scale' multiplies weights: 0.01 "
                            "where they are in percent, 1 to take them as they are");
  }
}

}  // namespace mimetra
