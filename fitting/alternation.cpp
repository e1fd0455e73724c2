#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "fitting/fitted_frame.h"
#include "toolkit/model/box_least_squares.h"
#include "toolkit/model/smooth_weights.h"
#include "toolkit/model/smoothness.h"

namespace mimetra {

namespace {

/// Normal equations of a coefficient vector; `h` is their right side.
struct NormalEquations {
  Eigen::VectorXd packed_gram;
  Eigen::VectorXd h;
};

Eigen::Matrix3d weighted_axes(const FittedFrame& frame) {
  const auto C = frame.camera().leftCols<3>();
  return frame.weight() * C.transpose() * C;
}

NormalEquations identity_equations(const FittedFrame& frame) {
  const BasisRows& basis = frame.rows().identities;
  return {basis.packed_gram(weighted_axes(frame)),
          frame.weight() * basis.transposed_product(frame.camera().leftCols<3>(),
                                                    frame.residual_without_identity())};
}

/// Solves eq. 4 for alpha.
Eigen::VectorXd identity(const NormalEquations& equations) {
  Eigen::MatrixXd system = lower_triangle(equations.packed_gram, equations.h.size());
  system.diagonal().array() += 1;
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(system);
  return factor.solve(equations.h);
}

class Alternation {
 public:
  /// Smooths over time if there are `times`.
  Alternation(std::vector<FittedFrame> frames, const FitOptions& options,
              const Eigen::VectorXd& times, const Context& context)
      : frames_(std::move(frames)),
        options_(options),
        context_(context),
        times_(times),
        smooth_(times.size() > 0),
        one_identity_(options.shape == FitOptions::Shape::clip) {}

  FittedClip run() {
    FittedClip result;
    // The smoothness term has no weight yet, so there is no energy to compare the first one with.
    double before = smooth_ ? std::numeric_limits<double>::infinity()
                            : energy(frames_, one_identity_, *options_.ridge);
    while (result.iterations < options_.iterations) {
      estimate_cameras();
      update_identities();
      estimate_cameras();
      update_expressions();
      ++result.iterations;
      const double now = energy(frames_, one_identity_, *options_.ridge) + bending();
      result.energies.push_back(now);
      if (has_converged(before, now, options_.tolerance)) break;
      context_.report(double(result.iterations) / options_.iterations);
      before = now;
    }
    result.frames = std::move(frames_);
    return result;
  }

 private:
  void estimate_cameras() {
    for (FittedFrame& frame : frames_) frame.estimate_camera();
  }

  void update_identities() {
    if (!one_identity_) {
      for (FittedFrame& frame : frames_) frame.set_alpha(identity(identity_equations(frame)));
      return;
    }
    NormalEquations sum = identity_equations(frames_.front());
    for (std::size_t f = 1; f < frames_.size(); ++f) {
      const NormalEquations equations = identity_equations(frames_[f]);
      sum.packed_gram += equations.packed_gram;
      sum.h += equations.h;
    }
    const Eigen::VectorXd alpha = identity(sum);
    for (FittedFrame& frame : frames_) frame.set_alpha(alpha);
  }

  /// Solves eq. 5 for beta.
  void update_expressions() {
    const Eigen::Index size = frames_.front().beta().size();
    if (size == 0) return;
    const Eigen::VectorXd lower = Eigen::VectorXd::Zero(size);
    const Eigen::VectorXd upper = Eigen::VectorXd::Constant(
        size, options_.max_expression.value_or(std::numeric_limits<double>::infinity()));
    std::vector<Eigen::MatrixXd> grams;
    Eigen::MatrixXd h(frames_.size(), size);
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      FittedFrame& frame = frames_[f];
      const BasisRows& basis = frame.rows().expressions;
      Eigen::MatrixXd gram = lower_triangle(basis.packed_gram(weighted_axes(frame)), size);
      gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
      gram.diagonal().array() += *options_.ridge;
      h.row(f) = frame.weight() * basis.transposed_product(frame.camera().leftCols<3>(),
                                                           frame.residual_without_expression());
      frame.set_beta(box_least_squares(gram, h.row(f), lower, upper, frame.beta()));
      if (smooth_) grams.push_back(std::move(gram));
    }
    if (smooth_) smooth_expressions(grams, h);
  }

  void smooth_expressions(const std::vector<Eigen::MatrixXd>& grams, const Eigen::MatrixXd& h) {
    if (!penalty_) {
      double mean = 0;
      for (const Eigen::MatrixXd& gram : grams) mean += gram.diagonal().mean();
      // The weight stays fixed, or the energies of iterations would not be comparable.
      penalty_ = smoothness_penalty(options_.smoothness, times_, mean / double(grams.size()));
    }
    const Eigen::MatrixXd smooth = smooth_weights(grams, h, times_, *penalty_, expressions());
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      frames_[f].set_beta(smooth.row(static_cast<Eigen::Index>(f)));
    }
  }

  Eigen::MatrixXd expressions() const {
    Eigen::MatrixXd beta(frames_.size(), frames_.front().beta().size());
    for (std::size_t f = 0; f < frames_.size(); ++f) beta.row(f) = frames_[f].beta();
    return beta;
  }

  /// Smoothness term of the energy.
  double bending() const {
    if (!penalty_ || frames_.size() < 3) return 0;
    return *penalty_ * differences_of(second_differences(times_), expressions()).squaredNorm();
  }

  std::vector<FittedFrame> frames_;
  const FitOptions& options_;
  const Context& context_;
  Eigen::VectorXd times_;
  bool smooth_;
  bool one_identity_;
  std::optional<double> penalty_;
};

}  // namespace

FittedClip fit_alternating(std::vector<FittedFrame> frames, const FitOptions& options,
                           const Context& context) {
  return Alternation(std::move(frames), options, {}, context).run();
}

FittedClip fit_smoothly(std::vector<FittedFrame> frames, const FitOptions& options,
                        const Eigen::VectorXd& times, const Context& context) {
  return Alternation(std::move(frames), options, times, context).run();
}

}  // namespace mimetra
