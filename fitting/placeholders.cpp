#include "fitting/placeholders.h"

#include <limits>

namespace mimetra {

namespace {

/// Fewer landmarks are no face that something could lie outside of.
constexpr int kFewForAFace = 5;

using Points = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>;

bool is_placeholder(const Eigen::RowVector2d& point) {
  return point == Eigen::RowVector2d(0, 0) || point == Eigen::RowVector2d(-1, -1);
}

/// The landmarks of a frame (n x 2) that are none, by their rows.
std::vector<Eigen::Index> placeholders_of(const Points& points) {
  std::vector<Eigen::Index> found;
  Eigen::RowVector2d lowest = Eigen::RowVector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::RowVector2d highest = -lowest;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (is_placeholder(points.row(i))) {
      found.push_back(i);
    } else if (!points.row(i).hasNaN()) {
      lowest = lowest.cwiseMin(points.row(i));
      highest = highest.cwiseMax(points.row(i));
    }
  }
  std::erase_if(found, [&](Eigen::Index i) {
    const auto point = points.row(i).array();
    return (lowest.array() <= point).all() && (point <= highest.array()).all();
  });
  return found;
}

}  // namespace

std::string drop_placeholders(LandmarkTrack& track) {
  if (track.landmarks() < kFewForAFace) return "";
  int frames = 0, partly = 0;
  for (Eigen::Index f = 0; f < track.points.rows(); ++f) {
    Points points(track.points.row(f).data(), track.landmarks(), 2);
    const bool was_seen = !points.array().isNaN().all();
    const std::vector<Eigen::Index> placeholders = placeholders_of(points);
    if (placeholders.empty()) continue;
    for (const Eigen::Index landmark : placeholders) {
      points.row(landmark).setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    ++(was_seen && points.array().isNaN().all() ? frames : partly);
  }
  if (frames + partly == 0) return "";
  std::string text = std::to_string(frames + partly) + " of " + std::to_string(track.frames()) +
                     " frames have landmarks at (0, 0) or (-1, -1), outside of the face, which are "
                     "taken as not seen";
  if (frames > 0) text += "; " + std::to_string(frames) + " of them have no others";
  return text;
}

}  // namespace mimetra
