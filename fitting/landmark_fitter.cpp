#include "fitting/landmark_fitter.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "fitting/face_outline.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/rounding.h"

namespace mimetra {

namespace {

/// Default ridge, with which expressions are as strong as in real faces. Landmarks can tell ten
/// expressions apart without it. For 52 expressions it equals a normal prior for which |beta|^2 is
/// 5 on average. Captured performances with 51 and 52 expressions have 2.5 and 5.2.
double usual_ridge(Eigen::Index expressions) {
  constexpr Eigen::Index kToldApart = 10;
  constexpr double kOfEachFurther = 0.125;
  return expressions > kToldApart ? kOfEachFurther * double(expressions - kToldApart) : 0;
}

std::string frame_name(Eigen::Index frame) {
  return "frame " + std::to_string(frame) + ": ";
}

void check(const FitOptions& options) {
  const auto fail = [](const char* message) { throw std::invalid_argument(message); };
  check_options(options);
  using Camera = FitOptions::Camera;
  const bool plain = options.camera == Camera::affine || options.camera == Camera::automatic;
  if (options.solver == FitOptions::Solver::alternating) {
    if (!plain) fail("the alternating solver has affine cameras only");
    if (options.outliers == FitOptions::Outliers::resist) {
      fail("the alternating solver trusts all landmarks");
    }
    if (options.repeated.value_or(0) > 0) {
      fail("the alternating solver takes frames for independent");
    }
  }
  if ((options.camera == Camera::perspective) != options.focal_length.has_value()) {
    fail("a perspective camera needs a focal length, and others have none");
  }
  if (options.smoothness > 0 && options.max_expression != 1) {
    fail("smoothness needs expressions of at most 1");
  }
}

/// Camera of the options, which resolves `automatic` by the number of frames.
CameraModel camera_of(const FitOptions& options, std::size_t frames) {
  using Camera = FitOptions::Camera;
  Camera camera = options.camera;
  if (camera == Camera::automatic) {
    const bool clip = options.solver == FitOptions::Solver::joint &&
                      options.shape == FitOptions::Shape::clip && frames > 1;
    camera = clip ? Camera::orthographic : Camera::affine;
  }
  if (camera == Camera::affine) return {};
  return {options.stretch, camera == Camera::perspective ? 1 / *options.focal_length : 0};
}

std::vector<FrameFit> results_of(const FittedClip& clip) {
  std::vector<FrameFit> fits;
  for (const FittedFrame& frame : clip.frames) {
    FrameFit& fit = fits.emplace_back();
    fit.camera = frame.camera();
    fit.depth = frame.depth_row();
    // This keeps the image of the origin: rows of a perspective camera hold it times the depth.
    fit.camera.leftCols<3>() += fit.camera.col(3) * fit.depth.head<3>();
    fit.alpha = frame.alpha();
    fit.beta = frame.beta();
    fit.landmarks = static_cast<int>(frame.image().rows());
    fit.rms = std::sqrt(frame.residual().squaredNorm() / fit.landmarks);
    const Eigen::VectorXd outline = frame.outline_residual();
    fit.rms_all = std::sqrt((frame.residual().squaredNorm() + outline.squaredNorm()) /
                            double(fit.landmarks + outline.size()));
    fit.sigma = frame.sigma();
    fit.repeated = clip.noise.repeated;
    fit.iterations = clip.iterations;
    fit.energies = clip.energies;
  }
  return fits;
}

FittedClip solved(std::vector<FittedFrame> frames, const FitOptions& options,
                  const ClipOutline& outline, const Context& context) {
  return options.solver == FitOptions::Solver::joint
             ? fit_jointly(std::move(frames), options, outline, context)
             : fit_alternating(std::move(frames), options, context);
}

/// Solves one clip of all frames, or one clip for each frame, starting from the previous one.
std::vector<FittedClip> solved_by_shape(std::vector<FittedFrame> frames, const FitOptions& options,
                                        const ClipOutline& outline, const Context& context) {
  std::vector<FittedClip> clips;
  if (options.shape == FitOptions::Shape::clip) {
    clips.push_back(solved(std::move(frames), options, outline, context));
    return clips;
  }
  for (FittedFrame& frame : frames) {
    const double done = double(clips.size()) / double(frames.size());
    context.report(done);
    if (!clips.empty()) {
      const FittedFrame& before = clips.back().frames.front();
      frame.set_alpha(before.alpha());
      frame.set_beta(before.beta());
      frame.estimate_camera();
    }
    clips.push_back(solved({std::move(frame)}, options, {}, context.part(done, done)));
  }
  return clips;
}

/// Fits frames with landmarks. `times` are the times of these frames.
std::vector<FrameFit> fits_of(std::vector<FittedFrame> frames, const FitOptions& options,
                              const Eigen::VectorXd& times, const ClipOutline& outline,
                              const Context& context) {
  const double solved_at = options.smoothness > 0 ? 0.5 : 1;
  std::vector<FrameFit> fits;
  std::vector<FittedFrame> rough;
  ClipNoise noise;
  for (FittedClip& clip :
       solved_by_shape(std::move(frames), options, outline, context.part(0, solved_at))) {
    if (options.smoothness > 0) {
      noise = clip.noise;
      std::ranges::move(clip.frames, std::back_inserter(rough));
    } else {
      std::ranges::move(results_of(clip), std::back_inserter(fits));
    }
  }
  if (options.smoothness == 0) return fits;
  const bool jointly =
      options.solver == FitOptions::Solver::joint && options.shape == FitOptions::Shape::clip;
  const Context rest = context.part(solved_at, 1);
  FittedClip smooth = jointly ? smoothed(std::move(rough), options, times, rest)
                              : fit_smoothly(std::move(rough), options, times, rest);
  smooth.noise = noise;
  return results_of(smooth);
}

/// Frame without landmarks at a share of the way between two frames with landmarks. Values that are
/// equal in both stay equal.
FrameFit unseen_between(const FrameFit& before, const FrameFit& after, double share) {
  FrameFit fit;
  fit.camera = before.camera + share * (after.camera - before.camera);
  fit.alpha = before.alpha + share * (after.alpha - before.alpha);
  fit.beta = before.beta + share * (after.beta - before.beta);
  fit.depth = before.depth + share * (after.depth - before.depth);
  fit.rms = fit.rms_all = std::numeric_limits<double>::quiet_NaN();
  fit.repeated = before.repeated;
  return fit;
}

/// Fits of all frames, from the fits of frames that are `seen`.
std::vector<FrameFit> with_unseen(const std::vector<FrameFit>& fits,
                                  const std::vector<Eigen::Index>& seen,
                                  const Eigen::VectorXd& times) {
  std::vector<FrameFit> all;
  std::size_t next = 0;
  for (Eigen::Index f = 0; f < times.size(); ++f) {
    if (next < seen.size() && seen[next] == f) {
      all.push_back(fits[next++]);
      continue;
    }
    const std::size_t before = next == 0 ? 0 : next - 1, after = std::min(next, seen.size() - 1);
    const double from = times[seen[before]], length = times[seen[after]] - from;
    const double share = length > 0 ? (times[f] - from) / length : 0;
    all.push_back(unseen_between(fits[before], fits[after], share));
  }
  return all;
}

/// Rows of the seen landmarks. Many frames see the same ones.
using RowsOfSeen = std::map<std::vector<Eigen::Index>, std::shared_ptr<const LandmarkRows>>;

}  // namespace

struct LandmarkFitter::State {
  std::shared_ptr<const LandmarkRows> rows;
  std::shared_ptr<const FaceOutline> outline;

