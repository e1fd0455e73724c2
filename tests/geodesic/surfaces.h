#pragma once

#include <cmath>

#include "geodesic/heat_geodesics.h"
#include "tests/shapes.h"

/// Surfaces for the geodesic tests.
namespace mimetra::test {

/// A sphere with bumps, without symmetry: no four vertices on a circle, so that its intrinsic
/// Delaunay triangulation is the only one.
inline Shape bumpy_sphere(int levels) {
  Shape shape = sphere(levels);
  for (auto p : shape.positions.rowwise()) {
    const double x = p[0], y = p[1], z = p[2];
    p *= 1 + 0.2 * std::sin(3 * x + 1) * std::cos(2 * y - 0.5) + 0.1 * std::sin(5 * z + x);
  }
  return shape;
}

/// Heat distances have conditions of about 1e4 in the heat step and 1e4 in the Poisson system,
/// times 1e-16 for each rounding of the coordinates.
constexpr double kHeatRounding = 1e-9;

inline geodesic::HeatGeodesics heat_on(const Shape& shape,
                                       const geodesic::HeatOptions& options = {}) {
  return {shape.positions, shape.triangles, options};
}

/// Largest |actual - expected| as a share of the largest expected distance.
inline double relative_error(const Eigen::VectorXd& actual, const Eigen::VectorXd& expected) {
  return (actual - expected).cwiseAbs().maxCoeff() / expected.maxCoeff();
}

/// Mean of |actual - expected| as a share of the mean expected distance.
inline double mean_error(const Eigen::VectorXd& actual, const Eigen::VectorXd& expected) {
  return (actual - expected).cwiseAbs().mean() / expected.mean();
}

inline Eigen::VectorXd euclidean(const Positions& positions, int from) {
  return (positions.rowwise() - positions.row(from)).rowwise().norm();
}

/// Three flat pages of (side x side) vertices that share their first row: an edge of three
/// triangles everywhere along the spine. Page k is at k times 120 degrees.
struct Book {
  Shape shape;
  int side;

  /// Vertex in column x and row y of a page; row 0 is the spine.
  int vertex(int page, int x, int y) const {
    return y == 0 ? x : side + page * side * (side - 1) + (y - 1) * side + x;
  }
};

inline Book book(int side) {
  const Shape page = grid(side, side);
  Book result{{Positions(side + 3 * side * (side - 1), 3), Triangles(3 * page.triangles.rows(), 3)},
              side};
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        result.shape.positions.row(result.vertex(k, x, y)) << x, y * std::cos(angle),
            y * std::sin(angle);
      }
    }
    for (int t = 0; t < page.triangles.rows(); ++t) {
      for (int c = 0; c < 3; ++c) {
        const int v = page.triangles(t, c);
        result.shape.triangles(k * page.triangles.rows() + t, c) =
            result.vertex(k, v % side, v / side);
      }
    }
  }
  return result;
}

/// Two flat squares of side x side vertices that share one corner: vertex side * side - 1.
inline Shape touching_squares(int side) {
  const Shape square = grid(side, side);
  const int last = side * side - 1;
  Shape shape{Positions(2 * last + 1, 3), Triangles(2 * square.triangles.rows(), 3)};
  Positions moved = square.positions;
  moved.rowwise() += square.positions.row(last);
  shape.positions << square.positions, moved.bottomRows(last);
  shape.triangles << square.triangles, (square.triangles.array() + last).matrix();
  return shape;
}

/// A Moebius strip of radius 1: `columns` around, `rows` across.
inline Shape moebius_strip(int columns, int rows) {
  Shape shape{Positions(columns * rows, 3), Triangles(2 * columns * (rows - 1), 3)};
  for (int x = 0; x < columns; ++x) {
    const double angle = 2 * std::numbers::pi * x / columns;
    for (int y = 0; y < rows; ++y) {
      const double across = 0.3 * (2.0 * y / (rows - 1) - 1);
      const double radius = 1 + across * std::cos(angle / 2);
      shape.positions.row(x * rows + y) << radius * std::cos(angle), radius * std::sin(angle),
          across * std::sin(angle / 2);
    }
  }
  const auto vertex = [&](int x, int y) {
    return x < columns ? x * rows + y : rows - 1 - y;  // the seam turns the strip over
  };
  int t = 0;
  for (int x = 0; x < columns; ++x) {
    for (int y = 0; y + 1 < rows; ++y) {
      shape.triangles.row(t++) << vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1);
      shape.triangles.row(t++) << vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1);
    }
  }
  return shape;
}

}  // namespace mimetra::test
