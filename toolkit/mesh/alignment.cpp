#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "toolkit/mesh/alignment.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/rounding.h"

namespace mimetra {
namespace {

/// The robust scale follows the residual that this share of the vertices stays below. As many must
/// be still to separate the head's motion from the face's. If they do not move at all, the scale
/// shrinks to nothing and the fit locks on to them exactly.
constexpr double kStableShare = 0.05;
/// Least factor between the scales of two iterations. The scale starts at the median residual of
/// the plain fit, where every still vertex counts. If it shrank faster, a patch that only looks
/// still because of the jaw's motion could win.
constexpr double kScaleDecay = 0.7;
/// Slow convergence means that no vertices are still; more iterations would not make them so.
constexpr int kMaxIterations = 40;
/// Change of the largest weight at which the motion has settled.
constexpr double kConvergedWeightChange = 1e-6;
/// Weight that every vertex keeps. It fixes the rotation about still vertices on a line, and moves
/// the result of the others by less than 1e-10 of their displacement.
constexpr double kLeastWeight = 1e-10;
/// Least scale as a share of the box diagonal; double precision resolves positions to 1e-15 of it.
constexpr double kLeastScale = 1e-12;
/// Motion below this share of the box diagonal is an effect of kLeastWeight and rounding.
constexpr double kLeastHeadMotion = 1e-9;
/// Number of standard errors of the fit below which motion is noise.
constexpr double kSignificance = 3;
/// Share of the progress that the fit takes; the rest is the pass that judges it.
constexpr double kFitShare = 0.9;

/// Weighted points that are fitted to many other sets of points.
class RigidFitter {
 public:
  RigidFitter(const Eigen::Ref<const Positions>& from, const Eigen::VectorXd& weights)
      : moments_(from.rows(), 4) {
    fix_product_blocking();
    const Eigen::VectorXd shares = weights / weights.sum();
    center_ = from.transpose() * shares;
    moments_.leftCols<3>() = shares.asDiagonal() * (from.rowwise() - center_.transpose());
    moments_.col(3) = shares;
  }

  RigidTransform carry_to(const Eigen::Ref<const Positions>& to) const {
    // Relative to the first point, so that translations far beyond the box cost no digits.
    const Eigen::RowVector3d origin = to.row(0);
    const Eigen::Matrix<double, 3, 4> moments = (to.rowwise() - origin).transpose() * moments_;
    RigidTransform transform;
    transform.rotation = nearest_rotation(moments.leftCols<3>());
    transform.translation = moments.col(3) + origin.transpose() - transform.rotation * center_;
    return transform;
  }

