#include "fitting/landmark_rows.h"

#include <numeric>
#include <utility>

namespace mimetra {

namespace {

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& displacements, const std::vector<int>& vertices) {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  Eigen::MatrixXd rows(3 * count, displacements.cols());
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      rows.row(axis * count + i) = displacements.row(3 * Eigen::Index(vertices[i]) + axis);
    }
  }
  return rows;
}

Eigen::MatrixXd some_rows(const Eigen::MatrixXd& all, const std::vector<Eigen::Index>& landmarks) {
  const auto count = static_cast<Eigen::Index>(landmarks.size());
  Eigen::MatrixXd rows(3 * count, all.cols());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    rows.middleRows(axis * count, count) =
        all.middleRows(axis * (all.rows() / 3), all.rows() / 3)(landmarks, Eigen::all);
  }
  return rows;
}

Eigen::MatrixXd side_by_side(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd result(left.rows(), left.cols() + right.cols());
  result << left, right;
  return result;
}

}  // namespace

BasisRows::BasisRows(Eigen::MatrixXd rows)
    : rows_(std::move(rows)), products_(size() * (size() + 1) / 2, 6) {
  constexpr int kPairs[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  const Eigen::Index count = rows_.rows() / 3, size = rows_.cols();
  for (int pair = 0; pair < 6; ++pair) {
    const auto [k, l] = kPairs[pair];
    Eigen::MatrixXd product =
        rows_.middleRows(k * count, count).transpose() * rows_.middleRows(l * count, count);
    if (k != l) product += product.transpose().eval();
    for (Eigen::Index j = 0, at = 0; j < size; at += size - j, ++j) {
      products_.col(pair).segment(at, size - j) = product.col(j).tail(size - j);
    }
  }
}

ModelPoints BasisRows::displacement(const Eigen::VectorXd& coefficients) const {
  ModelPoints points(rows_.rows() / 3, 3);
  points.reshaped().noalias() = rows_ * coefficients;
  return points;
}

Eigen::VectorXd BasisRows::packed_gram(const Eigen::Matrix3d& M) const {
  const Eigen::Vector<double, 6> factors(M(0, 0), M(1, 1), M(2, 2), M(0, 1), M(0, 2), M(1, 2));
  return products_ * factors;
}

Eigen::VectorXd BasisRows::transposed_product(const Axes& C, const ImagePoints& r) const {
  const ModelPoints back = r * C;
  return rows_.transpose() * back.reshaped();
}

Eigen::MatrixXd lower_triangle(const Eigen::VectorXd& packed, Eigen::Index size) {
  Eigen::MatrixXd result(size, size);
  for (Eigen::Index j = 0, at = 0; j < size; at += size - j, ++j) {
    result.col(j).tail(size - j) = packed.segment(at, size - j);
  }
  return result;
}

LandmarkRows::LandmarkRows(const MorphableModel& model, const std::vector<int>& vertices)
    : landmarks(vertices.size()),
      mean(model.mean()(vertices, Eigen::all)),
      identities(rows_of(model.identities().displacements, vertices)),
      expressions(rows_of(model.expressions().displacements, vertices)),
      both(side_by_side(identities.rows(), expressions.rows())) {
  std::iota(landmarks.begin(), landmarks.end(), 0);
}

LandmarkRows::LandmarkRows(const LandmarkRows& all, const std::vector<Eigen::Index>& some)
    : landmarks(some),
      mean(all.mean(some, Eigen::all)),
      identities(some_rows(all.identities.rows(), some)),
      expressions(some_rows(all.expressions.rows(), some)),
      both(side_by_side(identities.rows(), expressions.rows())) {}

}  // namespace mimetra
