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

namespace mimetra {

namespace {

/// What the source's gradients make of the target's edges: (Q_i - I) V_i is the sum over the source
/// triangles s of (U~_s - U_s) T_is with the constant T_is = U_s^-1 V_i / (their number).
class WantedChange {
 public:
  WantedChange(const Positions& source_rest, const Positions& target_rest,
               const Triangles& triangles)
      : triangles_(triangles),
        gradients_(source_rest, triangles, all_triangles(triangles)),
        rest_frames_(frames(source_rest)) {
    for (int t = 0; t < triangles.rows(); ++t) {
      for (const int source : gradients_.sources(t)) {
        factors_.push_back(gradients_.inverse_frame(source) * edges_of(target_rest, triangles, t) /
                           double(gradients_.sources(t).size()));
      }
    }
  }

  /// (Q_i - I) V_i of every triangle.
  std::vector<Edges> operator()(const PositionsView& frame) const {
    std::vector<Eigen::Matrix3d> change = frames(frame);
    for (std::size_t t = 0; t < change.size(); ++t) change[t] -= rest_frames_[t];
    std::vector<Edges> wanted(change.size(), Edges::Zero());
    auto factor = factors_.begin();
    for (std::size_t t = 0; t < wanted.size(); ++t) {
      for (const int source : gradients_.sources(static_cast<int>(t))) {
        wanted[t] += change[source] * *factor++;
      }
    }
    return wanted;
  }

 private:
  std::vector<Eigen::Matrix3d> frames(const Eigen::Ref<const Positions>& positions) const {
    std::vector<Eigen::Matrix3d> result(triangles_.rows());
    for (int t = 0; t < triangles_.rows(); ++t) {
      result[t] = triangle_frame(positions, triangles_, t);
    }
    return result;
  }

  const Triangles& triangles_;
  DeformationGradients gradients_;
  std::vector<Eigen::Matrix3d> rest_frames_;
  std::vector<Edges> factors_;
};

void check(const MeshSequence& source, const MeshSequence& result,
           const std::vector<int>& selected) {
  if (source.frames() != result.frames() || source.vertices() != result.vertices() ||
      source.triangles().rows() != result.triangles().rows()) {
    const auto size = [](const MeshSequence& sequence) {
      return std::to_string(sequence.frames()) + " frames of " +
             std::to_string(sequence.vertices()) + " vertices and " +
             std::to_string(sequence.triangles().rows()) + " triangles";
    };
    throw MismatchError("the source has " + size(source) + ", the result " + size(result));
  }
  for (const int triangle : selected) {
    if (triangle >= 0 && triangle < source.triangles().rows()) continue;
    throw std::invalid_argument("triangle " + std::to_string(triangle) +
                                " is selected, expected 0 to " +
                                std::to_string(source.triangles().rows() - 1));
  }
}

/// Largest displacement of a vertex in no selected triangle.
double leak_of(const MeshSequence& result, const std::vector<int>& selected) {
  std::vector<bool> inside(result.vertices(), false);
  for (const int triangle : selected) {
    for (const VertexIndex vertex : result.triangles().row(triangle)) inside[vertex] = true;
  }
  double largest = 0;
  for (int f = 0; f < result.frames(); ++f) {
    const PositionsView frame = result.frame(f);
    for (int v = 0; v < result.vertices(); ++v) {
      if (inside[v]) continue;
      largest = std::max(largest, (frame.row(v) - result.rest().row(v)).squaredNorm());
    }
  }
  return std::sqrt(largest);
}

bool is_flipped(const Edges& wanted, const Edges& found) {
  return wanted.col(0).cross(wanted.col(1)).dot(found.col(0).cross(found.col(1))) < 0;
}

}  // namespace

TransferError transfer_error(const MeshSequence& source, const MeshSequence& result,
                             const std::vector<int>& selected) {
  check(source, result, selected);
  const Triangles& triangles = source.triangles();
  const auto count = static_cast<int>(triangles.rows());
  const WantedChange wanted_change(source.rest(), result.rest(), triangles);
  TransferError error;
  error.per_frame = Eigen::VectorXd::Zero(source.frames());
  error.per_triangle = Eigen::VectorXd::Zero(count);
  for (int f = 0; f < source.frames(); ++f) {
    const std::vector<Edges> wanted = wanted_change(source.frame(f));
    for (int t = 0; t < count; ++t) {
      const Edges neutral = edges_of(result.rest(), triangles, t);
      const Edges found = edges_of(result.frame(f), triangles, t);
      const double squared = (wanted[t] - (found - neutral)).squaredNorm();
      error.per_triangle[t] += squared;
      error.per_frame[f] += squared;
      if (is_flipped(neutral + wanted[t], found)) ++error.flipped;
    }
  }
  error.per_frame /= std::max(count, 1);
  error.per_triangle /= source.frames();
  error.de_all = error.per_frame.mean();
  for (const int triangle : selected) {
    error.de_region += error.per_triangle[triangle] / double(selected.size());
  }
  error.leak = leak_of(result, selected);
  return error;
}

double mean_percentage_error(double full, double k) {
  return k == full ? 0 : 100 * (full - k) / full;
}

}  // namespace mimetra
