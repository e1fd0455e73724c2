#include <stdexcept>
#include <utility>

#include "toolkit/model/morphable_model.h"

namespace mimetra {

MorphableModel::MorphableModel(std::shared_ptr<const Connectivity> connectivity, Positions mean,
                               ShapeBasis identities, ShapeBasis expressions)
    : connectivity_(std::move(connectivity)),
      mean_(std::move(mean)),
      identities_(std::move(identities)),
      expressions_(std::move(expressions)) {
  if (!connectivity_) throw std::invalid_argument("a model needs a connectivity");
  if (mean_.rows() != connectivity_->vertices) {
    throw std::invalid_argument("the mean has " + std::to_string(mean_.rows()) +
                                " vertices, expected " + std::to_string(connectivity_->vertices) +
                                " as in the connectivity");
  }
  identities_.check(vertices());
  expressions_.check(vertices());
  if (identities_.size() == 0) identities_.displacements.resize(mean_.size(), 0);
  if (expressions_.size() == 0) expressions_.displacements.resize(mean_.size(), 0);
}

BlendshapeModel MorphableModel::person(const Eigen::VectorXd& alpha) const {
  Positions neutral = mean_;
  if (alpha.size() != 0) {
    if (alpha.size() != identities_.size()) {
      throw std::invalid_argument(std::to_string(alpha.size()) +
                                  " identity coefficients for a model of " +
                                  std::to_string(identities_.size()) + " identities");
    }
    Eigen::Map<Eigen::VectorXd>(neutral.data(), neutral.size()) +=
        identities_.displacements * alpha;
  }
  return {connectivity_, std::move(neutral), expressions_};
}

}  // namespace mimetra
