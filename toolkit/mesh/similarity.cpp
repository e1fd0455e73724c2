#include "toolkit/mesh/similarity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace mimetra {

namespace {

/// Singular values of the covariance below this share of the largest one count as 0.
constexpr double kNoExtent = 1e-9;

/// A mirrored fit wins if its residual is below this share of the proper fit's.
constexpr double kMirroredShare = 0.1;

class CarriedFrames : public FrameSource {
 public:
  CarriedFrames(std::shared_ptr<const FrameSource> source, const Similarity& similarity)
      : FrameSource(source->header()), source_(std::move(source)), similarity_(similarity) {
    header_.rest = similarity_.apply(header_.rest);
  }

  bool is_quick() const override { return source_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    source_->read(first, poses);
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      Eigen::Map<Positions> pose(poses.row(row).data(), vertices(), 3);
      pose = similarity_.apply(pose);
    }
  }

  std::shared_ptr<const FrameSource> source_;
  Similarity similarity_;
};

void check_sizes(const Eigen::Ref<const Positions>& from, const Eigen::Ref<const Positions>& to) {
  if (from.rows() == to.rows() && from.rows() > 0) return;
  throw std::invalid_argument("similarity of " + std::to_string(from.rows()) + " points and " +
                              std::to_string(to.rows()) + ", expected the same number, not 0");
}

struct Centered {
  explicit Centered(const Eigen::Ref<const Positions>& given)
      : center(given.colwise().mean()), positions(given.rowwise() - center) {}

  Eigen::RowVector3d center;
  Positions positions;
};

Similarity between(Similarity fit, const Centered& from, const Centered& to) {
  fit.from = from.center;
  fit.to = to.center;
  return fit;
}

/// Fits between centred points, with or without mirroring, and their residuals.
class CenteredFit {
 public:
  CenteredFit(const Positions& from, const Positions& to)
      : from_(from),
        to_(to),
        factors_(Eigen::Matrix3d(to.transpose().lazyProduct(from)),
                 Eigen::ComputeFullU | Eigen::ComputeFullV),
        is_proper_(factors_.matrixU().determinant() * factors_.matrixV().determinant() > 0) {}

  /// Throws MismatchError if the two smallest singular values cancel. A rotation in their plane
  /// would then change nothing.
  void check_unique() const {
    const Eigen::Vector3d values = factors_.singularValues();
    if (values[1] + (is_proper_ ? 1 : -1) * values[2] > kNoExtent * values[0]) return;
    throw MismatchError(
        "the rest poses lie on a line, or else leave open how one is turned to "
        "the other");
  }

  Similarity with(bool mirrored) const {
    const Eigen::Vector3d signs(1, 1, is_proper_ == mirrored ? -1 : 1);
    Similarity fit;
    fit.rotation = factors_.matrixU() * signs.asDiagonal() * factors_.matrixV().transpose();
    fit.scale = factors_.singularValues().dot(signs) / from_.squaredNorm();
    return fit;
  }

  double residual(const Similarity& fit) const { return (fit.apply(from_) - to_).norm(); }

 private:
  const Positions& from_;
  const Positions& to_;
  Eigen::JacobiSVD<Eigen::Matrix3d> factors_;
  bool is_proper_;
};

}  // namespace

Positions Similarity::apply(const Eigen::Ref<const Positions>& positions) const {
  if (is_identity()) return positions;
  const Eigen::Matrix3d turned = (scale * rotation).transpose();
  const Positions centered = positions.rowwise() - from.transpose();
  return Positions(centered.lazyProduct(turned)).rowwise() + to.transpose();
}

RigidTransform Similarity::carry(const RigidTransform& motion) const {
  if (is_identity() || motion.is_identity()) return motion;
  RigidTransform carried;
  carried.rotation = rotation * motion.rotation * rotation.transpose();
  const Eigen::Vector3d center = motion.rotation * from + motion.translation;
  carried.translation = scale * (rotation * (center - from)) + to - carried.rotation * to;
  return carried;
}

double Similarity::angle() const {
  const double cosine = ((mirrors() ? -1 : 1) * rotation.trace() - 1) / 2;
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
}

bool Similarity::mirrors() const {
  return rotation.determinant() < 0;
}

bool Similarity::is_identity() const {
  return scale == 1 && rotation == Eigen::Matrix3d::Identity() && from == to;
}

Similarity similarity_fit(const Eigen::Ref<const Positions>& from,
                          const Eigen::Ref<const Positions>& to) {
  check_sizes(from, to);
  if (from == to) return {};
  const Centered a(from), b(to);
  const CenteredFit fit(a.positions, b.positions);
  fit.check_unique();
  const Similarity proper = fit.with(false), mirrored = fit.with(true);
  const bool mirrors = fit.residual(mirrored) < kMirroredShare * fit.residual(proper);
  return between(mirrors ? mirrored : proper, a, b);
}

Similarity similarity_fit(const Eigen::Ref<const Positions>& from,
                          const Eigen::Ref<const Positions>& to, Handedness handedness) {
  check_sizes(from, to);
  const Centered a(from), b(to);
  const CenteredFit fit(a.positions, b.positions);
  fit.check_unique();
  return between(fit.with(handedness == Handedness::mirrored), a, b);
}

Similarity scaling_fit(const Eigen::Ref<const Positions>& from,
                       const Eigen::Ref<const Positions>& to) {
  check_sizes(from, to);
  if (from == to) return {};
  const Centered a(from), b(to);
  const double size_a = a.positions.norm(), size_b = b.positions.norm();
  if (size_a == 0 || size_b == 0) throw MismatchError("a rest pose has no size");
  Similarity fit;
  fit.scale = size_b / size_a;
  return between(fit, a, b);
}

std::shared_ptr<const FrameSource> carried(std::shared_ptr<const FrameSource> source,
                                           const Similarity& similarity) {
  if (similarity.is_identity()) return source;
  return std::make_shared<const CarriedFrames>(std::move(source), similarity);
}

}  // namespace mimetra
