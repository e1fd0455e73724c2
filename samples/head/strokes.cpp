#include "samples/head/strokes.h"

#include "samples/head/curves.h"

namespace mimetra::samples {

Eigen::Vector3d sculpted(const Eigen::Vector3d& p, std::span<const Stroke> strokes) {
  Eigen::Vector3d result = p;
  for (const Stroke& stroke : strokes) {
    result += within(p, stroke.center, stroke.radii) * stroke.push;
  }
  return result;
}

Eigen::Vector3d sculpted_on_both_sides(const Eigen::Vector3d& p, std::span<const Stroke> strokes) {
  Eigen::Vector3d result = p;
  for (const Stroke& stroke : strokes) {
    Eigen::Vector3d center = stroke.center;
    const double here = within(p, center, stroke.radii);
    center.x() = -center.x();
    const double there = center.x() == 0 ? 0 : within(p, center, stroke.radii);
    const Eigen::Vector3d& push = stroke.push;
    result += Eigen::Vector3d((here - there) * push.x(), (here + there) * push.y(),
                              (here + there) * push.z());
  }
  return result;
}

}  // namespace mimetra::samples
