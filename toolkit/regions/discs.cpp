#include "toolkit/regions/discs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "toolkit/mesh/rounding.h"

namespace mimetra {

namespace {

/// Distance between compared centres, as a share of the radius.
constexpr double kSpacing = 0.25;

/// Radius of a ball that contains the disc, in radii of the disc. Distances by the heat method can
/// be shorter than the straight line.
constexpr double kBall = 1.1;

/// Discs that are measured together, which costs less per disc.
constexpr std::size_t kBatch = 8;

/// Points in cubic cells, to find the points near a place.
class PointGrid {
 public:
  explicit PointGrid(double side) : side_(side) {}

  void add(int number, const Eigen::RowVector3d& point) {
    cells_[key(cell(point))].push_back(number);
  }

  /// Calls `work` for each point in the cell of `point` and the 26 cells around it.
  template <typename Work>
  void for_near(const Eigen::RowVector3d& point, const Work& work) const {
    const Cell center = cell(point);
    for (int number = 0; number < 27; ++number) {
      const Cell at = {center[0] + number % 3 - 1, center[1] + number / 3 % 3 - 1,
                       center[2] + number / 9 - 1};
      const auto found = cells_.find(key(at));
      if (found == cells_.end()) continue;
      for (const int near : found->second) work(near);
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell(const Eigen::RowVector3d& point) const {
    const auto along = [&](int c) {
      return static_cast<std::int64_t>(std::floor(point[c] / side_));
    };
    return {along(0), along(1), along(2)};
  }

  /// Distant cells may share a key, so callers must compare distances.
  static std::uint64_t key(const Cell& cell) {
    constexpr int kBits = 21;
    constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
    return (static_cast<std::uint64_t>(cell[0]) & kMask) << 2 * kBits |
           (static_cast<std::uint64_t>(cell[1]) & kMask) << kBits |
           (static_cast<std::uint64_t>(cell[2]) & kMask);
  }

  double side_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

/// Drops the digits that rounding decides, so that an order does not depend on them.
double without_rounding(double x) {
  constexpr double kSteps = 1 << 30;
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return std::ldexp(std::round(kSteps * mantissa), exponent);
}

/// Indices of the positive entries, from the largest to the smallest.
std::vector<int> falling(const Eigen::VectorXd& values) {
  std::vector<int> order;
  for (int i = 0; i < values.size(); ++i) {
    if (values[i] > 0) order.push_back(i);
  }
  std::ranges::stable_sort(order, std::greater(),
                           [&values](int i) { return without_rounding(values[i]); });
  return order;
}

/// Sum over the triangles of some vertices, counting each triangle once.
class TriangleSum {
 public:
  explicit TriangleSum(const Eigen::VectorXd& amounts)
      : amounts_(amounts), last_(amounts.size(), -1) {}

  void start() {
    ++round_;
    sum_ = 0;
  }
  void add(const std::vector<int>& triangles) {
    for (const int triangle : triangles) {
      if (std::exchange(last_[triangle], round_) != round_) sum_ += amounts_[triangle];
    }
  }
  double sum() const { return sum_; }

 private:
  const Eigen::VectorXd& amounts_;
  std::vector<int> last_;
  int round_ = -1;
  double sum_ = 0;
};

/// Triangles of each vertex, ascending (N).
std::vector<std::vector<int>> triangles_of_vertices(int vertices, const Triangles& triangles) {
  std::vector<std::vector<int>> of_vertex(vertices);
  for (int t = 0; t < triangles.rows(); ++t) {
    for (const VertexIndex v : triangles.row(t)) of_vertex[v].push_back(t);
  }
  return of_vertex;
}

/// Disc around a vertex, from its distances to all vertices (N). `inside` (N, empty for all):
/// vertices that it may contain.
Disc disc_around(VertexIndex center, const Eigen::Ref<const Eigen::VectorXd>& distances,
                 double radius, const std::vector<std::vector<int>>& triangles_of_vertex,
                 const std::vector<bool>& inside) {
  Disc disc;
  disc.center = center;
  for (VertexIndex v = 0; v < distances.size(); ++v) {
    // A centre without triangles has no distances, not even to itself.
    const bool is_near = distances[v] <= (1 + kNearTie) * radius || v == center;
    if (!is_near || !(inside.empty() || inside[v])) continue;
    disc.vertices.push_back(v);
    const std::vector<int>& around = triangles_of_vertex[v];
    disc.triangles.insert(disc.triangles.end(), around.begin(), around.end());
  }
  std::ranges::sort(disc.triangles);
  disc.triangles.erase(std::unique(disc.triangles.begin(), disc.triangles.end()),
                       disc.triangles.end());
  return disc;
}

}  // namespace

DiscSearch::DiscSearch(Positions positions, Triangles triangles, DistanceFunction distances,
                       double radius, std::vector<bool> inside)
    : positions_(std::move(positions)),
      triangles_(std::move(triangles)),
      distances_(std::move(distances)),
      radius_(radius),
      inside_(std::move(inside)),
      triangles_of_vertex_(triangles_of_vertices(static_cast<int>(positions_.rows()), triangles_)) {
}

std::vector<DiscSearch::Candidate> DiscSearch::candidates(const Eigen::VectorXd& amounts) const {
  Eigen::VectorXd at_vertex = Eigen::VectorXd::Zero(positions_.rows());
  for (int t = 0; t < triangles_.rows(); ++t) {
    for (const VertexIndex v : triangles_.row(t)) {
      if (is_inside(v)) at_vertex[v] += amounts[t];
    }
  }
  const auto distance = [this](VertexIndex a, VertexIndex b) {
    return (positions_.row(a) - positions_.row(b)).norm();
  };
  const double spacing = kSpacing * radius_;
  PointGrid centers(spacing), vertices(kBall * radius_);
  for (int v = 0; v < positions_.rows(); ++v) {
    if (at_vertex[v] > 0) vertices.add(v, positions_.row(v));
  }
  TriangleSum sum(amounts);
  Eigen::VectorXd bounds = Eigen::VectorXd::Zero(positions_.rows());
  for (const VertexIndex v : falling(at_vertex)) {
    bool is_apart = true;
    centers.for_near(positions_.row(v),
                     [&](VertexIndex other) { is_apart &= distance(v, other) >= spacing; });
    if (!is_apart) continue;
    centers.add(v, positions_.row(v));
    sum.start();
    vertices.for_near(positions_.row(v), [&](VertexIndex near) {
      if (distance(v, near) <= (1 + kNearTie) * kBall * radius_)
        sum.add(triangles_of_vertex_[near]);
    });
    bounds[v] = sum.sum();
  }
  std::vector<Candidate> result;
  for (const VertexIndex v : falling(bounds)) result.push_back({v, bounds[v]});
  return result;
}

void DiscSearch::measure(std::span<const Candidate> some) {
  std::vector<VertexIndex> unknown;
  for (const Candidate& candidate : some) {
    if (!discs_.contains(candidate.center)) unknown.push_back(candidate.center);
  }
  if (unknown.empty()) return;
  const Eigen::MatrixXd distances = distances_(unknown);
  for (std::size_t i = 0; i < unknown.size(); ++i) {
    discs_[unknown[i]] = disc_around(unknown[i], distances.col(static_cast<Eigen::Index>(i)),
                                     radius_, triangles_of_vertex_, inside_);
  }
}

Disc DiscSearch::best(const Eigen::VectorXd& amounts) {
  const std::vector<Candidate> all = candidates(amounts);
  const Disc* best = nullptr;
  double held = 0;
  for (std::size_t first = 0; first < all.size(); first += kBatch) {
    const auto batch = std::span(all).subspan(first, std::min(kBatch, all.size() - first));
    if (batch.front().bound <= (1 + kNearTie) * held) break;
    measure(batch);
    for (const Candidate& candidate : batch) {
      const Disc& disc = discs_.at(candidate.center);
      const double sum = amounts(disc.triangles).sum();
      if (sum <= (1 + kNearTie) * held) continue;
      held = sum;
      best = &disc;
    }
  }
  return best ? *best : Disc();
}

namespace {

/// Discs that are measured together; their distances (N each) are not kept.
constexpr std::size_t kDiscsPerBatch = 16;

void check_spread(const Positions& positions, const FarthestDiscsOptions& options) {
  if (!(options.radius > 0 && std::isfinite(options.radius))) {
    throw std::invalid_argument("radius is " + std::to_string(options.radius) +
                                "; it must be above 0");
  }
  if (options.count < 1) {
    throw std::invalid_argument("count is " + std::to_string(options.count) + "; at least 1 disc");
  }
  const auto vertices = static_cast<std::size_t>(positions.rows());
  if (!options.inside.empty() && options.inside.size() != vertices) {
    throw std::invalid_argument("inside: " + std::to_string(options.inside.size()) +
                                " vertices, expected " + std::to_string(vertices));
  }
}

/// First vertex with the largest number, apart from near ties; -1 if no number is positive.
VertexIndex farthest_vertex(const Eigen::VectorXd& squares) {
  VertexIndex best = -1;
  double most = 0;
  for (VertexIndex v = 0; v < squares.size(); ++v) {
    if (squares[v] <= (1 + kNearTie) * most) continue;
    most = squares[v];
    best = v;
  }
  return best;
}

std::vector<VertexIndex> spread_vertices(const Positions& positions, const Triangles& triangles,
                                         const FarthestDiscsOptions& options) {
  std::vector<bool> may_be(positions.rows(), false);
  for (const VertexIndex v : triangles.reshaped()) {
    may_be[v] = options.inside.empty() || options.inside[v];
  }
  const Eigen::RowVector3d middle = positions.colwise().mean();
  Eigen::VectorXd squares = (positions.rowwise() - middle).rowwise().squaredNorm();
  for (VertexIndex v = 0; v < squares.size(); ++v) {
    if (!may_be[v]) squares[v] = 0;
  }
  std::vector<VertexIndex> centers;
  while (static_cast<int>(centers.size()) < options.count) {
    const VertexIndex next = farthest_vertex(squares);
    if (next < 0) break;
    const Eigen::VectorXd from_next =
        (positions.rowwise() - positions.row(next)).rowwise().squaredNorm();
    if (centers.empty()) {
      squares = from_next;
      for (VertexIndex v = 0; v < squares.size(); ++v) {
        if (!may_be[v]) squares[v] = 0;
      }
    } else {
      squares = squares.cwiseMin(from_next);
    }
    centers.push_back(next);
  }
  return centers;
}

}  // namespace

std::vector<Disc> farthest_discs(const Positions& positions, const Triangles& triangles,
                                 const DistanceFunction& distances,
                                 const FarthestDiscsOptions& options) {
  check_spread(positions, options);
  const auto of_vertex = triangles_of_vertices(static_cast<int>(positions.rows()), triangles);
  const std::vector<VertexIndex> centers = spread_vertices(positions, triangles, options);
  std::vector<Disc> discs;
  for (std::size_t first = 0; first < centers.size(); first += kDiscsPerBatch) {
    const auto batch =
        std::span(centers).subspan(first, std::min(kDiscsPerBatch, centers.size() - first));
    const Eigen::MatrixXd from_centers = distances(batch);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      discs.push_back(disc_around(batch[i], from_centers.col(static_cast<Eigen::Index>(i)),
                                  options.radius, of_vertex, options.inside));
    }
  }
  return discs;
}

}  // namespace mimetra
