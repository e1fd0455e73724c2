#include "toolkit/transfer/transfer_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/measures.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/soft_border.h"

namespace mimetra {

namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3d normal_of(const Edges& edges) {
  return edges.col(0).cross(edges.col(1));
}

/// Angle from the first normal to the second around the edge, in (-pi, pi]; empty if a normal is 0.
std::optional<double> angle_between(const Eigen::Vector3d& first, const Eigen::Vector3d& second,
                                    const Eigen::Vector3d& edge) {
  if (first.squaredNorm() == 0 || second.squaredNorm() == 0) return {};
  const Eigen::Vector3d axis = first.cross(second);
  const double angle = std::atan2(axis.norm(), first.dot(second));
  return axis.dot(edge) < 0 ? -angle : angle;
}

/// Equal angle in (-pi, pi].
double turned(double angle) {
  if (angle > kPi) return angle - 2 * kPi;
  return angle <= -kPi ? angle + 2 * kPi : angle;
}

/// Edge from a corner to the next one, in terms of [b - a, c - a].
Eigen::Vector2d side_of(int corner) {
  const std::array<Eigen::Vector2d, 3> sides = {Eigen::Vector2d(1, 0), Eigen::Vector2d(-1, 1),
                                                Eigen::Vector2d(0, -1)};
  return sides[corner];
}

}  // namespace

BorderCrease::BorderCrease(const Positions& rest, const Triangles& triangles,
                           const Eigen::VectorXd& weights, const std::vector<bool>& counts)
    : triangles_(triangles) {
  if (weights.size() == 0 || weights.minCoeff() == weights.maxCoeff()) return;
  std::vector<bool> takes_part = counts;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (quality_of(rest, triangles, t) < kDegenerateQuality) takes_part[t] = false;
  }
  const EdgeSides edges(static_cast<int>(rest.rows()), triangles);
  edges.for_each_edge([&](std::span<const int> all_sides) {
    std::vector<int> sides;
    std::ranges::copy_if(all_sides, std::back_inserter(sides),
                         [&](int side) { return takes_part[side / 3]; });
    if (sides.size() != 2) return;
    const int first = sides[0] / 3, second = sides[1] / 3;
    const double change = std::abs(weights[first] - weights[second]);
    if (change == 0) return;
    // Both sides point along the edge as the first triangle has it.
    const int corner = sides[0] % 3, corner_of_second = sides[1] % 3;
    const VertexIndex from = triangles(first, corner), to = triangles(first, (corner + 1) % 3);
    const Eigen::Vector2d in_second = side_of(corner_of_second);
    const bool is_opposite = triangles(second, corner_of_second) != from;
    const Eigen::Vector3d edge = (rest.row(to) - rest.row(from)).transpose();
    const auto angle = angle_between(normal_of(edges_of(rest, triangles, first)),
                                     normal_of(edges_of(rest, triangles, second)), edge);
    hinges_.push_back({first, second, side_of(corner),
                       is_opposite ? Eigen::Vector2d(-in_second) : in_second, change * edge.norm(),
                       angle.value_or(0)});
  });
}

BorderCrease::Excess BorderCrease::operator()(const std::vector<Edges>& wanted,
                                              const PositionsView& pose) const {
  Excess excess;
  double squares = 0, weights = 0;
  for (const Hinge& hinge : hinges_) {
    const Edges first = edges_of(pose, triangles_, hinge.first);
    const Edges second = edges_of(pose, triangles_, hinge.second);
    const Eigen::Vector3d found_edge = first * hinge.in_first;
    const auto found = angle_between(normal_of(first), normal_of(second), found_edge);
    const Edges &one = wanted[hinge.first], &other = wanted[hinge.second];
    const Eigen::Vector3d wanted_edge = one * hinge.in_first + other * hinge.in_second;
    const auto asked = angle_between(normal_of(one), normal_of(other), wanted_edge);
    if (!found || !asked) continue;
    const double bend = turned(*found - hinge.at_rest), due = turned(*asked - hinge.at_rest);
    const double same_way = std::max(0.0, bend < 0 ? -due : due);
    const double degrees = std::max(0.0, std::abs(bend) - same_way) * 180 / kPi;
    squares += hinge.weight * degrees * degrees;
    weights += hinge.weight;
    excess.largest = std::max(excess.largest, degrees);
  }
  if (weights > 0) excess.rms = std::sqrt(squares / weights);
  return excess;
}

