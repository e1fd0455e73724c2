#include "fitting/camera_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fitting/affine_camera.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/median.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/parameter.h"

namespace mimetra {

namespace {

/// In pixels, of the first image; none where it cannot be read.
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
  for (const auto& frame : mapped.points.rowwise()) {
    const Eigen::RowVectorXd row = frame;
    const ImagePoints points = row.reshaped<Eigen::RowMajor>(rest.rows(), 2);
    std::vector<Eigen::Index> seen;
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      if (points.row(i).allFinite()) seen.push_back(i);
    }
    if (seen.size() < 2) continue;
    const Positions places = rest(seen, Eigen::all);
    const double radius =
        std::sqrt((places.rowwise() - places.colwise().mean()).rowwise().squaredNorm().mean());
    distances.push_back(focal_length * radius / (rms_radius(points(seen, Eigen::all)) * side));
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

}  // namespace mimetra
