#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "fitting/fitted_frame.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/model/box_least_squares.h"

namespace mimetra {

namespace {

/// Part of the mean diagonal that is added to what expressions see of a frame, so that one which
/// moves the landmarks as a camera does can be factored too. It bends the step, not the energy.
constexpr double kLift = 1e-12;

/// The quadratic model of a frame's energy in alpha and beta, its camera eliminated and the prior
/// on alpha left out: x^T N x - 2 h^T x for x = (alpha, beta).
struct FrameSystem {
  Eigen::MatrixXd N_aa, N_ba, N_bb;
  Eigen::VectorXd h_a, h_b;
};

/// Orthonormal basis of what a change of the camera moves in one image coordinate: x, y, z and 1.
Eigen::Matrix<double, Eigen::Dynamic, 4> camera_directions(const FittedFrame& frame) {
  const ModelPoints points = frame.points();
  Eigen::Matrix<double, Eigen::Dynamic, 4> directions(points.rows(), 4);
  directions << (points.rowwise() - points.colwise().mean()), Eigen::VectorXd::Ones(points.rows());
  const Eigen::HouseholderQR<Eigen::Matrix<double, Eigen::Dynamic, 4>> qr(directions);
  directions.setIdentity();
  directions.applyOnTheLeft(qr.householderQ());
  return directions;
}

/// What a change of the camera undoes of each basis vector: 4 rows for each image coordinate.
Eigen::MatrixXd undone_by_camera(const FittedFrame& frame) {
  const Eigen::MatrixXd& rows = frame.rows().both.rows();
  const Eigen::Index count = rows.rows() / 3;
  const auto Q = camera_directions(frame);
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(8, rows.cols());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::MatrixXd part = Q.transpose() * rows.middleRows(axis * count, count);
    Z.topRows<4>() += frame.camera()(0, axis) * part;
    Z.bottomRows<4>() += frame.camera()(1, axis) * part;
  }
  return Z;
}

FrameSystem frame_system(const FittedFrame& frame, double ridge) {
  const BasisRows& basis = frame.rows().both;
  const Eigen::Index a = frame.alpha().size(), b = frame.beta().size();
  const auto C = frame.camera().leftCols<3>();
  Eigen::MatrixXd N =
      lower_triangle(basis.packed_gram(frame.weight() * C.transpose() * C), basis.size());
  const Eigen::MatrixXd Z = std::sqrt(frame.weight()) * undone_by_camera(frame);
  N.selfadjointView<Eigen::Lower>().rankUpdate(Z.transpose(), -1);
  Eigen::VectorXd x(a + b);
  x << frame.alpha(), frame.beta();
  const Eigen::VectorXd h = N.selfadjointView<Eigen::Lower>() * x +
                            frame.weight() * basis.transposed_product(C, frame.residual());
  FrameSystem system{N.topLeftCorner(a, a), N.bottomLeftCorner(b, a),
                     N.bottomRightCorner(b, b).selfadjointView<Eigen::Lower>(), h.head(a),
                     h.tail(b)};
  if (b > 0) system.N_bb.diagonal().array() += ridge + kLift * system.N_bb.diagonal().mean();
  return system;
}

/// Minimises the sum of the frames' quadratic models plus |alpha|^2 over alpha and beta in its box.
/// The minimum over beta is a convex, piecewise quadratic function of alpha; this is Newton's
/// method on that, halved where it goes up.
class BoxedStep {
 public:
  /// alpha, the best beta of each frame for it, and which of these are within their bounds.
  struct Point {
    Eigen::VectorXd alpha;
    std::vector<Eigen::VectorXd> beta;
    std::vector<std::vector<Eigen::Index>> free;
    double value = 0;
  };

  BoxedStep(const std::vector<FittedFrame>& frames, const FitOptions& options)
      : upper_(options.max_expression) {
    const Eigen::Index size = frames.front().alpha().size();
    N_aa_ = Eigen::MatrixXd::Identity(size, size);
    h_a_ = Eigen::VectorXd::Zero(size);
    here_.alpha = frames.front().alpha();
    for (const FittedFrame& frame : frames) {
      systems_.push_back(frame_system(frame, *options.ridge));
      N_aa_.triangularView<Eigen::Lower>() += systems_.back().N_aa;
      h_a_ += systems_.back().h_a;
      here_.beta.push_back(frame.beta());
    }
    here_ = point_at(here_.alpha);
  }

