#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Named displacement fields. Column j of `displacements` (3N x D) is x0 y0 z0 x1 ... of shape j
/// minus the neutral.
struct ShapeBasis {
  std::vector<std::string> names;
  Eigen::MatrixXd displacements;

  int size() const { return static_cast<int>(names.size()); }
  /// Index of a name, or -1.
  int find(const std::string& name) const;
  /// Throws std::invalid_argument unless each name occurs once and has a displacement field of
  /// `vertices` vertices. An empty basis fits any mesh.
  void check(int vertices) const;
};

/// A neutral face and its expressions: pose = neutral + sum_j beta_j dV_j (eq. 2).
class BlendshapeModel {
 public:
  BlendshapeModel() = default;
  /// `neutral` N x 3, `expressions` 3N x D (D may be 0). Throws std::invalid_argument if sizes
  /// disagree or a name occurs twice.
  BlendshapeModel(std::shared_ptr<const Connectivity> connectivity, Positions neutral,
                  ShapeBasis expressions);
  /// Takes the neutral, and each expression as a name and a whole face. Throws
  /// std::invalid_argument if an expression has other faces than the neutral or a name occurs
  /// twice.
  BlendshapeModel(const TriMesh& neutral,
                  const std::vector<std::pair<std::string, TriMesh>>& expressions);

  int vertices() const { return static_cast<int>(neutral_.rows()); }
  const Connectivity& connectivity() const { return *connectivity_; }
  const std::shared_ptr<const Connectivity>& shared_connectivity() const { return connectivity_; }
  const Triangles& triangles() const { return connectivity_->triangles; }
  const Positions& neutral() const { return neutral_; }
  const ShapeBasis& expressions() const { return expressions_; }

  /// Pose of the weights `beta` (D). Throws std::invalid_argument for another number of weights.
  Positions pose(const Eigen::VectorXd& beta) const;
  /// One frame per row of `weights` (F x D); the rest pose is the neutral. `times` as in
  /// MeshSequence. Throws std::invalid_argument for another number of weights.
  MeshSequence animate(const Eigen::MatrixXd& weights, Eigen::VectorXd times = {}) const;

 private:
  std::shared_ptr<const Connectivity> connectivity_ = std::make_shared<Connectivity>();
  Positions neutral_;
  ShapeBasis expressions_;
};

/// Scales all displacements of vertex v by shares[v] (N): pose(v) = neutral(v) + shares_v sum_j
/// beta_j dV_j(v). Vertices with a share of 0 stay at the neutral, bit by bit. Throws
/// std::invalid_argument for another number of shares.
BlendshapeModel faded(const BlendshapeModel& model, const Eigen::VectorXd& shares);

/// A face that varies in identity and expression: M(alpha, beta) = mean + sum alpha_i V_i + sum
/// beta_j B_j (eq. 3). PCA identities are scaled by their standard deviations, so that alpha_i
/// counts standard deviations. Their names are "0", "1", ...
class MorphableModel {
 public:
  MorphableModel() = default;
  /// `mean` N x 3; both bases 3N x D, either may be empty. Throws std::invalid_argument if sizes
  /// disagree or a basis has a name twice.
  MorphableModel(std::shared_ptr<const Connectivity> connectivity, Positions mean,
                 ShapeBasis identities, ShapeBasis expressions);

  /// A single person, without identities.
  explicit MorphableModel(BlendshapeModel person);

  int vertices() const { return average_.vertices(); }
  const Connectivity& connectivity() const { return average_.connectivity(); }
  const std::shared_ptr<const Connectivity>& shared_connectivity() const {
    return average_.shared_connectivity();
  }
  const Positions& mean() const { return average_.neutral(); }
  const ShapeBasis& identities() const { return identities_; }
  const ShapeBasis& expressions() const { return average_.expressions(); }
  /// Person whose neutral is the mean.
  const BlendshapeModel& average() const { return average_; }

  /// Person with identity coefficients `alpha` (one per identity, or empty for the mean). Throws
  /// std::invalid_argument for another number of coefficients.
  BlendshapeModel person(const Eigen::VectorXd& alpha = {}) const;

 private:
  BlendshapeModel average_;
  ShapeBasis identities_;
};

}  // namespace mimetra
