#include "toolkit/io/weight_track.h"

#include <algorithm>
#include <map>

#include "toolkit/mesh/errors.h"
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

/// The columns without the node that their name begins with, where one of them is called so.
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
    // A node of the model may be another one than that of a column.
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

}  // namespace mimetra