  Point solve() {
    constexpr int kMost = 50;  // two to five are usual
    for (int pass = 0; pass < kMost; ++pass) {
      const Eigen::VectorXd way = newton() - here_.alpha;
      Point next = point_at(here_.alpha + way);
      const bool settled = next.free == here_.free;
      // Halfway often enough it is below, unless rounding is all that is left.
      for (double share = 0.5; !settled && next.value > here_.value; share /= 2) {
        if (share < 1e-6) return here_;
        next = point_at(here_.alpha + share * way);
      }
      here_ = std::move(next);
      if (settled) break;
    }
    return here_;
  }

 private:
  Point point_at(const Eigen::VectorXd& alpha) const {
    Point point{alpha, {}, {}, 0};
    point.value = alpha.dot(N_aa_.selfadjointView<Eigen::Lower>() * alpha) - 2 * h_a_.dot(alpha);
    const Eigen::Index size = here_.beta.front().size();
    const Eigen::VectorXd lower = Eigen::VectorXd::Zero(size);
    const Eigen::VectorXd upper = Eigen::VectorXd::Constant(size, upper_);
    for (std::size_t f = 0; f < systems_.size(); ++f) {
      const FrameSystem& system = systems_[f];
      const Eigen::VectorXd h = system.h_b - system.N_ba * alpha;
      const Eigen::VectorXd beta = box_least_squares(system.N_bb, h, lower, upper, here_.beta[f]);
      point.value += beta.dot(system.N_bb * beta) - 2 * h.dot(beta);
      std::vector<Eigen::Index>& free = point.free.emplace_back();
      for (Eigen::Index j = 0; j < size; ++j) {
        if (beta[j] > 0 && beta[j] < upper_) free.push_back(j);
      }
      point.beta.push_back(beta);
    }
    return point;
  }

  /// alpha at the minimum where every beta on a bound stays there.
  Eigen::VectorXd newton() const {
    if (here_.alpha.size() == 0) return here_.alpha;
    Eigen::MatrixXd schur = N_aa_;
    Eigen::VectorXd right = h_a_;
    for (std::size_t f = 0; f < systems_.size(); ++f) {
      const FrameSystem& system = systems_[f];
      const std::vector<Eigen::Index>& free = here_.free[f];
      Eigen::VectorXd bound = here_.beta[f];
      for (const Eigen::Index j : free) bound[j] = 0;
      right -= system.N_ba.transpose() * bound;
      if (free.empty()) continue;
      const Eigen::MatrixXd inner = system.N_bb(free, free);
      const Eigen::LLT<Eigen::MatrixXd> factor(inner);
      const Eigen::MatrixXd coupling = factor.matrixL().solve(system.N_ba(free, Eigen::all));
      const Eigen::VectorXd rest = factor.matrixL().solve((system.h_b - system.N_bb * bound)(free));
      schur.selfadjointView<Eigen::Lower>().rankUpdate(coupling.transpose(), -1);
      right -= coupling.transpose() * rest;
    }
    return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(schur).solve(right);
  }

  double upper_;
  Eigen::MatrixXd N_aa_;  // lower triangle
  Eigen::VectorXd h_a_;
  std::vector<FrameSystem> systems_;
  Point here_;
};

/// The frames at a share of the way to the step's end, each with the best camera there.
std::vector<FittedFrame> moved(std::vector<FittedFrame> frames, const BoxedStep::Point& end,
                               double share) {
  const Eigen::VectorXd from = frames.front().alpha();
  const Eigen::VectorXd alpha = from + share * (end.alpha - from);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Eigen::VectorXd beta = frames[f].beta();
    frames[f].set_alpha(alpha);
    // This form stays within the box in spite of rounding.
    frames[f].set_beta((1 - share) * beta + share * end.beta[f]);
    frames[f].estimate_camera();
  }
  return frames;
}

}  // namespace

FittedClip fit_jointly(std::vector<FittedFrame> frames, const FitOptions& options) {
  constexpr int kHalvings = 10;
  FittedClip result{std::move(frames), 0, {}};
  double before = energy(result.frames, true, *options.ridge);
  while (result.iterations < options.iterations) {
    const BoxedStep::Point end = BoxedStep(result.frames, options).solve();
    double share = 1, now = before;
    for (int halving = 0; halving <= kHalvings; ++halving, share /= 2) {
      std::vector<FittedFrame> trial = moved(result.frames, end, share);
      const double energy_there = energy(trial, true, *options.ridge);
      if (energy_there > before) continue;
      now = energy_there;
      result.frames = std::move(trial);
      break;
    }
    ++result.iterations;
    result.energies.push_back(now);
    if (has_converged(before, now, options.tolerance) || now == before) break;
    report_progress(options.progress, double(result.iterations) / options.iterations);
    before = now;
  }
  return result;
}

}  // namespace mimetra