  FittedFrame frame(const Frames& points, Eigen::Index index, const std::vector<Eigen::Index>& seen,
                    const std::optional<double>& sigma, const CameraModel& camera,
                    RowsOfSeen& rows_of_seen) const;
  /// Selects the frames with `indices`. Throws std::invalid_argument.
  ClipOutline on_outline(const Frames& points, Eigen::Index frames,
                         const std::vector<Eigen::Index>& indices) const;
  FitOptions checked(const Frames& points, const FitOptions& options,
                     const Eigen::VectorXd& times) const;
};

/// Options with the default ridge filled in.
FitOptions LandmarkFitter::State::checked(const Frames& points, const FitOptions& options,
                                          const Eigen::VectorXd& times) const {
  check(options);
  const Eigen::Index landmarks = rows->mean.rows();
  if (points.cols() != 2 * landmarks) {
    throw std::invalid_argument("the points have " + std::to_string(points.cols()) +
                                " columns, expected x and y of " + std::to_string(landmarks) +
                                " landmarks");
  }
  if (times.size() != points.rows() && (times.size() > 0 || options.smoothness > 0)) {
    throw std::invalid_argument(std::to_string(times.size()) + " times for " +
                                std::to_string(points.rows()) + " frames");
  }
  FitOptions result = options;
  if (!result.ridge) result.ridge = usual_ridge(rows->expressions.size());
  return result;
}

FittedFrame LandmarkFitter::State::frame(const Frames& points, Eigen::Index index,
                                         const std::vector<Eigen::Index>& seen,
                                         const std::optional<double>& given_sigma,
                                         const CameraModel& camera,
                                         RowsOfSeen& rows_of_seen) const {
  ImagePoints image(seen.size(), 2);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    image.row(static_cast<Eigen::Index>(i)) = points.row(index).segment<2>(2 * seen[i]);
  }
  const bool all = image.rows() == rows->mean.rows();
  const double sigma = given_sigma ? *given_sigma : kUsualSigma * rms_radius(image);
  if (!(sigma > 0)) throw MismatchError(frame_name(index) + "all landmarks are at one place");
  std::shared_ptr<const LandmarkRows>& known = rows_of_seen[seen];
  if (!known) known = all ? rows : std::make_shared<const LandmarkRows>(*rows, seen);
  try {
    return {known, std::move(image), sigma, camera};
  } catch (const MismatchError& error) {
    throw MismatchError(frame_name(index) + error.what());
  }
}

