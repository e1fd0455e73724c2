#include <stdexcept>
#include <utility>

#include "toolkit/model/morphable_model.h"

namespace mimetra {

MorphableModel::MorphableModel(std::shared_ptr<const Connectivity> connectivity, Positions mean,
                               ShapeBasis identities, ShapeBasis expressions)
    : average_(std::move(connectivity), std::move(mean), std::move(expressions)),
      identities_(std::move(identities)) {
  identities_.check(vertices());
  if (identities_.size() == 0) identities_.displacements.resize(average_.neutral().size(), 0);
}

MorphableModel::MorphableModel(BlendshapeModel person)
    : average_(std::move(person)), identities_{{}, Eigen::MatrixXd(mean().size(), 0)} {}

BlendshapeModel MorphableModel::person(const Eigen::VectorXd& alpha) const {
  if (alpha.size() == 0) return average_;
  if (alpha.size() != identities_.size()) {
    throw std::invalid_argument(std::to_string(alpha.size()) +
                                " identity coefficients for a model of " +
                                std::to_string(identities_.size()) + " identities");
  }
  Positions neutral = mean();
  Eigen::Map<Eigen::VectorXd>(neutral.data(), neutral.size()) += identities_.displacements * alpha;
  return {shared_connectivity(), std::move(neutral), expressions()};
}

}  // namespace mimetra
