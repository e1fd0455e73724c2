#pragma once

#include <cmath>
#include <random>

#include "tests/shapes.h"
#include "toolkit/splocs/decomposition.h"

/// Sequences whose components are known, on flat grids where the straight line is the way along the
/// surface.
namespace mimetra::test {

using DistanceFrom = std::function<Eigen::VectorXd(VertexIndex)>;

/// Straight distances between the rest positions of a flat grid.
inline DistanceFrom straight_distances(const Positions& rest) {
  return [rest](VertexIndex source) {
    return Eigen::VectorXd((rest.rowwise() - rest.row(source)).rowwise().norm());
  };
}

/// cos^2 bump (3N) of height 1 in `direction`, zero from `radius` on.
inline Eigen::RowVectorXd bump(const Positions& rest, const Eigen::RowVector3d& center,
                               double radius, const Eigen::RowVector3d& direction) {
  Eigen::RowVectorXd field = Eigen::RowVectorXd::Zero(rest.size());
  for (Eigen::Index v = 0; v < rest.rows(); ++v) {
    const double r = (rest.row(v) - center).norm() / radius;
    if (r >= 1) continue;
    const double height = std::pow(std::cos(r * std::numbers::pi / 2), 2);
    field.segment<3>(3 * v) = height * direction.normalized();
  }
  return field;
}

/// rest + W C.
inline MeshSequence synthesised(const Shape& shape, const Eigen::MatrixXd& W, const Frames& C) {
  const Eigen::Map<const Eigen::RowVectorXd> rest(shape.positions.data(), shape.positions.size());
  Frames frames = rest.replicate(W.rows(), 1) + W * C;
  return {Connectivity::from_triangles(static_cast<int>(shape.positions.rows()), shape.triangles),
          std::move(frames),
          {},
          shape.positions};
}

/// Three bumps far apart on a 30 x 12 grid, each with its own course in time between 0 and 1.
struct Bumps {
  Shape shape = grid(30, 12);
  Frames C;
  Eigen::MatrixXd W;

  Bumps() : C(3, shape.positions.size()), W(24, 3) {
    const Positions& rest = shape.positions;
    C.row(0) = 3 * bump(rest, {5, 6, 0}, 4, {0, 0, 1});
    C.row(1) = 2 * bump(rest, {15, 5, 0}, 4, {1, 0, 1});
    C.row(2) = 1 * bump(rest, {24, 6, 0}, 4, {0, -1, 2});
    for (int f = 0; f < W.rows(); ++f) {
      const double time = 2 * std::numbers::pi * f / static_cast<double>(W.rows());
      W.row(f) << (1 - std::cos(time)) / 2, (1 + std::cos(3 * time)) / 2,
          std::pow(std::sin(time), 2);
    }
  }

  MeshSequence sequence() const { return synthesised(shape, W, C); }
};

/// A flat grid on which overlapping bumps and a little noise move to and fro.
inline MeshSequence restless_grid(int columns = 14, int rows = 9, int frames = 20,
                                  unsigned seed = 7) {
  const Shape shape = grid(columns, rows);
  std::mt19937 random(seed);
  // Not std::normal_distribution: its values are the library's choice.
  const auto uniform = [&random] { return random() / 2147483648.0 - 1; };
  const int bumps = 5;
  Frames C(bumps, shape.positions.size());
  Eigen::MatrixXd W(frames, bumps);
  for (int k = 0; k < bumps; ++k) {
    // One after the other: in which order arguments are evaluated is the compiler's choice.
    const double y = (1 + uniform()) / 2 * rows, x = (1 + uniform()) / 2 * columns;
    const Eigen::RowVector3d center(x, y, 0);
    C.row(k) = bump(shape.positions, center, 4, {uniform(), uniform(), uniform()});
    for (int f = 0; f < frames; ++f) {
      W(f, k) = uniform() + 0.5 + std::sin(0.3 * (k + 1) * f);
    }
  }
  const MeshSequence smooth = synthesised(shape, W, C);
  Frames noisy = smooth.positions();
  for (double& x : noisy.reshaped()) x += 0.02 * uniform();
  return smooth.with_frames(std::move(noisy));
}

/// Overlapping components keep the tests below off exact ties: d_min 1, d_max 6 grid spacings.
inline DecompositionOptions grid_options(const MeshSequence& sequence, int count) {
  DecompositionOptions options;
  options.count = count;
  options.d_min = 1;
  options.d_max = 6;
  options.iterations = 10;
  options.tolerance = 0;
  options.distances = one_by_one(straight_distances(sequence.rest()));
  return options;
}

}  // namespace mimetra::test
