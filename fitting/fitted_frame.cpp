#include "fitting/fitted_frame.h"

#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>

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

namespace {

using CameraVector = Eigen::Vector<double, 8>;

/// Deviation of the rows a and b of a camera from a scaled orthographic one, as shares of their
/// length: (|a|^2 - |b|^2) / (|a|^2 + |b|^2) and 2 a.b / (|a|^2 + |b|^2).
Eigen::Vector2d stretch_of(const AffineCamera& camera) {
  const auto a = camera.row(0).head<3>(), b = camera.row(1).head<3>();
  const double sum = a.squaredNorm() + b.squaredNorm();
  return Eigen::Vector2d(a.squaredNorm() - b.squaredNorm(), 2 * a.dot(b)) / sum;
}

/// Derivative of stretch_of() by the eight numbers of the camera.
Eigen::Matrix<double, 2, 8> stretch_derivative(const AffineCamera& camera) {
  const auto a = camera.row(0).head<3>(), b = camera.row(1).head<3>();
  const double sum = a.squaredNorm() + b.squaredNorm();
  const Eigen::Vector2d g = stretch_of(camera);
  Eigen::Matrix<double, 2, 8> derivative = Eigen::Matrix<double, 2, 8>::Zero();
  derivative.block<1, 3>(0, 0) = 2 * (1 - g[0]) * a / sum;
  derivative.block<1, 3>(0, 4) = -2 * (1 + g[0]) * b / sum;
  derivative.block<1, 3>(1, 0) = 2 * (b - g[1] * a) / sum;
  derivative.block<1, 3>(1, 4) = 2 * (a - g[1] * b) / sum;
  return derivative;
}

/// Nearest camera with orthogonal rows of equal length that projects `centre` to the same place.
AffineCamera without_stretch(const AffineCamera& camera, const Eigen::Vector3d& centre) {
  const Eigen::Matrix<double, 2, 3> C = camera.leftCols<3>();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(C, Eigen::ComputeThinU | Eigen::ComputeThinV);
  AffineCamera result;
  result.leftCols<3>() = svd.singularValues().mean() * svd.matrixU() * svd.matrixV().transpose();
  result.col(3) = camera.col(3) + (C - result.leftCols<3>()) * centre;
  return result;
}

/// Pixels per unit of the model.
double scale_of(const AffineCamera& camera) {
  return std::sqrt(camera.leftCols<3>().squaredNorm() / 2);
}

}  // namespace

FittedFrame::FittedFrame(std::shared_ptr<const LandmarkRows> rows, ImagePoints image, double sigma,
                         const CameraModel& model)
    : rows_(std::move(rows)),
      image_(std::move(image)),
      radius_(rms_radius(image_)),
      sigma_(sigma),
      landmark_weights_(Eigen::VectorXd::Ones(image_.rows())) {
  set_alpha(Eigen::VectorXd::Zero(rows_->identities.size()));
  set_beta(Eigen::VectorXd::Zero(rows_->expressions.size()));
  estimate_camera();
  if (model.is_affine()) return;
  model_ = model;
  camera_ = without_stretch(camera_, points().colwise().mean().transpose());
  estimate_camera();
}

void FittedFrame::set_alpha(const Eigen::VectorXd& alpha) {
  alpha_ = alpha;
  identity_ = rows_->identities.displacement(alpha);
}

void FittedFrame::set_beta(const Eigen::VectorXd& beta) {
  beta_ = beta;
  expression_ = rows_->expressions.displacement(beta);
}

Eigen::RowVector4d FittedFrame::depth_row() const {
  const Eigen::RowVector3d a = camera_.row(0).head<3>(), b = camera_.row(1).head<3>();
  Eigen::RowVector4d row(0, 0, 0, 1);
  if (model_.nearness > 0) row.head<3>() = model_.nearness / scale_of(camera_) * a.cross(b);
  return row;
}

Eigen::VectorXd FittedFrame::shrinking(const ModelPoints& points) const {
  // Points behind the camera are not visible: a face is at least half its distance away.
  constexpr double kNearest = 0.5;
  const Eigen::Vector3d away = depth_row().head<3>();
  return (1 + (points * away).array()).max(kNearest).inverse();
}

ImagePoints FittedFrame::projected(const ModelPoints& points) const {
  ImagePoints image = points * camera_.leftCols<3>().transpose();
  if (model_.nearness > 0) image.array().colwise() *= shrinking(points).array();
  return image.rowwise() + camera_.col(3).transpose();
}

void FittedFrame::estimate_camera() {
  constexpr int kSteps = 20;
  constexpr double kEnough = 1e-12;
  constexpr double kSmallest = 1e-3;
  const bool plain = model_.is_affine() && model_.nearness == 0 && !outline_ &&
                     (landmark_weights_.array() == 1).all();
  if (plain) {
    camera_ = estimate_affine_camera(points(), image_);
    return;
  }
  double before = misfit();
  for (int step = 0; step < kSteps; ++step) {
    const Linear linear = camera_only();
    Eigen::Matrix<double, 8, 8> normal = linear.camera.transpose() * linear.camera;
    normal.diagonal() *= 1 + 1e-12;
    const CameraVector change = normal.ldlt().solve(linear.camera.transpose() * linear.residual);
    const AffineCamera from = camera_;
    double now = before;
    for (double share = 1; share > kSmallest; share /= 2) {
      camera_.row(0) = from.row(0) + share * change.head<4>().transpose();
      camera_.row(1) = from.row(1) + share * change.tail<4>().transpose();
      now = misfit();
      if (now < before) break;
      camera_ = from;
      now = before;
    }
    if (!(before - now > kEnough * before)) return;
    before = now;
  }
}