 private:
  Eigen::Vector3d center_;
  Eigen::Matrix<double, Eigen::Dynamic, 4> moments_;
};

/// Transform that carries `rest` to a frame.
RigidTransform motion_to(const PositionsView& frame, const Positions& rest,
                         const RigidFitter& fitter) {
  // A frame that equals the rest pose did not move; rounding would give it a tiny motion.
  return frame != rest ? fitter.carry_to(frame) : RigidTransform();
}

/// Numbers of a transform stored as a row.
constexpr int kTransformNumbers = 12;

using TransformNumbers = Eigen::Matrix<double, 1, kTransformNumbers>;

TransformNumbers numbers_of(const RigidTransform& transform) {
  TransformNumbers numbers;
  numbers << transform.rotation.reshaped().transpose(), transform.translation.transpose();
  return numbers;
}

std::vector<RigidTransform> transforms_of(const FrameRows& numbers) {
  std::vector<RigidTransform> transforms(static_cast<std::size_t>(numbers.rows()));
  for (Eigen::Index f = 0; f < numbers.rows(); ++f) {
    const TransformNumbers row = numbers.row(f);
    transforms[f].rotation = row.head<9>().reshaped(3, 3);
    transforms[f].translation = row.tail<3>();
  }
  return transforms;
}

std::vector<RigidTransform> fit_frames(const FrameSource& source, const Eigen::VectorXd& weights,
                                       const Context& context) {
  const RigidFitter fitter(source.rest(), weights);
  const FrameNumbers motion = over_frames(
      source, 0, kTransformNumbers,
      [&](int, const FrameBlock& block, FrameRows& numbers) {
        for (int row = 0; row < block.frames(); ++row) {
          numbers.row(row) = numbers_of(motion_to(block.frame(row), source.rest(), fitter));
        }
      },
      context);
  return transforms_of(motion.of_each);
}

/// Computes the squared distance of each vertex of a frame from the moved rest pose (N).
void squared_residuals(const PositionsView& frame, const Positions& rest,
                       const RigidTransform& motion, Eigen::Ref<Eigen::RowVectorXd> squares) {
  const Eigen::Matrix3d rotation = motion.rotation;
  const Eigen::Vector3d translation = motion.translation;
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    const Eigen::Vector3d point = rest.row(v);
    squares[v] =
        (rotation.lazyProduct(point) + translation - frame.row(v).transpose()).squaredNorm();
  }
}

double quantile(Eigen::VectorXd values, double share) {
  const auto index = static_cast<Eigen::Index>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[index];
}

/// Weights of Geman and McClure, which redescend: moving vertices end with almost no influence.
Eigen::VectorXd robust_weights(const Eigen::VectorXd& residuals, double scale) {
  const auto ratios = (residuals.array() / scale).square();
  return (1 + ratios).square().inverse().max(kLeastWeight);
}

/// Motion of the vertices that move least, with the weights and residuals of the fit.
struct StableFit {
  std::vector<RigidTransform> motion;
  Eigen::VectorXd weights;
  /// Root mean square over the frames of each vertex's distance from the moved rest pose (N).
  Eigen::VectorXd residuals;
};

/// Fits all frames once with these weights.
StableFit weighted_fit(const FrameSource& source, Eigen::VectorXd weights, const Context& context) {
  const RigidFitter fitter(source.rest(), weights);
  const int vertices = source.vertices();
  const FrameNumbers found = over_frames(
      source, vertices, kTransformNumbers,
      [&](int, const FrameBlock& block, FrameRows& numbers) {
        for (int row = 0; row < block.frames(); ++row) {
          const PositionsView frame = block.frame(row);
          const RigidTransform motion = motion_to(frame, source.rest(), fitter);
          squared_residuals(frame, source.rest(), motion, numbers.row(row).head(vertices));
          numbers.row(row).tail<kTransformNumbers>() = numbers_of(motion);
        }
      },
      context);
  return {transforms_of(found.of_each), std::move(weights),
          (found.sum / source.frames()).cwiseSqrt()};
}

/// Iteratively reweighted least squares over all frames at once. Each vertex has one weight,
/// because a vertex that is still in only one frame says little. The weights depend only on
/// residuals, so moving each frame rigidly does not change them.
///
/// [Geman, McClure. Statistical methods for tomographic image reconstruction. Bull. ISI 52, 1987],
/// annealed as in [Blake, Zisserman. Visual Reconstruction. MIT Press, 1987]
StableFit fit_stable(const FrameSource& source, const Context& context) {
  const double least_scale = kLeastScale * box_diagonal(source.rest());
  StableFit fit;
  fit.weights = Eigen::VectorXd::Ones(source.vertices());
  std::optional<double> scale;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const double done = iteration;
    fit = weighted_fit(source, std::move(fit.weights),
                       context.part(done / kMaxIterations, (done + 1) / kMaxIterations));
    const double target = std::max(quantile(fit.residuals, kStableShare), least_scale);
    if (target == 0) break;  // every vertex is in one place
    const bool settled = scale == least_scale;
    scale = scale ? std::min(*scale, std::max(target, kScaleDecay * *scale))
                  : std::max(target, quantile(fit.residuals, 0.5));
    const Eigen::VectorXd weights = robust_weights(fit.residuals, *scale);
    const double change = (weights - fit.weights).cwiseAbs().maxCoeff();
    if (settled || change < kConvergedWeightChange) break;
    fit.weights = weights;
  }
  return fit;
}

