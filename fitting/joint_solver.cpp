#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include "fitting/clip_noise.h"
#include "fitting/face_outline.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/model/smooth_weights.h"
#include "toolkit/model/smoothness.h"

namespace mimetra {

namespace {

/// Share of the mean diagonal added to a frame's system of expressions. It can then be factored
/// even if an expression moves the landmarks as a camera does. It changes the step, not the energy.
constexpr double kLift = 1e-12;

/// Quadratic model of a frame's energy in x = (alpha, beta): x^T N x - 2 h^T x. The camera is
/// eliminated, and the prior on alpha is left out.
struct FrameSystem {
  Eigen::MatrixXd N_aa, N_ba, N_bb;
  Eigen::VectorXd h_a, h_b;
};

FrameSystem frame_system(const FittedFrame& frame, double ridge) {
  const Eigen::Index a = frame.alpha().size(), b = frame.beta().size();
  if (a + b == 0) return {};  // only the camera is unknown
  const FittedFrame::Linear linear = frame.linear();
  // Projects out the directions that a change of the camera can undo.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(linear.camera);
  Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(linear.camera.rows(), linear.camera.cols());
  Q.applyOnTheLeft(qr.householderQ());
  const Eigen::MatrixXd Z = Q.transpose() * linear.basis;
  const Eigen::VectorXd z = Q.transpose() * linear.residual;
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(a + b, a + b);
  N.selfadjointView<Eigen::Lower>().rankUpdate(linear.basis.transpose());
  N.selfadjointView<Eigen::Lower>().rankUpdate(Z.transpose(), -1);
  Eigen::VectorXd x(a + b);
  x << frame.alpha(), frame.beta();
  const Eigen::VectorXd h = N.selfadjointView<Eigen::Lower>() * x +
                            linear.basis.transpose() * linear.residual - Z.transpose() * z;
  FrameSystem system{N.topLeftCorner(a, a), N.bottomLeftCorner(b, a),
                     N.bottomRightCorner(b, b).selfadjointView<Eigen::Lower>(), h.head(a),
                     h.tail(b)};
  if (b > 0) system.N_bb.diagonal().array() += ridge + kLift * system.N_bb.diagonal().mean();
  return system;
}

/// Minimises the sum of the frames' quadratic models plus prior |alpha|^2 over alpha and the
/// box-constrained betas. The minimum over beta is a convex, piecewise quadratic function of alpha.
/// This is Newton's method for that function; a step that increases it is halved.
class BoxedStep {
 public:
  /// alpha, each frame's best beta for it, and the indices of betas strictly inside their bounds.
  struct Point {
    Eigen::VectorXd alpha;
    std::vector<Eigen::VectorXd> beta;
    std::vector<std::vector<Eigen::Index>> free;
    double value = 0;
  };

  BoxedStep(const std::vector<FittedFrame>& frames, const FitOptions& options, double prior)
      : upper_(options.max_expression.value_or(std::numeric_limits<double>::infinity())),
        prior_(prior) {
    const Eigen::Index size = frames.front().alpha().size();
    N_aa_ = prior * Eigen::MatrixXd::Identity(size, size);
    h_a_ = Eigen::VectorXd::Zero(size);
    here_.alpha = frames.front().alpha();
    for (const FittedFrame& frame : frames) {
      systems_.push_back(frame_system(frame, *options.ridge));
      N_aa_.triangularView<Eigen::Lower>() += systems_.back().N_aa;
      h_a_ += systems_.back().h_a;
      systems_.back().N_aa.resize(0, 0);  // only their sum is needed
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
      // Halving often enough decreases the value, unless only rounding is left.
      for (double share = 0.5; !settled && next.value > here_.value; share /= 2) {
        if (share < 1e-6) return here_;
        next = point_at(here_.alpha + share * way);
      }
      here_ = std::move(next);
      if (settled) break;
    }
    return here_;
  }

