#pragma once

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// A face that varies in identity and expression: M(alpha, beta) = mean + sum alpha_i V_i +
/// sum beta_j B_j (eq. 3). PCA identities are scaled by their standard deviations, so that alpha_i
/// counts those; their names are "0", "1", ...
class MorphableModel {
 public:
  MorphableModel() = default;
  /// `mean` N x 3; both bases 3N x D, either may be empty. Throws std::invalid_argument where sizes
  /// disagree or a basis has a name twice.
  MorphableModel(std::shared_ptr<const Connectivity> connectivity, Positions mean,
                 ShapeBasis identities, ShapeBasis expressions);

  /// One person: there are no identities.
  explicit MorphableModel(BlendshapeModel person);

  int vertices() const { return average_.vertices(); }
  const Connectivity& connectivity() const { return average_.connectivity(); }
  const std::shared_ptr<const Connectivity>& shared_connectivity() const {
    return average_.shared_connectivity();
  }
  const Positions& mean() const { return average_.neutral(); }
  const ShapeBasis& identities() const { return identities_; }
  const ShapeBasis& expressions() const { return average_.expressions(); }
  /// The person whose neutral is the mean.
  const BlendshapeModel& average() const { return average_; }

  /// The person with identity coefficients `alpha` (one per identity, or empty for the mean).
  /// Throws std::invalid_argument where the count differs.
  BlendshapeModel person(const Eigen::VectorXd& alpha = {}) const;

 private:
  BlendshapeModel average_;
  ShapeBasis identities_;
};

}  // namespace mimetra
