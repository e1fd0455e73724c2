#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "tests/shapes.h"
#include "toolkit/model/blendshape_model.h"
#include "toolkit/regions/regions.h"

/// Small models to transfer between.
namespace mimetra::test {

inline std::shared_ptr<const Connectivity> connectivity_of(const Shape& shape) {
  return std::make_shared<Connectivity>(
      Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles));
}

/// A curved patch of 9 x 9 vertices.
inline Shape patch() {
  Shape shape = grid(9, 9);
  for (int v = 0; v < shape.positions.rows(); ++v) {
    shape.positions(v, 2) = 0.05 * shape.positions.row(v).head<2>().squaredNorm();
  }
  return shape;
}

/// The same patch, squeezed and bent: another identity.
inline Shape bent_patch() {
  Shape shape = patch();
  for (int v = 0; v < shape.positions.rows(); ++v) {
    shape.positions(v, 1) *= 0.8;
    shape.positions(v, 2) += 0.2 * std::cos(shape.positions(v, 0));
  }
  return shape;
}

/// The pose of a sequence of one frame.
inline Positions only_frame(const Frames& frames) {
  return PositionsView(frames.data(), frames.cols() / 3, 3);
}

/// `count` smooth displacement fields, each around its own vertex, with random directions.
inline ShapeBasis bumps(const Positions& positions, int count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  ShapeBasis basis{{}, Eigen::MatrixXd::Zero(positions.size(), count)};
  for (int j = 0; j < count; ++j) {
    basis.names.push_back("shape" + std::to_string(j));
    const Eigen::RowVector3d center = positions.row((j * 37 + 20) % positions.rows());
    const Eigen::RowVector3d direction(uniform(random), uniform(random), uniform(random));
    for (int v = 0; v < positions.rows(); ++v) {
      const double r2 = (positions.row(v) - center).squaredNorm() / 9;
      if (r2 < 1) {
        basis.displacements.col(j).segment<3>(3 * v) = std::pow(1 - r2, 2) * direction.transpose();
      }
    }
  }
  return basis;
}

inline BlendshapeModel model_on(const Shape& shape, int expressions) {
  return BlendshapeModel(connectivity_of(shape), shape.positions,
                         bumps(shape.positions, expressions));
}

/// Weights within [0, 1], a good part of them at the bounds.
inline Eigen::MatrixXd random_weights(int frames, int expressions, unsigned seed = 2) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.5, 1.5);
  Eigen::MatrixXd weights(frames, expressions);
  for (double& weight : weights.reshaped()) weight = std::clamp(uniform(random), 0.0, 1.0);
  return weights;
}

/// A sequence of arbitrary poses: every vertex moves by up to `amount` in each frame.
inline MeshSequence shaken(const Shape& shape, int frames, double amount, unsigned seed = 3) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  Frames poses(frames, shape.positions.size());
  for (int f = 0; f < frames; ++f) {
    Positions pose = shape.positions;
    for (double& value : pose.reshaped<Eigen::RowMajor>()) value += uniform(random);
    poses.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return MeshSequence(connectivity_of(shape), poses, {}, shape.positions);
}

/// Every other triangle.
inline std::vector<int> half_of(const Triangles& triangles) {
  std::vector<int> rows;
  for (int t = 0; t < triangles.rows(); t += 2) rows.push_back(t);
  return rows;
}

}  // namespace mimetra::test