ImagePoints FittedFrame::residual() const {
  return image_ - projected(points());
}

ImagePoints FittedFrame::residual_without_identity() const {
  return image_ - project(camera_, rows_->mean + expression_);
}

ImagePoints FittedFrame::residual_without_expression() const {
  return image_ - project(camera_, rows_->mean + identity_);
}

ModelPoints FittedFrame::outline_points() const {
  Eigen::VectorXd x(alpha_.size() + beta_.size());
  x << alpha_, beta_;
  return outline_->mean + (outline_->basis * x).reshaped(outline_->mean.rows(), 3);
}

Eigen::VectorXd FittedFrame::outline_residual() const {
  if (!outline_) return {};
  const ImagePoints difference = outline_->image - projected(outline_points());
  return (difference.array() * outline_->normals.array()).rowwise().sum();
}

double FittedFrame::misfit() const {
  const double landmarks =
      (residual().rowwise().squaredNorm().array() * landmark_weights_.array()).sum();
  const double outline =
      outline_ ? (outline_residual().array().square() * outline_->weight.array()).sum() : 0;
  double sum = weight() * (landmarks + outline);
  if (!model_.is_affine()) {
    sum += stretch_of(camera_).squaredNorm() / (2 * model_.stretch * model_.stretch);
  }
  return sum;
}

FittedFrame::Linear FittedFrame::camera_only() const {
  const ModelPoints landmarks = points();
  const Eigen::Index n = image_.rows(), m = outline_ ? outline_->image.rows() : 0;
  const Eigen::Index stretch = model_.is_affine() ? 0 : 2;
  Linear linear{Eigen::VectorXd::Zero(2 * n + m + stretch),
                Eigen::MatrixXd::Zero(2 * n + m + stretch, 8),
                {}};
  const Eigen::VectorXd factors = (weight() * landmark_weights_).cwiseSqrt();
  const Eigen::VectorXd shrunk = factors.cwiseProduct(shrinking(landmarks));
  const ImagePoints rest = residual();
  for (Eigen::Index axis = 0; axis < 2; ++axis) {
    const auto rows = Eigen::seqN(axis * n, n);
    linear.residual(rows) = factors.cwiseProduct(rest.col(axis));
    linear.camera(rows, Eigen::seqN(4 * axis, 3)) = shrunk.asDiagonal() * landmarks;
    linear.camera(rows, 4 * axis + 3) = factors;
  }
  if (m > 0) {
    const ModelPoints X = outline_points();
    const Eigen::VectorXd factor = (weight() * outline_->weight).cwiseSqrt();
    const Eigen::VectorXd near = shrinking(X);
    linear.residual.segment(2 * n, m) = factor.cwiseProduct(outline_residual());
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      const Eigen::VectorXd across = factor.cwiseProduct(outline_->normals.col(axis));
      linear.camera.block(2 * n, 4 * axis, m, 3) = across.cwiseProduct(near).asDiagonal() * X;
      linear.camera.block(2 * n, 4 * axis + 3, m, 1) = across;
    }
  }
  if (stretch > 0) {
    const double factor = 1 / (std::sqrt(2.0) * model_.stretch);
    linear.residual.tail<2>() = -factor * stretch_of(camera_);
    linear.camera.bottomRows<2>() = factor * stretch_derivative(camera_);
  }
  return linear;
}

FittedFrame::Linear FittedFrame::linear() const {
  Linear linear = camera_only();
  const Eigen::MatrixXd& basis = rows_->both.rows();
  const Eigen::Index n = image_.rows(), m = outline_ ? outline_->image.rows() : 0;
  linear.basis.setZero(linear.residual.size(), basis.cols());
  const auto C = camera_.leftCols<3>();
  const Eigen::VectorXd factors =
      (weight() * landmark_weights_).cwiseSqrt().cwiseProduct(shrinking(points()));
  for (Eigen::Index row = 0; row < 2; ++row) {
    auto seen = linear.basis.middleRows(row * n, n);
    seen = C(row, 0) * basis.topRows(n) + C(row, 1) * basis.middleRows(n, n) +
           C(row, 2) * basis.bottomRows(n);
    seen.array().colwise() *= factors.array();
  }
  if (m > 0) {
    const Eigen::VectorXd factor =
        (weight() * outline_->weight).cwiseSqrt().cwiseProduct(shrinking(outline_points()));
    const ModelPoints across = outline_->normals * C;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      linear.basis.middleRows(2 * n, m) += factor.cwiseProduct(across.col(axis)).asDiagonal() *
                                           outline_->basis.middleRows(axis * m, m);
    }
  }
  return linear;
}

double energy(const std::vector<FittedFrame>& frames, bool one_identity, double ridge,
              double prior) {
  double sum = one_identity ? prior * frames.front().alpha().squaredNorm() : 0;
  for (const FittedFrame& frame : frames) {
    sum += frame.misfit() + ridge * frame.beta().squaredNorm();
    if (!one_identity) sum += prior * frame.alpha().squaredNorm();
  }
  return sum;
}

bool has_converged(double before, double after, double tolerance) {
  return before - after < tolerance * before;
}

}  // namespace mimetra
