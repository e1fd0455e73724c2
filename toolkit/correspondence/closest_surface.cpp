// Only this file includes CGAL's tree, which takes long to compile.

#include "toolkit/correspondence/closest_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include "toolkit/mesh/normals.h"
#include "toolkit/mesh/surface.h"

namespace mimetra {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Corner = std::vector<Kernel::Triangle_3>::const_iterator;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Corner>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using Box = Tree::Bounding_box;
using Eigen::Vector3d;

/// Barycentric coordinates of a point in a triangle.
using Shares = Vector3d;

/// Barycentric coordinates of the nearest point: a corner, on an edge, or inside. Corners that take
/// no part have exactly 0. [Ericson. Real-Time Collision Detection, 2005], section 5.1.5
Shares closest_shares(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = ab.dot(p - b), d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {1 - v, v, 0};
  }
  const double d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {1 - w, 0, w};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  return Shares(va, vb, vc) / (va + vb + vc);
}

double squared_distance(const Vector3d& p, const Box& box) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double outside = std::max({(box.min)(axis)-p[axis], p[axis] - (box.max)(axis), 0.0});
    sum += outside * outside;
  }
  return sum;
}

}  // namespace

struct ClosestSurface::State {
  State(const Positions& own_positions, const Triangles& own_triangles)
      : positions(own_positions),
        triangles(own_triangles),
        normals(triangle_normals(positions, triangles)),
        borders(border_edges(static_cast<int>(positions.rows()), triangles)),
        border_edge(3 * triangles.rows(), false),
        border_vertex(positions.rows(), false) {
    for (const BorderEdge& edge : borders) {
      border_edge[3 * edge.triangle + edge.corner] = true;
      border_vertex[triangles(edge.triangle, edge.corner)] = true;
      border_vertex[triangles(edge.triangle, (edge.corner + 1) % 3)] = true;
    }
    const auto point = [this](int t, int corner) {
      const auto row = positions.row(triangles(t, corner));
      return Kernel::Point_3(row[0], row[1], row[2]);
    };
    for (int t = 0; t < triangles.rows(); ++t) {
      corners.emplace_back(point(t, 0), point(t, 1), point(t, 2));
    }
    tree.rebuild(corners.begin(), corners.end());
    tree.build();
  }

  Vector3d corner(int t, int number) const { return positions.row(triangles(t, number)); }
  bool faces(int t, const Vector3d& normal) const { return normals.row(t).dot(normal) > 0; }

  /// Squared distance to a triangle, and its nearest point.
  std::pair<double, Shares> nearest_in(int t, const Vector3d& point) const {
    const Vector3d a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
    const Shares shares = closest_shares(point, a, b, c);
    const Vector3d at = shares[0] * a + shares[1] * b + shares[2] * c;
    return {(at - point).squaredNorm(), shares};
  }

  /// Returns true if a point of triangle t is on the border.
  bool on_border(int t, const Shares& shares) const {
    for (int c = 0; c < 3; ++c) {
      if (shares[c] == 1 && border_vertex[triangles(t, c)]) return true;
      // The edge from corner c is opposite to corner c + 2.
      if (shares[(c + 2) % 3] == 0 && border_edge[3 * t + c]) return true;
    }
    return false;
  }

  const Positions positions;
  const Triangles triangles;
  const Positions normals;
  const std::vector<BorderEdge> borders;
  std::vector<bool> border_edge, border_vertex;
  std::vector<Kernel::Triangle_3> corners;
  Tree tree;
};

namespace {

/// Walks CGAL's tree, nearer boxes first. `Measure(triangle)` returns a squared distance and
/// barycentric coordinates. It is called only for triangles for which `Faces` is true.
template <typename Faces, typename Measure>
class NearestFirst {
 public:
  using Priority = double;

  NearestFirst(const Vector3d& point, Corner first, Faces faces, Measure measure)
      : point_(point), first_(first), faces_(faces), measure_(measure) {}

  bool go_further() const { return true; }
  template <typename Query>
  void intersection(const Query& /*point*/, const Primitive& primitive) {
    const auto t = static_cast<int>(primitive.id() - first_);
    if (!faces_(t)) return;
    const auto [distance, shares] = measure_(t);
    if (std::pair(distance, t) < std::pair(distance_, triangle_)) {
      std::tie(distance_, triangle_, shares_) = std::tuple(distance, t, shares);
    }
  }
  template <typename Query, typename Node>
  bool do_intersect(const Query& /*point*/, const Node& node) const {
    return squared_distance(point_, node.bbox()) <= distance_;
  }
  template <typename Query, typename Node>
  std::pair<bool, Priority> do_intersect_with_priority(const Query& /*point*/,
                                                       const Node& node) const {
    const double distance = squared_distance(point_, node.bbox());
    return {distance <= distance_, -distance};
  }

