#include "samples/head/curves.h"

namespace mimetra::samples {

double Curve::slope(std::size_t knot) const {
  if (knot == 0 || knot + 1 == knots_.size()) return 0;
  const Knot &before = knots_[knot - 1], &after = knots_[knot + 1];
  return (after.y - before.y) / (after.x - before.x);
}

double Curve::operator()(double x) const {
  if (x <= knots_.front().x) return knots_.front().y;
  if (x >= knots_.back().x) return knots_.back().y;
  std::size_t i = 0;
  while (x >= knots_[i + 1].x) ++i;
  const double h = knots_[i + 1].x - knots_[i].x;
  const double t = (x - knots_[i].x) / h;
  const double rise = smooth_step(t);
  const double rest = 1 - t;
  return (1 - rise) * knots_[i].y + rise * knots_[i + 1].y + t * rest * rest * h * slope(i) -
         t * t * rest * h * slope(i + 1);
}

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