/// Whether the motion differs from none. Compares the root mean square displacement of the stable
/// vertices with the standard error of a rigid fit to n points with this residual. The six unknowns
/// make that error sqrt(6 / 3n) of the residual.
bool is_significant(const FrameSource& source, const StableFit& fit) {
  const Eigen::VectorXd shares = fit.weights / fit.weights.sum();
  double squares = 0;
  for (const RigidTransform& transform : fit.motion) {
    squares += shares.dot((transform.apply(source.rest()) - source.rest()).rowwise().squaredNorm());
  }
  const double found = std::sqrt(squares / source.frames());
  const double residual = std::sqrt(shares.dot(fit.residuals.cwiseAbs2()));
  const double points = 1 / shares.squaredNorm();
  return found > std::max(kSignificance * residual * std::sqrt(2 / points),
                          kLeastHeadMotion * box_diagonal(source.rest()));
}

using Halves = std::array<Eigen::VectorXd, 2>;

/// Weights of the vertices before and behind the middle of the total weight along `heights`; 0 for
/// the vertices of the other half.
Halves halves_along(const Eigen::VectorXd& heights, const Eigen::VectorXd& weights) {
  std::vector<Eigen::Index> order(heights.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&heights](Eigen::Index v) { return heights[v]; });
  Halves halves = {Eigen::VectorXd::Zero(weights.size()), Eigen::VectorXd::Zero(weights.size())};
  const double middle = weights.sum() / 2;
  double sum = 0;
  for (const Eigen::Index v : order) {
    halves[sum < middle ? 0 : 1][v] = weights[v];
    sum += weights[v];
  }
  return halves;
}

/// Fitters for both halves of the weighted vertices, split across each principal axis.
std::vector<std::array<RigidFitter, 2>> fitters_of_halves(const Positions& rest,
                                                          const Eigen::VectorXd& weights) {
  const Eigen::VectorXd shares = weights / weights.sum();
  const Eigen::RowVector3d center = shares.transpose() * rest;
  const Positions centered = rest.rowwise() - center;
  const Eigen::Matrix3d moments = centered.transpose() * shares.asDiagonal() * centered;
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors();
  std::vector<std::array<RigidFitter, 2>> fitters;
  for (int axis = 0; axis < 3; ++axis) {
    const Halves halves = halves_along(centered * axes.col(axis), weights);
    fitters.push_back({RigidFitter(rest, halves[0]), RigidFitter(rest, halves[1])});
  }
  return fitters;
}

/// Least number of vertices; with fewer, a half may not determine a rotation.
constexpr int kLeastVertices = 6;

double disagreement_of_halves(const FrameSource& source, const Eigen::VectorXd& weights,
                              const Context& context) {
  if (source.vertices() < kLeastVertices) return 0;
  const auto fitters = fitters_of_halves(source.rest(), weights);
  const FrameNumbers squares = over_frames(
      source, 3, 0,
      [&](int, const FrameBlock& block, FrameRows& numbers) {
        for (int row = 0; row < block.frames(); ++row) {
          for (int axis = 0; axis < 3; ++axis) {
            const auto rotation = [&](int half) {
              return motion_to(block.frame(row), source.rest(), fitters[axis][half]).rotation;
            };
            const RigidTransform difference{rotation(0).transpose() * rotation(1)};
            numbers(row, axis) = difference.angle() * difference.angle();
          }
        }
      },
      context);
  return std::sqrt(squares.sum.maxCoeff() / source.frames());
}

class MovedFrames : public FrameSource {
 public:
  MovedFrames(std::shared_ptr<const FrameSource> source, std::vector<RigidTransform> motion)
      : FrameSource(source->header()), source_(std::move(source)), motion_(std::move(motion)) {
    if (static_cast<int>(motion_.size()) == frames()) return;
    throw MismatchError(std::to_string(motion_.size()) + " rigid transforms, expected " +
                        std::to_string(frames()) + ", one per frame");
  }

  bool is_quick() const override { return source_->is_quick(); }

 private:
  void read_frames(int first, FramesView poses) const override {
    source_->read(first, poses);
    for (Eigen::Index row = 0; row < poses.rows(); ++row) {
      const RigidTransform& transform = motion_[static_cast<std::size_t>(first + row)];
      if (transform.is_identity()) continue;
      Eigen::Map<Positions> pose(poses.row(row).data(), vertices(), 3);
      pose = transform.apply(pose);
    }
  }

  std::shared_ptr<const FrameSource> source_;
  std::vector<RigidTransform> motion_;
};

