#include "fitting/clip_noise.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "toolkit/mesh/median.h"

namespace mimetra {

namespace {

/// Range of the degrees of freedom. With fewer, one frame of real footage ignores a whole side of
/// the jaw and the next does not. With more, the noise does not differ from normal noise.
constexpr double kLeastFreedom = 6, kMostFreedom = 1000;
/// Neither a detector nor a person is more precise: 0.01 px for a face of 100 px.
constexpr double kLeastSigma = 1e-4;
/// Weight of the usual noise of single frames, as a number of coordinates added to the clip's. It
/// keeps a few landmarks that fit by chance from being trusted beyond measure.
constexpr double kBelieved = 10;
/// Number of normal landmarks added to a clip's. With only five pictures, it keeps landmarks that
/// are off from losing their weight.
constexpr double kBelievedNormal = 30;
constexpr double kUnknownRepeated = 0.5;

/// Residual of a frame's landmarks as shares of its radius, rotated in the image to match the face
/// in `reference`.
ImagePoints aligned_residual(const FittedFrame& frame, const FittedFrame& reference) {
  const Eigen::Matrix2d M =
      reference.camera().leftCols<3>() * frame.camera().leftCols<3>().transpose();
  const double angle = std::atan2(M(1, 0) - M(0, 1), M(0, 0) + M(1, 1));
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  return frame.residual() * turn.transpose() / frame.radius();
}

/// Weighted sums over a clip.
struct Sums {
  struct Landmark {
    double weight = 0;
    Eigen::RowVector2d mean = Eigen::RowVector2d::Zero();
  };
  std::map<Eigen::Index, Landmark> landmarks;
  double weight = 0;        ///< weight of all landmarks in all frames
  double within = 0;        ///< squares of the part that differs between frames
  double own_unknowns = 0;  ///< unknowns of cameras and of expressions inside their bounds
};

Sums sums_of(const std::vector<FittedFrame>& frames) {
  Sums sums;
  std::vector<ImagePoints> residuals;
  for (const FittedFrame& frame : frames) {
    residuals.push_back(aligned_residual(frame, frames.front()));
    for (Eigen::Index i = 0; i < residuals.back().rows(); ++i) {
      const double weight = frame.landmark_weights()[i];
      Sums::Landmark& landmark = sums.landmarks[frame.rows().landmarks[std::size_t(i)]];
      landmark.weight += weight;
      landmark.mean += weight * residuals.back().row(i);
    }
    constexpr double kCamera = 6;
    const auto& beta = frame.beta().array();
    sums.own_unknowns += kCamera + double((beta > 0 && beta < 1).count());
  }
  for (auto& [index, landmark] : sums.landmarks) {
    landmark.mean /= landmark.weight;
    sums.weight += landmark.weight;
  }
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (Eigen::Index i = 0; i < residuals[f].rows(); ++i) {
      const auto& landmark = sums.landmarks.at(frames[f].rows().landmarks[std::size_t(i)]);
      sums.within +=
          frames[f].landmark_weights()[i] * (residuals[f].row(i) - landmark.mean).squaredNorm();
    }
  }
  return sums;
}

/// Maximum-likelihood degrees of freedom nu for the residuals of the landmarks. The residuals count
/// as independent_frames() frames, and kBelievedNormal normal landmarks are added. The density at z
/// sigmas in the plane is (1 + z^2 / nu)^-(nu / 2 + 1) / (2 pi sigma^2). The search assumes that
/// the log-likelihood has a single maximum over nu.
double likely_freedom(const std::vector<FittedFrame>& frames, const ClipNoise& noise) {
  std::vector<double> squares;
  for (const FittedFrame& frame : frames) {
    const Eigen::VectorXd r = frame.residual().rowwise().squaredNorm();
    for (const double each : r) squares.push_back(each / (frame.sigma() * frame.sigma()));
  }
  const double count = double(frames.size());
  const double independent = noise.independent_frames(count) / count;
  const auto unlikely = [&](double logarithm) {
    const double nu = std::exp(logarithm);
    double sum = 0;
    for (const double square : squares) sum += std::log1p(square / nu);
    // The mean of log(1 + z^2 / nu) for normal noise is e^(nu / 2) E1(nu / 2).
    const double normal = -std::exp(nu / 2) * std::expint(-nu / 2);
    return (nu / 2 + 1) * (independent * sum + kBelievedNormal * normal);
  };
  // Golden section search: each step keeps one inner point.
  constexpr double kGolden = 0.6180339887498949, kClose = 1e-3;
  double first = std::log(kLeastFreedom), last = std::log(kMostFreedom);
  double low = last - kGolden * (last - first), high = first + kGolden * (last - first);
  double of_low = unlikely(low), of_high = unlikely(high);
  while (last - first > kClose) {
    if (of_low < of_high) {
      last = std::exchange(high, low);
      of_high = of_low;
      low = last - kGolden * (last - first);
      of_low = unlikely(low);
    } else {
      first = std::exchange(low, high);
      of_low = of_high;
      high = first + kGolden * (last - first);
      of_high = unlikely(high);
    }
  }
  return std::exp((first + last) / 2);
}

}  // namespace

