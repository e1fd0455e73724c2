#include "toolkit/correspondence/mesh_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <Eigen/Geometry>

#include "toolkit/correspondence/closest_surface.h"
#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {
namespace {

using Eigen::Vector3d;

constexpr int kMostPixels = 4096;

/// Grid steps between samples. On a grid, the side of an edge is exact: neighbours leave no gap and
/// share no sample.
constexpr int kSteps = 64;
/// Limit of coordinates, so that products fit into 64 bits.
constexpr double kFarthest = 1 << 29;

/// Brightness of the background, of the mesh's inside, and of its outside in shadow and in light.
constexpr double kBackground = 96, kInside = 24, kShadow = 40, kLit = 225;

using Place = Eigen::Matrix<std::int64_t, 2, 1>;

/// Twice the signed area of three places.
std::int64_t area(const Place& a, const Place& b, const Place& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Assigns a sample on an edge to one of the two triangles.
bool owns_edge(const Place& from, const Place& to) {
  return to.y() != from.y() ? to.y() > from.y() : to.x() < from.x();
}

/// A triangle in the drawing, with its corners in the order of positive area.
struct Drawn {
  std::array<Place, 3> corners;
  std::int64_t twice_area;

  /// Returns true if the triangle contains the sample, with its barycentric coordinates in
  /// `shares`.
  bool holds(const Place& sample, Vector3d& shares) const {
    for (int c = 0; c < 3; ++c) {
      const Place &from = corners[(c + 1) % 3], &to = corners[(c + 2) % 3];
      const std::int64_t part = area(from, to, sample);
      if (part < 0 || (part == 0 && !owns_edge(from, to))) return false;
      shares[c] = static_cast<double>(part) / static_cast<double>(twice_area);
    }
    return true;
  }
};

/// Nearest triangle at each sample of a drawing.
class Samples {
 public:
  /// `side` is the number of samples in each row and column.
  Samples(const Positions& places, const Triangles& triangles, int side)
      : places_(places),
        triangles_(triangles),
        side_(side),
        nearest_(static_cast<std::size_t>(side_) * side_, -1),
        depths_(nearest_.size(), -std::numeric_limits<double>::infinity()) {
    for (int t = 0; t < triangles.rows(); ++t) add(t);
  }

  int nearest(int column, int row) const { return nearest_[index(column, row)]; }

  Vector3d shares(int column, int row) const {
    Vector3d shares = Vector3d::Zero();
    Drawn drawn;
    const bool flipped = corners_of(nearest(column, row), drawn);
    drawn.holds(place_of(column, row), shares);
    if (flipped) std::swap(shares[1], shares[2]);
    return shares;
  }

 private:
  static Place place_of(int column, int row) {
    return {std::int64_t{column} * kSteps, std::int64_t{row} * kSteps};
  }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * side_ + column;
  }

  /// Sets the corners. Returns true if the second and third were exchanged.
  bool corners_of(int t, Drawn& drawn) const {
    for (int c = 0; c < 3; ++c) {
      const auto row = places_.row(triangles_(t, c));
      drawn.corners[c] = {std::llround(row[0]), std::llround(row[1])};
    }
    drawn.twice_area = area(drawn.corners[0], drawn.corners[1], drawn.corners[2]);
    if (drawn.twice_area >= 0) return false;
    std::swap(drawn.corners[1], drawn.corners[2]);
    drawn.twice_area = -drawn.twice_area;
    return true;
  }

  void add(int t) {
    for (const VertexIndex v : triangles_.row(t)) {
      if (places_.row(v).head<2>().cwiseAbs().maxCoeff() > kFarthest) return;
    }
    Drawn drawn;
    const bool flipped = corners_of(t, drawn);
    if (drawn.twice_area == 0) return;
    Place low = drawn.corners[0], high = low;
    for (const Place& corner : drawn.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    const auto first = [&](std::int64_t at) {
      return static_cast<int>(std::clamp<std::int64_t>((at + kSteps - 1) / kSteps, 0, side_));
    };
    const auto last = [&](std::int64_t at) {
      return static_cast<int>(std::clamp<std::int64_t>(at / kSteps, -1, side_ - 1));
    };
    Vector3d shares;
    for (int row = first(low.y()); row <= last(high.y()); ++row) {
      for (int column = first(low.x()); column <= last(high.x()); ++column) {
        if (!drawn.holds(place_of(column, row), shares)) continue;
        if (flipped) std::swap(shares[1], shares[2]);
        offer(t, shares, index(column, row));
      }
    }
  }

  void offer(int t, const Vector3d& shares, std::size_t sample) {
    double depth = 0;
    for (int c = 0; c < 3; ++c) depth += shares[c] * places_(triangles_(t, c), 2);
    if (depth < depths_[sample]) return;
    if (depth == depths_[sample] && !comes_first(t, nearest_[sample])) return;
    depths_[sample] = depth;
    nearest_[sample] = t;
  }

  /// Order of triangles at equal depth: by vertices, so that the order of triangles does not
  /// matter.
  bool comes_first(int a, int b) const {
    const auto corners = [this](int t) {
      return std::tuple(triangles_(t, 0), triangles_(t, 1), triangles_(t, 2), t);
    };
    return b < 0 || corners(a) < corners(b);
  }

  const Positions& places_;
  const Triangles& triangles_;
  int side_;
  std::vector<int> nearest_;
  std::vector<double> depths_;
};

}  // namespace

MeshPainter::MeshPainter(const TriMesh& mesh)
    : positions_(mesh.positions),
      triangles_(Weld::exact(positions_).welded(mesh.connectivity.triangles)),
      normals_(vertex_normals(positions_, triangles_)) {
  const Positions middles = centroids(positions_, triangles_);
  const Positions directions = triangle_normals(positions_, triangles_);
  const Eigen::VectorXd areas = directions.rowwise().norm();
  if (areas.sum() <= 0) return;
  // The normals point outwards if the surface encloses a positive volume. Most of an open cap is in
  // front of its centroid.
  const Eigen::RowVector3d middle = areas.transpose() * middles / areas.sum();
  inside_out_ = (middles.rowwise() - middle).cwiseProduct(directions).sum() < 0;
  if (inside_out_) normals_ = -normals_;
  for (Eigen::Index v = 0; v < normals_.rows(); ++v) normals_.row(v).normalize();
}

MeshDrawing MeshPainter::draw(const MeshView& view) const {
  if (!(view.side > 0) || view.pixels < 1 || view.pixels > kMostPixels) {
    throw std::invalid_argument("a view of " + std::to_string(view.pixels) +
                                " pixels, expected 1 to " + std::to_string(kMostPixels) +
                                ", of a square with a size");
  }
  if (view.samples < 1 || view.samples % 2 == 0) {
    throw std::invalid_argument("a view of " + std::to_string(view.samples) +
                                " samples, expected an odd number");
  }
  const int side = view.pixels * view.samples;
  const double scale = side * kSteps / view.side;
  const double middle = (side - 1) * kSteps / 2.0;
  // Column, row (downwards) and depth towards the viewer, all in grid steps.
  Positions places =
      (positions_.rowwise() - view.centre.transpose()) * view.axes.transpose() * scale;
  places.col(0).array() += middle;
  places.col(1).array() = middle - places.col(1).array();
  const Samples samples(places, triangles_, side);
  const Vector3d light = view.axes.transpose() * view.light.normalized();
  std::vector<bool> outside;
  outside.reserve(static_cast<std::size_t>(triangles_.rows()));
  for (int t = 0; t < triangles_.rows(); ++t) outside.push_back(shows_outside(t, view));
  const auto brightness = [&](int column, int row) {
    const int t = samples.nearest(column, row);
    if (t < 0) return kBackground;
    if (!outside[t]) return kInside;
    const Vector3d shares = samples.shares(column, row);
    Vector3d normal = Vector3d::Zero();
    for (int c = 0; c < 3; ++c) normal += shares[c] * normals_.row(triangles_(t, c)).transpose();
    const double length = normal.norm();
    const double shine = length > 0 ? std::max(0.0, normal.dot(light) / length) : 0;
    return kShadow + (kLit - kShadow) * shine;
  };
  MeshDrawing drawing;
  drawing.image.width = drawing.image.height = view.pixels;
  const int n = view.samples;
  for (int y = 0; y < view.pixels; ++y) {
    for (int x = 0; x < view.pixels; ++x) {
      double sum = 0;
      for (int sample = 0; sample < n * n; ++sample) {
        sum += brightness(n * x + sample % n, n * y + sample / n);
      }
      drawing.image.pixels.push_back(static_cast<std::uint8_t>(std::lround(sum / (n * n))));
      const int column = n * x + n / 2, row = n * y + n / 2;
      SeenPlace place{samples.nearest(column, row)};
      if (place.triangle >= 0) place.shares = samples.shares(column, row);
      drawing.places.push_back(place);
    }
  }
  return drawing;
}

Vector3d MeshPainter::position(const SeenPlace& place) const {
  Vector3d position = Vector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    position += place.shares[c] * positions_.row(triangles_(place.triangle, c)).transpose();
  }
  return position;
}

bool MeshPainter::shows_outside(int triangle, const MeshView& view) const {
  const auto corner = [&](int c) -> Vector3d { return positions_.row(triangles_(triangle, c)); };
  const Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
  return (normal.dot(view.axes.row(2)) > 0) != inside_out_;
}

}  // namespace mimetra
