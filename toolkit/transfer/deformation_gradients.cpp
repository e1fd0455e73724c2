#include "toolkit/transfer/deformation_gradients.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "toolkit/mesh/inspection.h"

namespace mimetra {

Eigen::Matrix3d triangle_frame(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               const Eigen::Vector3d& c) {
  Eigen::Matrix3d frame;
  frame.col(0) = b - a;
  frame.col(1) = c - a;
  const Eigen::Vector3d normal = frame.col(0).cross(frame.col(1));
  const double length = normal.norm();
  frame.col(2) = length > 0 ? Eigen::Vector3d(normal / std::sqrt(length)) : normal;
  return frame;
}

Eigen::Matrix3d triangle_frame(const Eigen::Ref<const Positions>& positions,
                               const Triangles& triangles, int triangle) {
  const auto corners = triangles.row(triangle);
  return triangle_frame(positions.row(corners[0]), positions.row(corners[1]),
                        positions.row(corners[2]));
}

bool has_usable_frame(const Eigen::Ref<const Positions>& positions, const Triangles& triangles,
                      int triangle) {
  const auto corners = triangles.row(triangle);
  return triangle_quality(positions.row(corners[0]), positions.row(corners[1]),
                          positions.row(corners[2])) >= kDegenerateQuality;
}

DeformationGradients::DeformationGradients(const Positions& rest, const Triangles& triangles,
                                           std::vector<int> selected)
    : triangles_(triangles),
      selected_(std::move(selected)),
      sources_(selected_.size()),
      inverse_frames_(triangles.rows(), Eigen::Matrix3d::Identity()) {
  std::vector<std::vector<int>> neighbors;
  for (std::size_t s = 0; s < selected_.size(); ++s) {
    const int triangle = selected_[s];
    if (triangle < 0 || triangle >= triangles.rows()) {
      throw std::invalid_argument("triangle " + std::to_string(triangle) +
                                  " is selected, expected 0 to " +
                                  std::to_string(triangles.rows() - 1));
    }
    if (has_usable_frame(rest, triangles, triangle)) {
      sources_[s] = {triangle};
    } else {
      ++replaced_;
      if (neighbors.empty()) {
        neighbors = triangle_neighbors(static_cast<int>(rest.rows()), triangles);
      }
      for (const int neighbor : neighbors[triangle]) {
        if (has_usable_frame(rest, triangles, neighbor)) sources_[s].push_back(neighbor);
      }
    }
    for (const int source : sources_[s]) {
      inverse_frames_[source] = triangle_frame(rest, triangles, source).inverse();
    }
  }
}

Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> DeformationGradients::operator()(
    const Eigen::Ref<const Positions>& frame) const {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> gradients(3 * selected_.size(), 3);
  for (std::size_t s = 0; s < selected_.size(); ++s) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();
    for (const int source : sources_[s]) {
      gradient += triangle_frame(frame, triangles_, source) * inverse_frames_[source];
    }
    if (sources_[s].empty()) {
      gradient.setIdentity();
    } else {
      gradient /= static_cast<double>(sources_[s].size());
    }
    gradients.middleRows<3>(static_cast<Eigen::Index>(3 * s)) = gradient;
  }
  return gradients;
}

}  // namespace mimetra