  int triangle() const { return distance_ < kNone ? triangle_ : -1; }
  double distance() const { return distance_; }
  const Shares& shares() const { return shares_; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  Vector3d point_;
  Corner first_;
  Faces faces_;
  Measure measure_;
  double distance_ = kNone;
  int triangle_ = -1;
  Shares shares_ = Shares::Zero();
};

template <typename State, typename Measure>
SurfacePoint nearest(const State& surface, const Vector3d& point, const Vector3d& normal,
                     Measure measure) {
  const auto faces = [&](int t) { return surface.faces(t, normal); };
  NearestFirst search(point, surface.corners.begin(), faces, measure);
  surface.tree.traversal_with_priority(point, search);
  if (search.triangle() < 0) return {};
  const int t = search.triangle();
  const Shares& shares = search.shares();
  const Vector3d position = shares[0] * surface.corner(t, 0) + shares[1] * surface.corner(t, 1) +
                            shares[2] * surface.corner(t, 2);
  return {t, position, search.distance(), surface.on_border(t, shares)};
}

}  // namespace

ClosestSurface::ClosestSurface(const Positions& positions, const Triangles& triangles)
    : state_(std::make_unique<State>(positions, triangles)) {}

ClosestSurface::~ClosestSurface() = default;

SurfacePoint ClosestSurface::closest(const Vector3d& point, const Vector3d& normal) const {
  return nearest(*state_, point, normal, [&](int t) { return state_->nearest_in(t, point); });
}

SurfacePoint ClosestSurface::nearest_centroid(const Vector3d& point, const Vector3d& normal) const {
  const State& s = *state_;
  return nearest(s, point, normal, [&](int t) {
    const Vector3d at = (s.corner(t, 0) + s.corner(t, 1) + s.corner(t, 2)) / 3;
    return std::pair((at - point).squaredNorm(), Shares(Shares::Constant(1.0 / 3)));
  });
}

SurfacePoint ClosestSurface::closest_on_border(const Vector3d& point, const Vector3d& normal,
                                               const Vector3d& direction) const {
  const State& s = *state_;
  SurfacePoint best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  for (const BorderEdge& edge : s.borders) {
    const Vector3d a = s.corner(edge.triangle, edge.corner);
    const Vector3d way = s.corner(edge.triangle, (edge.corner + 1) % 3) - a;
    if (!s.faces(edge.triangle, normal) || way.dot(direction) <= 0) continue;
    const double share = std::clamp((point - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
    const Vector3d at = a + share * way;
    const double distance = (at - point).squaredNorm();
    if (distance < best.squared_distance) best = {edge.triangle, at, distance, true};
  }
  return best.triangle < 0 ? SurfacePoint{} : best;
}

double ClosestSurface::distance(const Vector3d& point) const {
  const State& s = *state_;
  NearestFirst search(
      point, s.corners.begin(), [](int) { return true; },
      [&](int t) { return s.nearest_in(t, point); });
  s.tree.traversal_with_priority(point, search);
  return std::sqrt(search.distance());
}

Seen ClosestSurface::seen_from(const Vector3d& point, const Vector3d& direction) const {
  const State& s = *state_;
  const Kernel::Ray_3 ray({point[0], point[1], point[2]},
                          Kernel::Direction_3(direction[0], direction[1], direction[2]));
  const auto hit = s.tree.first_intersected_primitive(ray);
  if (!hit) return Seen::nothing;
  return s.faces(static_cast<int>(*hit - s.corners.begin()), -direction) ? Seen::front : Seen::back;
}

std::vector<BorderEdge> border_edges(int vertices, const Triangles& triangles) {
  std::vector<BorderEdge> borders;
  EdgeSides(vertices, triangles).for_each_edge([&borders](std::span<const int> sides) {
    if (sides.size() == 1) borders.push_back({sides[0] / 3, sides[0] % 3});
  });
  return borders;
}

Positions centroids(const Eigen::Ref<const Positions>& positions, const Triangles& triangles) {
  Positions result(triangles.rows(), 3);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    result.row(t) = (positions.row(triangles(t, 0)) + positions.row(triangles(t, 1)) +
                     positions.row(triangles(t, 2))) /
                    3;
  }
  return result;
}

}  // namespace mimetra
