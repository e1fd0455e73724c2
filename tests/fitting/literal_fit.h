#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include "fitting/landmark_fitter.h"

/// The paper's fit of one frame, transcribed with dense matrices.
namespace mimetra::test {

/// Moves points (n x D) to their centroid and scales them to a mean distance of `distance`.
inline Eigen::MatrixXd normalization(const Eigen::MatrixXd& points, double distance) {
  const Eigen::Index d = points.cols();
  const Eigen::RowVectorXd centre = points.colwise().mean();
  const double scale = distance / (points.rowwise() - centre).rowwise().norm().mean();
  Eigen::MatrixXd T = scale * Eigen::MatrixXd::Identity(d + 1, d + 1);
  T(d, d) = 1;
  T.col(d).head(d) = -scale * centre.transpose();
  return T;
}

/// Algorithm 14.1 of Hartley and Zisserman: P = T^-1 P~ U from A_8 p = b.
inline AffineCamera literal_camera(const Eigen::MatrixXd& points, const Eigen::MatrixXd& image) {
  const Eigen::Index n = points.rows();
  const Eigen::MatrixXd T = normalization(image, std::sqrt(2.0));
  const Eigen::MatrixXd U = normalization(points, std::sqrt(3.0));
  const Eigen::MatrixXd x = image.rowwise().homogeneous() * T.transpose();
  const Eigen::MatrixXd X = points.rowwise().homogeneous() * U.transpose();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 8);
  Eigen::VectorXd b(2 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    A.block(2 * i, 0, 1, 4) = X.row(i);
    A.block(2 * i + 1, 4, 1, 4) = X.row(i);
    b.segment<2>(2 * i) = x.row(i).head<2>().transpose();
  }
  const Eigen::VectorXd p = A.colPivHouseholderQr().solve(b);
  Eigen::MatrixXd P(3, 4);
  P << p.head<4>().transpose(), p.tail<4>().transpose(), Eigen::RowVector4d(0, 0, 0, 1);
  return (T.inverse() * P * U).topRows<2>();
}

/// Minimum of |A x + b|^2 + ridge |x|^2 over 0 <= x <= upper: the best of all choices of variables
/// at their bounds whose free variables keep within theirs.
inline Eigen::VectorXd literal_box(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double upper,
                                   double ridge) {
  const Eigen::Index size = A.cols();
  int choices = 1;
  for (Eigen::Index j = 0; j < size; ++j) choices *= 3;
  Eigen::VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (int choice = 0; choice < choices; ++choice) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
    std::vector<Eigen::Index> free;
    for (Eigen::Index j = 0, rest = choice; j < size; ++j, rest /= 3) {
      if (rest % 3 == 2) free.push_back(j);
      if (rest % 3 == 1) x[j] = upper;
    }
    if (!x.allFinite()) continue;
    const auto count = static_cast<Eigen::Index>(free.size());
    Eigen::MatrixXd system(A.rows() + count, count);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(A.rows() + count);
    system << A(Eigen::all, free), std::sqrt(ridge) * Eigen::MatrixXd::Identity(count, count);
    right.head(A.rows()) = -b - A * x;
    if (count > 0) x(free) = system.colPivHouseholderQr().solve(right);
    if (!((x.array() >= 0).all() && (x.array() <= upper).all())) continue;
    const double energy = (A * x + b).squaredNorm() + ridge * x.squaredNorm();
    if (energy < least) {
      least = energy;
      best = x;
    }
  }
  return best;
}

/// Equations 3 to 5 in the paper's symbols: homogeneous points of the landmarks in one column
/// (4n), and P (3n x 4n), the camera for each of them on its diagonal.
class LiteralFit {
 public:
  LiteralFit(const MorphableModel& model, const std::vector<int>& vertices,
             const Eigen::RowVectorXd& points, double sigma, double upper, double ridge)
      : sigma_(sigma),
        upper_(upper),
        ridge_(ridge),
        v_(homogeneous(model.mean().reshaped<Eigen::RowMajor>(), vertices, 1)),
        V_(homogeneous(model.identities().displacements, vertices, 0)),
        B_(homogeneous(model.expressions().displacements, vertices, 0)),
        y_(Eigen::VectorXd::Ones(3 * Eigen::Index(vertices.size()))) {
    for (Eigen::Index i = 0; i < points.size() / 2; ++i) {
      y_.segment<2>(3 * i) = points.segment<2>(2 * i).transpose();
    }
    alpha = Eigen::VectorXd::Zero(V_.cols());
    beta = Eigen::VectorXd::Zero(B_.cols());
  }

  void iterate() {
    estimate_camera();
    optimize_alpha();
    estimate_camera();
    optimize_beta();
  }

  double squared_error() const {
    return (camera_of_all() * (v_ + V_ * alpha + B_ * beta) - y_).squaredNorm();
  }
  double rms() const { return std::sqrt(squared_error() / (double(y_.size()) / 3)); }
  double energy() const {
    return squared_error() / (2 * sigma_ * sigma_) + alpha.squaredNorm() +
           ridge_ * beta.squaredNorm();
  }

  AffineCamera camera;
  Eigen::VectorXd alpha, beta;

 private:
  static Eigen::MatrixXd homogeneous(const Eigen::MatrixXd& fields,
                                     const std::vector<int>& vertices, double last) {
    const auto n = static_cast<Eigen::Index>(vertices.size());
    Eigen::MatrixXd rows = Eigen::MatrixXd::Constant(4 * n, fields.cols(), last);
    for (Eigen::Index i = 0; i < n; ++i) {
      rows.middleRows<3>(4 * i) = fields.middleRows<3>(3 * Eigen::Index(vertices[i]));
    }
    return rows;
  }

  void estimate_camera() {
    const Eigen::VectorXd points = v_ + V_ * alpha + B_ * beta;
    const Eigen::Index n = points.size() / 4;
    camera = literal_camera(points.reshaped(4, n).topRows<3>().transpose(),
                            y_.reshaped(3, n).topRows<2>().transpose());
  }

  Eigen::MatrixXd camera_of_all() const {
    const Eigen::Index n = v_.size() / 4;
    Eigen::MatrixXd P = Eigen::MatrixXd::Zero(3 * n, 4 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      P.block<2, 4>(3 * i, 4 * i) = camera;
      P(3 * i + 2, 4 * i + 3) = 1;
    }
    return P;
  }

  void optimize_alpha() {
    const Eigen::MatrixXd P = camera_of_all(), A = P * V_;
    const Eigen::VectorXd b = P * (v_ + B_ * beta) - y_;
    Eigen::MatrixXd system(A.rows() + A.cols(), A.cols());
    system << A / (std::sqrt(2.0) * sigma_), Eigen::MatrixXd::Identity(A.cols(), A.cols());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(system.rows());
    right.head(b.size()) = -b / (std::sqrt(2.0) * sigma_);
    alpha = system.colPivHouseholderQr().solve(right);
  }

  void optimize_beta() {
    const Eigen::MatrixXd P = camera_of_all();
    beta = literal_box(P * B_, P * (v_ + V_ * alpha) - y_, upper_, 2 * sigma_ * sigma_ * ridge_);
  }

  double sigma_, upper_, ridge_;
  Eigen::VectorXd v_;
  Eigen::MatrixXd V_, B_;
  Eigen::VectorXd y_;
};

}  // namespace mimetra::test
