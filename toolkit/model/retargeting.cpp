#include "toolkit/model/retargeting.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "toolkit/mesh/rounding.h"

namespace mimetra {
namespace {

/// Tolerance relative to the largest element or eigenvalue. It covers digits lost in a file and
/// rounding of a sum over a mesh.
constexpr double kGramTolerance = 1e-9;

void check_unique(const std::vector<std::string>& names, const std::string& whose) {
  if (names.empty()) throw std::invalid_argument("the " + whose + " has no expressions");
  std::set<std::string> seen;
  for (const std::string& name : names) {
    if (name.empty()) throw std::invalid_argument("an expression of the " + whose + " has no name");
    if (!seen.insert(name).second) {
      throw std::invalid_argument("the " + whose + " has the expression '" + name + "' twice");
    }
  }
}

void check_shape(const Eigen::MatrixXd& matrix, Eigen::Index rows, Eigen::Index columns,
                 const std::string& name) {
  if (matrix.rows() != rows || matrix.cols() != columns) {
    throw std::invalid_argument(name + " is " + std::to_string(matrix.rows()) + " x " +
                                std::to_string(matrix.cols()) + ", expected " +
                                std::to_string(rows) + " x " + std::to_string(columns));
  }
  if (!matrix.allFinite()) throw std::invalid_argument(name + " holds what is not finite");
}

void check_bounds(const Retargeting& map) {
  for (Eigen::Index j = 0; j < map.lower.size(); ++j) {
    if (map.lower[j] <= map.upper[j]) continue;
    throw std::invalid_argument("the bounds of '" + map.target_names[static_cast<std::size_t>(j)] +
                                "' cross: the lower one is above the upper one");
  }
}

void check_gram(const Eigen::MatrixXd& gram) {
  const double most = gram.cwiseAbs().maxCoeff();
  Eigen::Index row = 0, column = 0;
  if ((gram - gram.transpose()).cwiseAbs().maxCoeff(&row, &column) > kGramTolerance * most) {
    throw std::invalid_argument("the Gram matrix is not symmetric in row " + std::to_string(row) +
                                ", column " + std::to_string(column));
  }
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  if (values[0] < -kGramTolerance * std::max(values[values.size() - 1], 0.0)) {
    throw std::invalid_argument("the Gram matrix has a negative eigenvalue");
  }
}

}  // namespace

std::vector<Eigen::Index> Retargeting::free() const {
  std::vector<Eigen::Index> indices;
  for (Eigen::Index j = 0; j < lower.size(); ++j) {
    if (lower[j] < upper[j]) indices.push_back(j);
  }
  return indices;
}

void Retargeting::check() const {
  check_unique(source_names, "source");
  check_unique(target_names, "target");
  const auto sources = static_cast<Eigen::Index>(source_names.size());
  const auto targets = static_cast<Eigen::Index>(target_names.size());
  check_shape(gram, targets, targets, "the Gram matrix");
  check_shape(linear, targets, sources, "the linear part");
  check_shape(lower, targets, 1, "the lower bounds' list");
  check_shape(upper, targets, 1, "the upper bounds' list");
  check_bounds(*this);
  check_gram(gram);
}

Eigen::MatrixXd plain_matrix(const Retargeting& map) {
  map.check();
  fix_product_blocking();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(map.linear.rows(), map.linear.cols());
  const std::vector<Eigen::Index> free = map.free();
  if (free.empty()) return matrix;
  const Eigen::MatrixXd gram = map.gram(free, free), linear = map.linear(free, Eigen::all);
  const Eigen::MatrixXd solved =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(gram).solve(linear);
  matrix(free, Eigen::all) = solved;
  return matrix;
}

Eigen::MatrixXd multiplied(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& weights) {
  check_shape(weights, weights.rows(), matrix.cols(), "the weights' table");
  fix_product_blocking();
  return weights * matrix.transpose();
}

Eigen::MatrixXd clipped(const Eigen::MatrixXd& weights, const Retargeting& map) {
  check_shape(weights, weights.rows(), map.lower.size(), "the weights' table");
  Eigen::MatrixXd result = weights;
  for (Eigen::Index j = 0; j < result.cols(); ++j) {
    result.col(j) = result.col(j).cwiseMax(map.lower[j]).cwiseMin(map.upper[j]);
  }
  return result;
}

WeightDifference difference_of(const Eigen::MatrixXd& weights, const Eigen::MatrixXd& others) {
  if (weights.rows() != others.rows() || weights.cols() != others.cols()) {
    throw std::invalid_argument("weights of different sizes are compared");
  }
  if (weights.size() == 0) return {};
  const Eigen::ArrayXXd difference = (weights - others).array().abs();
  return {std::sqrt(difference.square().mean()), difference.mean(), difference.maxCoeff()};
}

}  // namespace mimetra