  /// Number of directions of alpha that the landmarks determine rather than the prior.
  double determined() const {
    const Eigen::Index size = here_.alpha.size();
    if (size == 0) return 0;
    const Eigen::MatrixXd schur = reduced().matrix;
    const Eigen::LLT<Eigen::MatrixXd> factor(schur);
    return double(size) - prior_ * factor.solve(Eigen::MatrixXd::Identity(size, size)).trace();
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

  /// System for alpha if every beta at a bound stays there.
  struct Reduced {
    Eigen::MatrixXd matrix;  ///< lower triangle
    Eigen::VectorXd right;
  };

  Reduced reduced() const {
    Reduced system{N_aa_, h_a_};
    for (std::size_t f = 0; f < systems_.size(); ++f) {
      const FrameSystem& own = systems_[f];
      const std::vector<Eigen::Index>& free = here_.free[f];
      Eigen::VectorXd bound = here_.beta[f];
      for (const Eigen::Index j : free) bound[j] = 0;
      system.right -= own.N_ba.transpose() * bound;
      if (free.empty()) continue;
      const Eigen::MatrixXd inner = own.N_bb(free, free);
      const Eigen::LLT<Eigen::MatrixXd> factor(inner);
      const Eigen::MatrixXd coupling = factor.matrixL().solve(own.N_ba(free, Eigen::all));
      const Eigen::VectorXd rest = factor.matrixL().solve((own.h_b - own.N_bb * bound)(free));
      system.matrix.selfadjointView<Eigen::Lower>().rankUpdate(coupling.transpose(), -1);
      system.right -= coupling.transpose() * rest;
    }
    return system;
  }

  /// alpha at the minimum of the reduced system.
  Eigen::VectorXd newton() const {
    if (here_.alpha.size() == 0) return here_.alpha;
    Reduced system = reduced();
    return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(system.matrix).solve(system.right);
  }

  double upper_, prior_;
  Eigen::MatrixXd N_aa_;  // lower triangle
  Eigen::VectorXd h_a_;
  std::vector<FrameSystem> systems_;
  Point here_;
};

/// Moves frames by a share of the step and finds the best camera of each.
std::vector<FittedFrame> moved(std::vector<FittedFrame> frames, const BoxedStep::Point& end,
                               double share) {
  const Eigen::VectorXd from = frames.front().alpha();
  const Eigen::VectorXd alpha = from + share * (end.alpha - from);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const Eigen::VectorXd beta = frames[f].beta();
    frames[f].set_alpha(alpha);
    // This form stays inside the box despite rounding.
    frames[f].set_beta((1 - share) * beta + share * end.beta[f]);
    frames[f].estimate_camera();
  }
  return frames;
}

/// Result of steps with fixed noise. `determined` is set only after a single step.
struct Descent {
  FittedClip clip;
  double determined = 0;
};

Descent descended(std::vector<FittedFrame> frames, const FitOptions& options, double prior,
                  int iterations, const Context& context) {
  constexpr int kHalvings = 10;
  Descent result{{std::move(frames), 0, {}}};
  FittedClip& clip = result.clip;
  double before = energy(clip.frames, true, *options.ridge, prior);
  while (clip.iterations < iterations) {
    BoxedStep step(clip.frames, options, prior);
    const BoxedStep::Point end = step.solve();
    if (iterations == 1) result.determined = step.determined();
    double share = 1, now = before;
    for (int halving = 0; halving <= kHalvings; ++halving, share /= 2) {
      std::vector<FittedFrame> trial = moved(clip.frames, end, share);
      const double energy_there = energy(trial, true, *options.ridge, prior);
      if (energy_there > before) continue;
      now = energy_there;
      clip.frames = std::move(trial);
      break;
    }
    ++clip.iterations;
    clip.energies.push_back(now);
    if (has_converged(before, now, options.tolerance) || now == before) break;
    context.report(double(clip.iterations) / iterations);
    before = now;
  }
  return result;
}

/// Weight of |alpha|^2. The landmarks of all frames count as fewer independent frames.
double prior_of(const KnownNoise& known, const ClipNoise& noise, double frames) {
  // The prior of eq. 4 belongs to the given sigma. An estimated sigma is a standard deviation like
  // alpha's, so both terms have the factor 1/2.
  const double own = known.sigma ? 1 : 0.5;
  return own * frames / noise.independent_frames(frames);
}

bool have_settled(const ClipNoise& before, const ClipNoise& now, const Eigen::VectorXd& moved) {
  constexpr double kNoise = 1e-3, kAlpha = 1e-3;
  return std::abs(now.sigma - before.sigma) < kNoise * before.sigma &&
         std::abs(now.repeated - before.repeated) < kNoise &&
         moved.squaredNorm() <= kAlpha * kAlpha * double(moved.size());
}

}  // namespace

FittedClip fit_jointly(std::vector<FittedFrame> frames, const FitOptions& options,
                       const ClipOutline& outline, const Context& context) {
  constexpr int kRounds = 40;  // 10 to 20 are usual
  const KnownNoise known = known_noise(options, frames.size());
  const double count = double(frames.size());
  if (known.all()) {
    const ClipNoise noise{.repeated = *known.repeated};
    const double prior = prior_of(known, noise, count);
    FittedClip clip =
        descended(std::move(frames), options, prior, options.iterations, context).clip;
    clip.noise = noise;
    return clip;
  }
  ClipNoise noise = rough_noise(frames, known);
  set_noise(frames, noise, known);
  const auto match_outline = [&] {
    if (!outline.face) return;
    const auto rows = outline.matched(frames);
    for (std::size_t f = 0; f < frames.size(); ++f) frames[f].set_outline(rows[f]);
    noise.outline = outline_noise(frames, noise);
    set_noise(frames, noise, known);
  };
  const auto share = [&](int done) { return double(done) / (kRounds + options.iterations); };
  int round = 0;
  for (bool settled = false; !settled && round < kRounds; ++round) {
    context.report(share(round));
    const Eigen::VectorXd alpha = frames.front().alpha();
    Descent step = descended(std::move(frames), options, prior_of(known, noise, count), 1,
                             context.part(share(round), share(round + 1)));
    frames = std::move(step.clip.frames);
    ClipNoise now = estimated_noise(frames, step.determined, known);
    now.outline = noise.outline;
    set_noise(frames, now, known);
    settled = have_settled(noise, now, frames.front().alpha() - alpha);
    noise = now;
    match_outline();
  }
  FittedClip clip = descended(std::move(frames), options, prior_of(known, noise, count),
                              options.iterations, context.part(share(round), 1))
                        .clip;
  clip.iterations += round;
  clip.noise = noise;
  return clip;
}

FittedClip smoothed(std::vector<FittedFrame> frames, const FitOptions& options,
                    const Eigen::VectorXd& times, const Context& context) {
  const Eigen::Index count = static_cast<Eigen::Index>(frames.size());
  const Eigen::Index size = frames.front().beta().size();
  FittedClip clip{std::move(frames), 0, {}};
  if (size == 0 || count < 3) return clip;
  const SecondDifferences differences = second_differences(times);
  std::optional<double> penalty;
  for (bool falling = true; falling && clip.iterations < options.iterations;) {
    std::vector<Eigen::MatrixXd> grams;
    Eigen::MatrixXd h(count, size), beta(count, size);
    double diagonal = 0;
    for (Eigen::Index f = 0; f < count; ++f) {
      const FittedFrame& frame = clip.frames[static_cast<std::size_t>(f)];
      FrameSystem system = frame_system(frame, *options.ridge);
      h.row(f) = system.h_b - system.N_ba * frame.alpha();
      beta.row(f) = frame.beta();
      diagonal += system.N_bb.diagonal().mean() / double(count);
      grams.push_back(std::move(system.N_bb));
    }
    // The weight stays fixed, or the energies of iterations would not be comparable.
    if (!penalty) penalty = smoothness_penalty(options.smoothness, times, diagonal);
    const Eigen::MatrixXd smooth = smooth_weights(grams, h, times, *penalty, beta);
    std::vector<FittedFrame> trial = clip.frames;
    for (Eigen::Index f = 0; f < count; ++f) {
      trial[static_cast<std::size_t>(f)].set_beta(smooth.row(f));
      trial[static_cast<std::size_t>(f)].estimate_camera();
    }
    const double now = energy(trial, true, *options.ridge) +
                       *penalty * differences_of(differences, smooth).squaredNorm();
    falling = clip.energies.empty() || now < clip.energies.back();
    if (!falling) break;
    falling = clip.energies.empty() || !has_converged(clip.energies.back(), now, options.tolerance);
    clip.frames = std::move(trial);
    clip.energies.push_back(now);
    ++clip.iterations;
    context.report(double(clip.iterations) / options.iterations);
  }
  return clip;
}

}  // namespace mimetra