namespace {

/// Changes of the target's edges that the source's gradients ask for. (Q_i - I) V_i is the sum over
/// source triangles s of (U~_s - U_s) T_is. The constant T_is is U_s^-1 V_i times the share of s.
class WantedChange {
 public:
  /// `triangles` belong to the target.
  WantedChange(const Positions& source_rest, const Positions& target_rest,
               const Triangles& triangles, const Pairing* pairing)
      : gradients_(gradients_between(source_rest, triangles, pairing, all_triangles(triangles))),
        rest_frames_(frames(source_rest)) {
    for (int t = 0; t < triangles.rows(); ++t) {
      for (const auto& [source, share] : gradients_.parts(t)) {
        factors_.push_back(share * gradients_.inverse_frame(source) *
                           edges_of(target_rest, triangles, t));
      }
    }
  }

  /// (Q_i - I) V_i of every triangle.
  std::vector<Edges> operator()(const PositionsView& frame) const {
    std::vector<Eigen::Matrix3d> change = frames(frame);
    for (std::size_t s = 0; s < change.size(); ++s) change[s] -= rest_frames_[s];
    std::vector<Edges> wanted(gradients_.selected().size(), Edges::Zero());
    auto factor = factors_.begin();
    for (std::size_t t = 0; t < wanted.size(); ++t) {
      for (const auto& part : gradients_.parts(static_cast<int>(t))) {
        wanted[t] += change[part.triangle] * *factor++;
      }
    }
    return wanted;
  }

 private:
  std::vector<Eigen::Matrix3d> frames(const Eigen::Ref<const Positions>& positions) const {
    const Triangles& triangles = gradients_.triangles();
    std::vector<Eigen::Matrix3d> result(triangles.rows());
    for (int s = 0; s < triangles.rows(); ++s) {
      result[s] = triangle_frame(positions, triangles, s);
    }
    return result;
  }

