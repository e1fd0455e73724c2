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

  int vertices() const { return static_cast<int>(mean_.rows()); }
  const Connectivity& connectivity() const { return *connectivity_; }
  const std::shared_ptr<const Connectivity>& shared_connectivity() const { return connectivity_; }
  const Positions& mean() const { return mean_; }
  const ShapeBasis& identities() const { return identities_; }
  const ShapeBasis& expressions() const { return expressions_; }

  /// The person with identity coefficients `alpha` (one per identity, or empty for the mean).
  /// Throws std::invalid_argument where the count differs.
  BlendshapeModel person(const Eigen::VectorXd& alpha = {}) const;

 private:
  std::shared_ptr<const Connectivity> connectivity_ = std::make_shared<Connectivity>();
  Positions mean_;
  ShapeBasis identities_;
  ShapeBasis expressions_;
};

}  // namespace mimetra