ClipOutline LandmarkFitter::State::on_outline(const Frames& points, Eigen::Index frames,
                                              const std::vector<Eigen::Index>& indices) const {
  if (points.size() == 0) return {};
  if (!outline) throw std::invalid_argument("the fitter was made for no landmarks on the outline");
  if (points.rows() != frames || points.cols() % 2 != 0) {
    throw std::invalid_argument("landmarks on the outline are for " +
                                std::to_string(points.rows()) + " frames, expected " +
                                std::to_string(frames) + " and x and y of each");
  }
  ClipOutline result{outline, {}};
  for (const Eigen::Index f : indices) result.landmarks.push_back(points_of_frame(points, f));
  return result;
}

LandmarkFitter::LandmarkFitter(const MorphableModel& model, const std::vector<int>& vertices,
                               Outline outline) {
  for (const int vertex : vertices) {
    if (vertex >= 0 && vertex < model.vertices()) continue;
    throw MismatchError(
        "a landmark is at vertex " + std::to_string(vertex) + ", but the model has vertices 0 to " +
        std::to_string(model.vertices() - 1) + "; is the mapping for another model?");
  }
  fix_product_blocking();
  state_ = std::make_unique<State>(
      State{std::make_shared<const LandmarkRows>(model, vertices),
            outline == Outline::given ? std::make_shared<const FaceOutline>(model) : nullptr});
}

LandmarkFitter::~LandmarkFitter() = default;
LandmarkFitter::LandmarkFitter(LandmarkFitter&&) noexcept = default;
LandmarkFitter& LandmarkFitter::operator=(LandmarkFitter&&) noexcept = default;

std::vector<FrameFit> LandmarkFitter::fit(const Frames& points, const FitOptions& given,
                                          const Eigen::VectorXd& given_times, const Frames& outline,
                                          const Context& context) const {
  const FitOptions options = state_->checked(points, given, given_times);
  fix_product_blocking();
  const Eigen::Index count = points.rows();
  const Eigen::VectorXd times = given_times.size() > 0
                                    ? given_times
                                    : Eigen::VectorXd::LinSpaced(count, 0, double(count - 1));
  std::vector<Eigen::Index> indices;
  std::vector<std::vector<Eigen::Index>> seen;
  for (Eigen::Index f = 0; f < count; ++f) {
    std::vector<Eigen::Index> landmarks = seen_landmarks(points, f);
    if (landmarks.empty()) continue;
    indices.push_back(f);
    seen.push_back(std::move(landmarks));
  }
  if (seen.empty()) throw MismatchError("no frame has landmarks");
  const CameraModel camera = camera_of(options, seen.size());
  std::vector<FittedFrame> frames;
  RowsOfSeen rows_of_seen;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    frames.push_back(
        state_->frame(points, indices[i], seen[i], options.sigma, camera, rows_of_seen));
  }
  const ClipOutline on_outline = state_->on_outline(outline, points.rows(), indices);
  const std::vector<FrameFit> fits =
      fits_of(std::move(frames), options, times(indices), on_outline, context);
  return with_unseen(fits, indices, times);
}

}  // namespace mimetra