void check_weights(Eigen::Index points, const Eigen::VectorXd& weights) {
  if (weights.size() != points) {
    throw std::invalid_argument(std::to_string(weights.size()) + " weights for " +
                                std::to_string(points) + " points");
  }
  if (!(weights.minCoeff() >= 0) || !(weights.sum() > 0)) {
    throw std::invalid_argument("weights of a rigid fit must be >= 0 and not all 0");
  }
}

}  // namespace

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& cross_covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross_covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * Eigen::Vector3d(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

Positions RigidTransform::apply(const Eigen::Ref<const Positions>& positions) const {
  if (is_identity()) return positions;  // bitwise equal
  return (positions * rotation.transpose()).rowwise() + translation.transpose();
}

RigidTransform RigidTransform::inverse() const {
  return {rotation.transpose(), -(rotation.transpose() * translation)};
}

double RigidTransform::angle() const {
  const double cosine = std::clamp((rotation.trace() - 1) / 2, -1.0, 1.0);
  return std::acos(cosine) * 180 / std::numbers::pi;
}

bool RigidTransform::is_identity() const {
  return rotation == Eigen::Matrix3d::Identity() && translation == Eigen::Vector3d::Zero();
}

RigidTransform rigid_fit(const Eigen::Ref<const Positions>& from,
                         const Eigen::Ref<const Positions>& to, const Eigen::VectorXd& weights) {
  if (from.rows() != to.rows() || from.rows() == 0) {
    throw std::invalid_argument("rigid fit of " + std::to_string(from.rows()) + " points to " +
                                std::to_string(to.rows()) + ", expected the same number, not 0");
  }
  if (weights.size() == 0) {
    return RigidFitter(from, Eigen::VectorXd::Ones(from.rows())).carry_to(to);
  }
  check_weights(from.rows(), weights);
  return RigidFitter(from, weights).carry_to(to);
}

std::vector<RigidTransform> rigid_motion(const FrameSource& source, const AlignmentOptions& options,
                                         const Context& context) {
  check_options(options);
  std::vector<RigidTransform> motion(source.frames());
  if (source.vertices() == 0) return motion;
  if (options.vertices == AlignmentVertices::all) {
    motion = fit_frames(source, Eigen::VectorXd::Ones(source.vertices()), context);
  } else {
    motion = stable_motion(source, context).motion;
  }
  context.report(1);
  return motion;
}

StableMotion stable_motion(const FrameSource& source, const Context& context) {
  StableMotion stable{std::vector<RigidTransform>(source.frames())};
  if (source.vertices() == 0) return stable;
  StableFit fit = fit_stable(source, context.part(0, kFitShare));
  if (is_significant(source, fit)) stable.motion = std::move(fit.motion);
  stable.stillest = quantile(fit.residuals, kStableShare);
  stable.disagreement = disagreement_of_halves(source, fit.weights, context.part(kFitShare, 1));
  context.report(1);
  return stable;
}

std::shared_ptr<const FrameSource> with_motion(std::shared_ptr<const FrameSource> source,
                                               std::vector<RigidTransform> motion) {
  return std::make_shared<const MovedFrames>(std::move(source), std::move(motion));
}

std::shared_ptr<const FrameSource> without_motion(std::shared_ptr<const FrameSource> source,
                                                  const std::vector<RigidTransform>& motion) {
  std::vector<RigidTransform> inverse;
  inverse.reserve(motion.size());
  for (const RigidTransform& transform : motion) inverse.push_back(transform.inverse());
  return with_motion(std::move(source), std::move(inverse));
}

Alignment align(const MeshSequence& sequence, const AlignmentOptions& options,
                const Context& context) {
  return align(sequence, rigid_motion(sequence, options, context));
}

Alignment align(const MeshSequence& sequence, std::vector<RigidTransform> motion) {
  const auto still = without_motion(std::make_shared<const MeshSequence>(sequence), motion);
  return {MeshSequence(*still), std::move(motion)};
}

MeshSequence with_motion(const MeshSequence& sequence, std::vector<RigidTransform> motion) {
  return MeshSequence(
      *with_motion(std::make_shared<const MeshSequence>(sequence), std::move(motion)));
}

MeshSequence rigidly_aligned(const MeshSequence& sequence) {
  return align(sequence).sequence;
}

}  // namespace mimetra