  DeformationGradients gradients_;
  std::vector<Eigen::Matrix3d> rest_frames_;
  std::vector<Edges> factors_;
};

/// Returns true if the sizes of source and result match their pairing, or each other without one.
bool fit_together(const FrameSource& source, const FrameSource& result, const Pairing* pairing) {
  const Eigen::Index from = source.triangles().rows(), to = result.triangles().rows();
  if (source.frames() != result.frames()) return false;
  if (!pairing) return source.vertices() == result.vertices() && from == to;
  return source.vertices() == pairing->source_vertices() &&
         result.vertices() == pairing->target_vertices() &&
         from == pairing->source_triangles().rows() &&
         to == pairing->triangles().target_triangles();
}

void check(const FrameSource& source, const FrameSource& result, const std::vector<int>& selected,
           const TransferErrorOptions& options) {
  check_options(options);
  if (!fit_together(source, result, options.pairing.get())) {
    const auto size = [](const FrameSource& sequence) {
      return std::to_string(sequence.frames()) + " frames of " +
             std::to_string(sequence.vertices()) + " vertices and " +
             std::to_string(sequence.triangles().rows()) + " triangles";
    };
    throw MismatchError("the source has " + size(source) + ", the result " + size(result));
  }
  for (const int triangle : selected) {
    if (triangle >= 0 && triangle < result.triangles().rows()) continue;
    throw std::invalid_argument("triangle " + std::to_string(triangle) +
                                " is selected, expected 0 to " +
                                std::to_string(result.triangles().rows() - 1));
  }
}

/// Vertices in no selected triangle, or of weight 0. With a pairing, only vertices with carriers.
std::vector<VertexIndex> outside_of(const std::vector<int>& selected, const FrameSource& result,
                                    const TransferErrorOptions& options) {
  std::vector<bool> inside(result.vertices(), false);
  for (const int triangle : selected) {
    for (const VertexIndex vertex : result.triangles().row(triangle)) inside[vertex] = true;
  }
  for (VertexIndex v = 0; v < options.weights.size(); ++v) inside[v] = options.weights[v] > 0;
  std::vector<VertexIndex> outside;
  for (int v = 0; v < result.vertices(); ++v) {
    const bool is_carried = !options.pairing || !options.pairing->carriers(v).empty();
    if (!inside[v] && is_carried) outside.push_back(v);
  }
  return outside;
}

/// Shares of the wanted motion (M); empty if vertices have no weights.
Eigen::VectorXd shares_of(const FrameSource& result, const TransferErrorOptions& options) {
  if (options.weights.size() == 0) return {};
  check_weights(options.weights, result.vertices());
  return triangle_weights(result.triangles(), options.weights);
}

BorderCrease crease_of(const FrameSource& result, const std::vector<int>& counted,
                       const TransferErrorOptions& options) {
  Eigen::VectorXd weights = options.weights;
  if (weights.size() == 0) {
    weights.resize(static_cast<Eigen::Index>(options.inside.size()));
    for (std::size_t v = 0; v < options.inside.size(); ++v) {
      weights[static_cast<Eigen::Index>(v)] = options.inside[v];
    }
  }
  if (weights.size() == 0) weights = Eigen::VectorXd::Ones(result.vertices());
  check_weights(weights, result.vertices());
  const Triangles& triangles = result.triangles();
  std::vector<bool> counts(triangles.rows(), false);
  for (const int t : counted) counts[t] = true;
  const bool is_welded = !options.weld.representative.empty();
  return {result.rest(), is_welded ? options.weld.welded(triangles) : triangles,
          triangle_weights(triangles, weights), counts};
}

/// Mean over some triangles; 0 if there are none.
double mean_over(const Eigen::VectorXd& of_triangles, const std::vector<int>& triangles) {
  double mean = 0;
  for (const int triangle : triangles) mean += of_triangles[triangle] / double(triangles.size());
  return mean;
}

bool is_flipped(const Edges& wanted, const Edges& found) {
  return wanted.col(0).cross(wanted.col(1)).dot(found.col(0).cross(found.col(1))) < 0;
}

enum Measured {
  kSum,            ///< squared errors, summed over all triangles
  kShare,          ///< squared errors against the demanded share
  kStill,          ///< squared errors of a result at rest
  kLeak,           ///< squared
  kFlipped,        ///< number of triangles
  kCrease,         ///< RMS over the border
  kLargestCrease,  ///< largest over the border
  kMeasured        ///< number of measurements
};
using MeasuredRow = Eigen::Matrix<double, 1, kMeasured>;

class FrameErrors {
 public:
  FrameErrors(const FrameSource& source, const FrameSource& result,
              const std::vector<int>& selected, const TransferErrorOptions& options)
      : factor_(edge_factor(options.edges)),
        wanted_change_(source.rest(), result.rest(), result.triangles(), options.pairing.get()),
        triangles_(result.triangles()),
        counted_(with_partners(all_triangles(triangles_), options.pairing.get())),
        rest_(result.rest()),
        has_side_(triangles_.rows()),
        shares_(shares_of(result, options)),
        outside_(outside_of(selected, result, options)),
        crease_(crease_of(result, counted_, options)) {
    if (shares_.size() > 0) largest_share_ = shares_.maxCoeff();
    for (int t = 0; t < triangles_.rows(); ++t) {
      has_side_[t] = quality_of(rest_, triangles_, t) >= kSliverQuality;
    }
  }

  /// Keeps the triangles whose corners all take all of the motion.
  std::vector<int> taking_all(std::vector<int> triangles) const {
    if (shares_.size() == 0) return triangles;
    std::erase_if(triangles, [this](int triangle) { return shares_[triangle] < 1; });
    return triangles;
  }

  int counted() const { return static_cast<int>(counted_.size()); }

