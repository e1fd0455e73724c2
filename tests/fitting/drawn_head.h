#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "samples/head/head.h"
#include "toolkit/io/image.h"

namespace mimetra::test {

/// Where a head is drawn in an image.
struct HeadPlace {
  double x = 0;  ///< of its middle, pixels
  double y = 0;
  double height = 0;  ///< pixels
  double yaw = 0;     ///< degrees
};

/// Draws `pose` as seen from afar over the image: smooth, lit from the upper left, before what is
/// there.
inline void draw_head(const Positions& pose, const Triangles& triangles, const HeadPlace& place,
                      Image& image) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(place.yaw * std::numbers::pi / 180, Eigen::Vector3d::UnitY())
          .toRotationMatrix();
  const Eigen::RowVector3d low = pose.colwise().minCoeff(), high = pose.colwise().maxCoeff();
  const double scale = place.height / (high.y() - low.y());
  const Positions seen = (pose.rowwise() - (low + high) / 2) * turn.transpose() * scale;
  Positions normals = Positions::Zero(pose.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector3d a = seen.row(triangles(t, 0));
    const Eigen::RowVector3d ab = seen.row(triangles(t, 1)) - a, ac = seen.row(triangles(t, 2)) - a;
    for (int corner = 0; corner < 3; ++corner) normals.row(triangles(t, corner)) += ab.cross(ac);
  }
  const Eigen::RowVector3d light = Eigen::RowVector3d(-0.4, 0.5, 0.77).normalized();
  normals.rowwise().normalize();
  const Eigen::VectorXd shade = (normals * light.transpose()).cwiseMax(0);
  std::vector<double> depth(image.pixels.size(), -std::numeric_limits<double>::infinity());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    Eigen::Matrix<double, 3, 2> corner;
    Eigen::Vector3d z, brightness;
    for (int i = 0; i < 3; ++i) {
      const int vertex = triangles(t, i);
      corner.row(i) << place.x + seen(vertex, 0), place.y - seen(vertex, 1);
      z[i] = seen(vertex, 2);
      brightness[i] = shade[vertex];
    }
    Eigen::Matrix2d edges;
    edges << (corner.row(1) - corner.row(0)).transpose(),
        (corner.row(2) - corner.row(0)).transpose();
    if (edges.determinant() >= 0) continue;  // its back is seen
    const Eigen::Matrix2d inverse = edges.inverse();
    const Eigen::RowVector2d first = corner.colwise().minCoeff(),
                             last = corner.colwise().maxCoeff();
    const int left = std::max(0, int(std::floor(first.x()))),
              top = std::max(0, int(std::floor(first.y())));
    const int right = std::min(image.width - 1, int(std::ceil(last.x())));
    const int bottom = std::min(image.height - 1, int(std::ceil(last.y())));
    for (int y = top; y <= bottom; ++y) {
      for (int x = left; x <= right; ++x) {
        const Eigen::Vector2d at = inverse * (Eigen::Vector2d(x, y) - corner.row(0).transpose());
        const Eigen::Vector3d weights(1 - at.sum(), at[0], at[1]);
        if (weights.minCoeff() < 0 || weights.dot(z) <= depth[image.index(x, y)]) continue;
        depth[image.index(x, y)] = weights.dot(z);
        const double light_here = 0.15 + 0.85 * weights.dot(brightness);
        const auto channel = [&](double color) {
          return static_cast<std::uint8_t>(std::clamp(color * light_here, 0.0, 255.0));
        };
        image.at(x, y) = {channel(235), channel(205), channel(190)};
      }
    }
  }
}

/// The built-in head over a grey background.
inline Image drawn_head(int width, int height, const HeadPlace& place,
                        const Eigen::VectorXd& expression = {}) {
  static const BlendshapeModel person = samples::parametric_head().person();
  Image image(width, height, {90, 100, 110});
  const Positions pose = expression.size() > 0 ? person.pose(expression) : person.neutral();
  draw_head(pose, person.connectivity().triangles, place, image);
  return image;
}

}  // namespace mimetra::test
