#include "toolkit/mesh/measures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>

namespace mimetra {
namespace {

Eigen::Vector3d box_sides(const Eigen::Ref<const Positions>& positions) {
  if (positions.rows() == 0) return Eigen::Vector3d::Zero();
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).transpose();
}

using Points = std::vector<Eigen::Vector3d>;

/// Size of a ball up to which points are compared one by one.
constexpr int kFewPoints = 16;

/// Pairs whose bound exceeds the best distance by less than this share, which is rounding, are
/// skipped.
constexpr double kRounding = 1e-14;

/// Points first .. last - 1, with a ball around them.
struct Ball {
  int first, last;
  Eigen::Vector3d center;
  double radius = 0;

  int size() const { return last - first; }
};

/// Finds the pair of points that is farthest apart by halving the set recursively.
class FarthestPair {
 public:
  explicit FarthestPair(Points points) : points_(std::move(points)) {
    balls_.reserve(2 * points_.size() / kFewPoints + 1);
    add_ball(0, static_cast<int>(points_.size()));
  }

  double distance() {
    start();
    search(0, 0);
    return best_;
  }

 private:
  /// Indices of the halves of each ball; 0 if it is not divided.
  struct Halves {
    int lower = 0, upper = 0;
  };

  int add_ball(int first, int last) {
    const auto number = static_cast<int>(balls_.size());
    Eigen::AlignedBox3d box;
    for (int i = first; i < last; ++i) box.extend(points_[i]);
    Ball ball{first, last, box.center()};
    for (int i = first; i < last; ++i) {
      ball.radius = std::max(ball.radius, (points_[i] - ball.center).norm());
    }
    balls_.push_back(ball);
    halves_.emplace_back();
    if (ball.size() <= kFewPoints) return number;
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const int middle = first + ball.size() / 2;
    std::nth_element(points_.begin() + first, points_.begin() + middle, points_.begin() + last,
                     [axis](const auto& a, const auto& b) { return a[axis] < b[axis]; });
    const int lower = add_ball(first, middle);
    const int upper = add_ball(middle, last);
    halves_[number] = {lower, upper};
    return number;
  }

  /// Sets a large initial distance by walking from one far point to the next.
  void start() {
    Eigen::Vector3d from = balls_[0].center;
    for (int steps = 0; steps < 4; ++steps) {
      from = *std::ranges::max_element(
          points_, {}, [&from](const Eigen::Vector3d& p) { return (p - from).squaredNorm(); });
      for (const Eigen::Vector3d& p : points_) best_ = std::max(best_, (p - from).norm());
    }
  }

  void search(int a, int b) {
    const Ball &one = balls_[a], &other = balls_[b];
    const double bound = (one.center - other.center).norm() + one.radius + other.radius;
    if (bound <= best_ * (1 + kRounding)) return;
    if (one.size() <= kFewPoints && other.size() <= kFewPoints) {
      for (int i = one.first; i < one.last; ++i) {
        for (int j = other.first; j < other.last; ++j) {
          best_ = std::max(best_, (points_[i] - points_[j]).norm());
        }
      }
    } else if (a == b) {
      const auto [lower, upper] = halves_[a];
      search(lower, upper);
      search(lower, lower);
      search(upper, upper);
    } else if (other.size() > one.size()) {
      search(b, a);
    } else {
      auto [first, second] = halves_[a];
      const auto from_other = [&](int half) {
        return (balls_[half].center - other.center).norm() + balls_[half].radius;
      };
      if (from_other(second) > from_other(first)) std::swap(first, second);
      search(first, b);
      search(second, b);
    }
  }

  Points points_;
  std::vector<Ball> balls_;
  std::vector<Halves> halves_;
  double best_ = 0;
};

}  // namespace

double extent(const Eigen::Ref<const Positions>& positions) {
  return box_sides(positions).maxCoeff();
}

double box_diagonal(const Eigen::Ref<const Positions>& positions) {
  return box_sides(positions).norm();
}

double diameter(const Eigen::Ref<const Positions>& positions) {
  Points points;
  points.reserve(positions.rows());
  for (const auto& position : positions.rowwise()) {
    if (position.allFinite()) points.push_back(position.transpose());
  }
  return points.size() < 2 ? 0 : FarthestPair(std::move(points)).distance();
}

double diameter(const Positions& positions, const Triangles& triangles) {
  const std::vector<VertexIndex> surface = surface_vertices(positions, triangles);
  return std::ssize(surface) == positions.rows() ? diameter(positions)
                                                 : diameter(positions(surface, Eigen::all));
}

double triangle_quality(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                        const Eigen::Vector3d& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? (b - a).cross(c - a).norm() / longest : 0;
}

bool has_area(const Positions& positions, const Triangles& triangles, Eigen::Index t) {
  const VertexIndex a = triangles(t, 0), b = triangles(t, 1), c = triangles(t, 2);
  if (a == b || b == c || c == a) return false;
  return triangle_quality(positions.row(a), positions.row(b), positions.row(c)) >=
         kDegenerateQuality;
}

Triangles with_area(const Positions& positions, const Triangles& triangles) {
  std::vector<Eigen::Index> sound;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    if (has_area(positions, triangles, t)) sound.push_back(t);
  }
  return triangles(sound, Eigen::all);
}

std::vector<VertexIndex> surface_vertices(const Positions& positions, const Triangles& triangles) {
  const Triangles sound = with_area(positions, triangles);
  return used_vertices(sound.rows() > 0 ? sound : triangles, positions.rows());
}

Eigen::VectorXd vertex_areas(const Positions& positions, const Triangles& triangles) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(positions.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const Eigen::Vector3d a = positions.row(triangles(t, 0)), b = positions.row(triangles(t, 1)),
                          c = positions.row(triangles(t, 2));
    const double third = (b - a).cross(c - a).norm() / 6;
    for (int corner = 0; corner < 3; ++corner) areas[triangles(t, corner)] += third;
  }
  return areas;
}

}  // namespace mimetra