  /// `squares` receives the errors of the triangles (M), and must be 0 before.
  MeasuredRow operator()(const PositionsView& source, const PositionsView& result,
                         Eigen::Ref<Eigen::RowVectorXd> squares) const {
    MeasuredRow measured = MeasuredRow::Zero();
    std::vector<Edges> wanted = wanted_change_(source);
    for (const int t : counted_) {
      const Edges neutral = edges_of(rest_, triangles_, t);
      const Edges found = edges_of(result, triangles_, t);
      const double squared = sum_of_squares(wanted[t] - (found - neutral));
      squares[t] = squared;
      measured[kSum] += squared;
      const Edges asked = shares_.size() > 0 ? Edges(shares_[t] * wanted[t]) : wanted[t];
      if (tells_what_is_missing(t)) {
        measured[kShare] += sum_of_squares(asked - (found - neutral));
        measured[kStill] += sum_of_squares(asked);
      }
      wanted[t] += neutral;
      if (has_side_[t] && is_flipped(neutral + asked, found)) ++measured[kFlipped];
    }
    const BorderCrease::Excess excess = crease_(wanted, result);
    measured[kCrease] = excess.rms;
    measured[kLargestCrease] = excess.largest;
    for (const VertexIndex v : outside_) {
      measured[kLeak] = std::max(measured[kLeak], (result.row(v) - rest_.row(v)).squaredNorm());
    }
    return measured;
  }

 private:
  /// No gradients fade out exactly as the shares do. If some triangles take all of the motion, only
  /// these count.
  bool tells_what_is_missing(int triangle) const {
    return shares_.size() == 0 || largest_share_ < 1 || shares_[triangle] == 1;
  }

  double sum_of_squares(const Edges& change) const {
    return change.lazyProduct(factor_).squaredNorm();
  }

  Eigen::Matrix2d factor_;
  WantedChange wanted_change_;
  const Triangles& triangles_;
  std::vector<int> counted_;
  const Positions& rest_;
  std::vector<bool> has_side_;  // true if a triangle is not a sliver (M)
  Eigen::VectorXd shares_;      // of the triangles (M); empty if all are 1
  double largest_share_ = 1;
  std::vector<VertexIndex> outside_;
  BorderCrease crease_;
};

}  // namespace

TransferError transfer_error(const FrameSource& source, const FrameSource& result,
                             const std::vector<int>& selected, const TransferErrorOptions& options,
                             const Context& context) {
  check(source, result, selected, options);
  const auto triangles = static_cast<int>(result.triangles().rows());
  const FrameErrors errors_of(source, result, selected, options);
  const int count = errors_of.counted();
  const auto measure = [&](int first, const FrameBlock& poses, FrameRows& numbers) {
    const FrameBlock found(result, first, poses.frames());
    for (int row = 0; row < poses.frames(); ++row) {
      numbers.row(row).tail<kMeasured>() =
          errors_of(poses.frame(row), found.frame(row), numbers.row(row).head(triangles));
    }
  };
  const FrameNumbers measured = over_frames(source, triangles, kMeasured, measure, context);
  TransferError error;
  error.per_triangle = measured.sum;
  error.per_frame = measured.of_each.col(kSum);
  double leak = 0;
  for (const auto& frame : measured.of_each.rowwise()) {
    error.de_share += frame[kShare];
    error.de_still += frame[kStill];
    leak = std::max(leak, frame[kLeak]);
    error.flipped += static_cast<int>(frame[kFlipped]);
    error.crease = std::max(error.crease, frame[kCrease]);
    error.largest_crease = std::max(error.largest_crease, frame[kLargestCrease]);
  }
  error.leak = std::sqrt(leak);
  error.triangles = count;
  error.per_frame /= std::max(count, 1);
  error.per_triangle /= source.frames();
  error.de_all = error.per_frame.mean();
  const double summands = static_cast<double>(std::max(count, 1)) * source.frames();
  error.de_share /= summands;
  error.de_still /= summands;
  const std::vector<int> region = with_partners(selected, options.pairing.get());
  error.de_region = mean_over(error.per_triangle, region);
  const std::vector<int> inside = errors_of.taking_all(region);
  if (!inside.empty()) error.de_inside = mean_over(error.per_triangle, inside);
  return error;
}

double flipped_share(const TransferError& error) {
  const double all = static_cast<double>(error.triangles) * double(error.per_frame.size());
  return all > 0 ? error.flipped / all : 0;
}

double missed_share(const TransferError& error) {
  return error.de_still > 0 ? error.de_share / error.de_still : 0;
}

double mean_percentage_error(double full, double k) {
  return k == full ? 0 : 100 * (full - k) / full;
}

}  // namespace mimetra
