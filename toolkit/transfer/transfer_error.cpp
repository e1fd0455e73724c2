#include "toolkit/transfer/transfer_error.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "toolkit/mesh/errors.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/edges.h"
#include "toolkit/transfer/pairs.h"

namespace mimetra {

namespace {

/// What the source's gradients make of the target's edges: (Q_i - I) V_i is the sum over the source
/// triangles s of (U~_s - U_s) T_is with the constant T_is = U_s^-1 V_i times the share of s.
class WantedChange {
 public:
  /// `triangles` of the target.
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

/// Whether the sizes of a source and a result are those of their pairing, or without one the same.
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
           const Pairing* pairing) {
  if (!fit_together(source, result, pairing)) {
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

/// The vertices that are in no selected triangle; only those that the source's motion carries.
std::vector<VertexIndex> outside_of(const std::vector<int>& selected, const FrameSource& result,
                                    const Pairing* pairing) {
  std::vector<bool> inside(result.vertices(), false);
  for (const int triangle : selected) {
    for (const VertexIndex vertex : result.triangles().row(triangle)) inside[vertex] = true;
  }
  std::vector<VertexIndex> outside;
  for (int v = 0; v < result.vertices(); ++v) {
    const bool is_carried = !pairing || !pairing->carriers(v).empty();
    if (!inside[v] && is_carried) outside.push_back(v);
  }
  return outside;
}

bool is_flipped(const Edges& wanted, const Edges& found) {
  return wanted.col(0).cross(wanted.col(1)).dot(found.col(0).cross(found.col(1))) < 0;
}

/// Measures one frame after the other.
class FrameErrors {
 public:
  FrameErrors(const FrameSource& source, const FrameSource& result,
              const std::vector<int>& selected, const TransferErrorOptions& options)
      : factor_(edge_factor(options.edges)),
        wanted_change_(source.rest(), result.rest(), result.triangles(), options.pairing.get()),
        triangles_(result.triangles()),
        counted_(with_partners(all_triangles(triangles_), options.pairing.get())),
        rest_(result.rest()),
        outside_(outside_of(selected, result, options.pairing.get())) {}

  /// Triangles that count.
  int counted() const { return static_cast<int>(counted_.size()); }

  struct Measured {
    double sum = 0;    ///< of the squared errors of all triangles
    double still = 0;  ///< of those at rest
    double leak = 0;   ///< squared
    int flipped = 0;
  };

  /// `squares` are the errors of the triangles (M), which are 0 before.
  Measured operator()(const PositionsView& source, const PositionsView& result,
                      Eigen::Ref<Eigen::RowVectorXd> squares) const {
    Measured measured;
    const std::vector<Edges> wanted = wanted_change_(source);
    for (const int t : counted_) {
      const Edges neutral = edges_of(rest_, triangles_, t);
      const Edges found = edges_of(result, triangles_, t);
      const double squared = sum_of_squares(wanted[t] - (found - neutral));
      squares[t] = squared;
      measured.sum += squared;
      measured.still += sum_of_squares(wanted[t]);
      if (is_flipped(neutral + wanted[t], found)) ++measured.flipped;
    }
    for (const VertexIndex v : outside_) {
      measured.leak = std::max(measured.leak, (result.row(v) - rest_.row(v)).squaredNorm());
    }
    return measured;
  }

 private:
  double sum_of_squares(const Edges& change) const {
    return change.lazyProduct(factor_).squaredNorm();
  }

  Eigen::Matrix2d factor_;
  WantedChange wanted_change_;
  const Triangles& triangles_;
  std::vector<int> counted_;
  const Positions& rest_;
  std::vector<VertexIndex> outside_;
};

}  // namespace

TransferError transfer_error(const FrameSource& source, const FrameSource& result,
                             const std::vector<int>& selected,
                             const TransferErrorOptions& options) {
  check(source, result, selected, options.pairing.get());
  const auto triangles = static_cast<int>(result.triangles().rows());
  const FrameErrors errors_of(source, result, selected, options);
  const int count = errors_of.counted();
  std::vector<FrameErrors::Measured> frames(source.frames());
  TransferError error;
  error.per_triangle = sum_over_frames(
      source, triangles, {options.threads, options.progress},
      [&](int first, const FrameBlock& poses, FramesView squares) {
        const FrameBlock found(result, first, poses.frames());
        squares.setZero();
        for (int row = 0; row < poses.frames(); ++row) {
          frames[first + row] = errors_of(poses.frame(row), found.frame(row), squares.row(row));
        }
      });
  error.per_frame.resize(source.frames());
  double leak = 0;
  for (int f = 0; f < source.frames(); ++f) {
    error.per_frame[f] = frames[f].sum;
    error.flipped += frames[f].flipped;
    error.de_still += frames[f].still;
    leak = std::max(leak, frames[f].leak);
  }
  error.leak = std::sqrt(leak);
  error.triangles = count;
  error.per_frame /= std::max(count, 1);
  error.per_triangle /= source.frames();
  error.de_all = error.per_frame.mean();
  error.de_still /= static_cast<double>(std::max(count, 1)) * source.frames();
  const std::vector<int> region = with_partners(selected, options.pairing.get());
  for (const int triangle : region) {
    error.de_region += error.per_triangle[triangle] / double(region.size());
  }
  return error;
}

double flipped_share(const TransferError& error) {
  const double all = static_cast<double>(error.triangles) * double(error.per_frame.size());
  return all > 0 ? error.flipped / all : 0;
}

double missed_share(const TransferError& error) {
  return error.de_still > 0 ? error.de_all / error.de_still : 0;
}

double mean_percentage_error(double full, double k) {
  return k == full ? 0 : 100 * (full - k) / full;
}

}  // namespace mimetra