KnownNoise known_noise(const FitOptions& options, std::size_t frames) {
  using Outliers = FitOptions::Outliers;
  const bool clip = options.shape == FitOptions::Shape::clip && frames > 1;
  const bool estimated = clip && !options.sigma && options.repeated != 0.0;
  const bool resist = options.outliers == Outliers::resist ||
                      (options.outliers == Outliers::automatic && estimated);
  KnownNoise known{.sigma = !estimated, .repeated = options.repeated, .outliers = !resist};
  if (!known.repeated && !estimated) known.repeated = 0;
  return known;
}

ClipNoise rough_noise(const std::vector<FittedFrame>& frames, const KnownNoise& known) {
  std::vector<double> squares;
  for (const FittedFrame& frame : frames) {
    const Eigen::VectorXd r = frame.residual().rowwise().squaredNorm();
    for (const double each : r) squares.push_back(each / (frame.radius() * frame.radius()));
  }
  ClipNoise noise;
  // The median of a squared distance in the plane is 2 ln 2 sigma^2.
  noise.sigma =
      std::max(std::sqrt(median(std::move(squares)) / (2 * std::numbers::ln2)), kLeastSigma);
  noise.repeated = known.repeated.value_or(kUnknownRepeated);
  return noise;
}

ClipNoise estimated_noise(const std::vector<FittedFrame>& frames, double determined,
                          const KnownNoise& known) {
  const Sums sums = sums_of(frames);
  const double count = double(frames.size()), landmarks = double(sums.landmarks.size());
  const double own = sums.own_unknowns / count;
  const double believed = kBelieved * kUsualSigma * kUsualSigma;
  const double freedom = std::max(0.0, 2 * (sums.weight - landmarks) - sums.own_unknowns + own);
  const double within = (believed + sums.within) / (kBelieved + freedom);
  // Part of each landmark's squared mean that a mean of that many frames has by chance.
  double squares = 0, by_chance = 0, seen = 0;
  for (const auto& [index, landmark] : sums.landmarks) {
    // A landmark that is far off in every frame gets little weight.
    const double share = std::min(1.0, landmark.weight / count);
    squares += share * landmark.mean.squaredNorm();
    by_chance += share * 2 * within / std::max(1.0, landmark.weight);
    seen += share;
  }
  const double free = std::max(2.0, 2 * seen - own - determined);
  const double repeated = std::max(0.0, squares - by_chance * free / (2 * seen)) / free;
  ClipNoise noise;
  noise.sigma = std::max(std::sqrt(within + repeated), kLeastSigma);
  noise.repeated = known.repeated.value_or(repeated / (within + repeated));
  noise.freedom = likely_freedom(frames, noise);
  return noise;
}

double outline_noise(const std::vector<FittedFrame>& frames, const ClipNoise& noise) {
  double squares = 0, weight = 0;
  std::vector<double> sizes;
  for (const FittedFrame& frame : frames) {
    const Eigen::VectorXd rest = frame.outline_residual() / frame.radius();
    for (const double r : rest) {
      sizes.push_back(std::abs(r));
      if (noise.outline == 0) continue;
      const double own = noise.weight(r / noise.outline, 1);
      squares += own * r * r;
      weight += own;
    }
  }
  if (sizes.empty()) return 0;
  const double least = std::max(noise.sigma, kLeastSigma);
  if (weight > 0) return std::max(least, std::sqrt(squares / weight));
  constexpr double kNormal = 1.4826;  // sigma / median of sizes, for normal noise
  return std::max(least, kNormal * median(std::move(sizes)));
}

void set_noise(std::vector<FittedFrame>& frames, const ClipNoise& noise, const KnownNoise& known) {
  for (FittedFrame& frame : frames) {
    if (!known.sigma) frame.set_sigma(noise.sigma * frame.radius());
    if (frame.outline() && noise.outline > 0) {
      auto outline = std::make_shared<OutlineRows>(*frame.outline());
      const double sigma = noise.outline * frame.radius();
      outline->weight = frame.outline_residual() / sigma;
      for (double& weight : outline->weight) {
        const double ratio = frame.sigma() / sigma;
        weight = ratio * ratio * (known.outliers ? 1 : noise.weight(weight, 1));
      }
      frame.set_outline(std::move(outline));
    }
    if (known.outliers) continue;
    Eigen::VectorXd weights = frame.residual().rowwise().norm() / frame.sigma();
    for (double& weight : weights) weight = noise.weight(weight, 2);
    frame.set_landmark_weights(std::move(weights));
  }
}

}  // namespace mimetra
