#include "toolkit/model/blendshape_model.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_set>
#include <utility>

#include "toolkit/mesh/rounding.h"

namespace mimetra {

namespace {

Eigen::Map<const Eigen::VectorXd> flat(const Positions& positions) {
  return {positions.data(), positions.size()};
}

void check_weight_count(Eigen::Index weights, int expressions) {
  if (weights == expressions) return;
  throw std::invalid_argument(std::to_string(weights) + " weights for a model of " +
                              std::to_string(expressions) + " expressions");
}

ShapeBasis differences(const TriMesh& neutral,
                       const std::vector<std::pair<std::string, TriMesh>>& poses) {
  ShapeBasis basis;
  basis.displacements.resize(neutral.positions.size(), std::ssize(poses));
  for (const auto& [name, pose] : poses) {
    if (!same_faces(pose.connectivity, neutral.connectivity)) {
      throw std::invalid_argument("expression '" + name + "' has other faces than the neutral");
    }
    basis.displacements.col(basis.size()) = flat(pose.positions) - flat(neutral.positions);
    basis.names.push_back(name);
  }
  return basis;
}

}  // namespace

int ShapeBasis::find(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

void ShapeBasis::check(int vertices) const {
  if (displacements.cols() != size()) {
    throw std::invalid_argument(std::to_string(displacements.cols()) + " displacement fields for " +
                                std::to_string(size()) + " shape names");
  }
  if (size() > 0 && displacements.rows() != 3 * static_cast<Eigen::Index>(vertices)) {
    throw std::invalid_argument("displacement fields have " + std::to_string(displacements.rows()) +
                                " rows, expected 3 x " + std::to_string(vertices) + " vertices");
  }
  std::unordered_set<std::string> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) {
      throw std::invalid_argument("shape name '" + name + "' occurs twice");
    }
  }
}

BlendshapeModel::BlendshapeModel(std::shared_ptr<const Connectivity> connectivity,
                                 Positions neutral, ShapeBasis expressions)
    : connectivity_(std::move(connectivity)),
      neutral_(std::move(neutral)),
      expressions_(std::move(expressions)) {
  if (!connectivity_) throw std::invalid_argument("a model needs a connectivity");
  if (neutral_.rows() != connectivity_->vertices) {
    throw std::invalid_argument("the neutral has " + std::to_string(neutral_.rows()) +
                                " vertices, expected " + std::to_string(connectivity_->vertices) +
                                " as in the connectivity");
  }
  expressions_.check(vertices());
  if (expressions_.size() == 0) expressions_.displacements.resize(neutral_.size(), 0);
}

BlendshapeModel::BlendshapeModel(const TriMesh& neutral,
                                 const std::vector<std::pair<std::string, TriMesh>>& expressions)
    : BlendshapeModel(std::make_shared<const Connectivity>(neutral.connectivity), neutral.positions,
                      differences(neutral, expressions)) {}

Positions BlendshapeModel::pose(const Eigen::VectorXd& beta) const {
  check_weight_count(beta.size(), expressions_.size());
  Positions pose = neutral_;
  Eigen::Map<Eigen::VectorXd>(pose.data(), pose.size()) += expressions_.displacements * beta;
  return pose;
}

MeshSequence BlendshapeModel::animate(const Eigen::MatrixXd& weights, Eigen::VectorXd times) const {
  check_weight_count(weights.cols(), expressions_.size());
  fix_product_blocking();
  Frames frames = flat(neutral_).transpose().replicate(weights.rows(), 1);
  frames.noalias() += weights * expressions_.displacements.transpose();
  return {connectivity_, std::move(frames), std::move(times), neutral_};
}

BlendshapeModel faded(const BlendshapeModel& model, const Eigen::VectorXd& shares) {
  if (shares.size() != model.vertices()) {
    throw std::invalid_argument(std::to_string(shares.size()) + " shares for a model of " +
                                std::to_string(model.vertices()) + " vertices");
  }
  ShapeBasis expressions = model.expressions();
  for (Eigen::Index v = 0; v < shares.size(); ++v) {
    expressions.displacements.middleRows<3>(3 * v) *= shares[v];
  }
  return {model.shared_connectivity(), model.neutral(), std::move(expressions)};
}

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
