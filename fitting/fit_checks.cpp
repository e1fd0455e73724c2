#include "fitting/fit_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "fitting/affine_camera.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/parameter.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// Longer side of the first image in pixels; empty if it cannot be read.
std::optional<int> longer_side(const ImageSequence& images) {
  try {
    const Image image = images.image(0);
    return std::max(image.width, image.height);
  } catch (const IoError&) {
    return std::nullopt;
  }
}

}  // namespace

double camera_distance(const MorphableModel& model, const MappedLandmarks& mapped,
                       double focal_length) {
  const Positions rest = model.mean()(mapped.vertices, Eigen::all);
  const double side = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).maxCoeff();
  std::vector<double> distances;
  for (Eigen::Index f = 0; f < mapped.points.rows(); ++f) {
    const std::vector<Eigen::Index> seen = seen_landmarks(mapped.points, f);
    if (seen.size() < 2) continue;
    const double on_model = rms_radius(rest(seen, Eigen::all));
    const double in_image = rms_radius(points_of_frame(mapped.points, f)(seen, Eigen::all));
    distances.push_back(focal_length * on_model / (in_image * side));
  }
  return distances.empty() ? std::numeric_limits<double>::infinity() : median(std::move(distances));
}

void check_focal_length(const FitOptions& options, const MorphableModel& model,
                        const MappedLandmarks& mapped, const ImageSequence* images) {
  if (!options.focal_length) return;
  const double given = *options.focal_length;
  const double distance = camera_distance(model, mapped, given);
  if (distance >= 1) return;
  constexpr double kFilmWidth = 36;
  constexpr int kHdWidth = 1920;
  const std::optional<int> side = images ? longer_side(*images) : std::nullopt;
  throw UsageError("--focal-length: " + readable(given) + " pixels put the camera " +
                   readable(distance, 2) +
                   " times the face's size from it, expected more than once; is it in "
                   "millimetres? A lens of " +
                   readable(given) + " mm in 35 mm equivalents has " + readable(given) +
                   " / 36 of the image's longer side: " +
                   std::to_string(std::lround(given / kFilmWidth * side.value_or(kHdWidth))) +
                   " pixels " + (side ? "here" : "where that is " + std::to_string(kHdWidth)));
}

TurnUncertainty::TurnUncertainty(const MorphableModel& model, const std::vector<int>& vertices,
                                 const Eigen::Matrix3d& ahead) {
  const auto count = static_cast<Eigen::Index>(vertices.size());
  const Eigen::MatrixXd& expressions = model.expressions().displacements;
  // Rotation, position, size and stretch of the face in the image, as in the camera model.
  constexpr Eigen::Index kCamera = 8;
  image_.setZero(2 * count, kCamera + expressions.cols());
  Positions points = model.mean()(vertices, Eigen::all) * ahead.transpose();
  points.rowwise() -= points.colwise().mean().eval();
  const double radius = std::sqrt(points.leftCols<2>().rowwise().squaredNorm().mean());
  points /= radius;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Vector3d point = points.row(i);
    auto rows = image_.middleRows<2>(2 * i);
    for (int axis = 0; axis < 3; ++axis) {
      rows.col(axis) = Eigen::Vector3d::Unit(axis).cross(point).head<2>();
    }
    rows.middleCols<2>(3).setIdentity();
    rows.col(5) = point.head<2>();
    rows.col(6) << point.x(), -point.y();
    rows.col(7) << point.y(), point.x();
    if (expressions.cols() == 0) continue;
    const auto moves = expressions.middleRows<3>(3 * Eigen::Index(vertices[std::size_t(i)]));
    rows.rightCols(expressions.cols()) = (ahead * moves / radius).topRows<2>();
  }
  image_ /= kUsualSigma;
  // Standard deviations are a radian of rotation, and a radius for position and size. Expression
  // weights are uniform between 0 and 1.
  const double stretch = FitOptions{}.stretch;
  prior_.setOnes(image_.cols());
  prior_.segment<2>(6).setConstant(1 / (stretch * stretch));
  prior_.tail(expressions.cols()).setConstant(12);
}

double TurnUncertainty::of(const std::vector<Eigen::Index>& seen) const {
  Eigen::MatrixXd rows(2 * Eigen::Index(seen.size()), image_.cols());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    rows.middleRows<2>(2 * Eigen::Index(i)) = image_.middleRows<2>(2 * seen[i]);
  }
  Eigen::MatrixXd information = rows.transpose() * rows;
  information.diagonal() += prior_;
  const Eigen::MatrixXd turn = Eigen::MatrixXd::Identity(image_.cols(), 3);
  const double variance = information.llt().solve(turn).topRows<3>().trace();
  return std::sqrt(variance) * 180 / EIGEN_PI;
}

std::vector<int> partial_frames(const MorphableModel& model, const MappedLandmarks& mapped) {
  // Half a face has 2.4 to 3.5 degrees, brows and eyes 3.3, nose and mouth together 3 to 4.4. The
  // nose alone has 5 to 7, the mouth alone 6 to 13.
  constexpr double kMost = 4;
  const TurnUncertainty uncertainty(model, mapped.vertices,
                                    looking_ahead(model.mean(), mapped.ibug));
  std::map<std::vector<Eigen::Index>, double> known;  // many frames see the same landmarks
  std::vector<int> partial;
  std::size_t whole = 0;
  for (int f = 0; f < mapped.points.rows(); ++f) {
    const std::vector<Eigen::Index> seen = seen_landmarks(mapped.points, f);
    if (seen.empty()) continue;
    const auto [entry, added] = known.try_emplace(seen, 0);
    if (added) entry->second = uncertainty.of(seen);
    if (entry->second > kMost) {
      partial.push_back(f);
    } else {
      ++whole;
    }
  }
  if (whole == 0) return {};
  if (whole < partial.size()) {
    std::erase_if(partial, [&mapped](int frame) {
      return seen_landmarks(mapped.points, frame).size() >= kLandmarksOfCamera;
    });
  }
  return partial;
}

}  // namespace mimetra
