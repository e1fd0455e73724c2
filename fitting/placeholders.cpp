#include "fitting/placeholders.h"

#include <limits>

namespace mimetra {

namespace {

/// Fewer landmarks are no face that something could lie outside of.
constexpr int kFewForAFace = 5;

using Points = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>>;

/// The landmarks of a frame (n x 2) at (place, place) that are none, by their rows.
std::vector<Eigen::Index> placeholders_at(double place, const Points& points) {
  std::vector<Eigen::Index> there;
  const Eigen::RowVector2d at = Eigen::RowVector2d::Constant(place);
  Eigen::RowVector2d lowest = Eigen::RowVector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::RowVector2d highest = -lowest;
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    if (points.row(i) == at) {
      there.push_back(i);
    } else if (!points.row(i).hasNaN()) {
      lowest = lowest.cwiseMin(points.row(i));
      highest = highest.cwiseMax(points.row(i));
    }
  }
  const bool is_inside = (lowest.array() <= place).all() && (highest.array() >= place).all();
  return is_inside ? std::vector<Eigen::Index>{} : there;
}

}  // namespace

std::string drop_placeholders(LandmarkTrack& track) {
  if (track.landmarks() < kFewForAFace) return "";
  int frames = 0, partly = 0;
  for (Eigen::Index f = 0; f < track.points.rows(); ++f) {
    Points points(track.points.row(f).data(), track.landmarks(), 2);
    const bool was_seen = !points.array().isNaN().all();
    bool has_some = false;
    for (const double place : {0.0, -1.0}) {
      for (const Eigen::Index landmark : placeholders_at(place, points)) {
        points.row(landmark).setConstant(std::numeric_limits<double>::quiet_NaN());
        has_some = true;
      }
    }
    if (!has_some) continue;
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
