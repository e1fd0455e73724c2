#include "fitting/fit_verdict.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

namespace {

Eigen::RowVector3d normal_of(const Positions& mesh, const Triangles& triangles, Eigen::Index t) {
  const Eigen::RowVector3d corner = mesh.row(triangles(t, 0));
  const Eigen::RowVector3d first = mesh.row(triangles(t, 1)) - corner;
  const Eigen::RowVector3d second = mesh.row(triangles(t, 2)) - corner;
  return first.cross(second);
}

}  // namespace

bool IdentityVerdict::is_doubtful() const {
  constexpr double kLargest = 3.5;  // one of 34 people with 63 identities has a larger one
  return alpha_max > kLargest || flipped > 0;
}

IdentityVerdict verdict_of(const MorphableModel& model, const Eigen::VectorXd& alpha) {
  IdentityVerdict verdict;
  if (alpha.size() == 0) return verdict;
  verdict.alpha_rms = std::sqrt(alpha.squaredNorm() / double(alpha.size()));
  verdict.alpha_max = alpha.cwiseAbs().maxCoeff();
  const Positions neutral = model.person(alpha).neutral();
  const Triangles& triangles = model.connectivity().triangles;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const double cosine =
        normal_of(neutral, triangles, t).dot(normal_of(model.mean(), triangles, t));
    verdict.flipped += cosine < 0;
  }
  return verdict;
}

NeutralDistance neutral_distance(const MorphableModel& model, const Eigen::VectorXd& a,
                                 const Eigen::VectorXd& b) {
  const Eigen::VectorXd distances =
      (model.person(a).neutral() - model.person(b).neutral()).rowwise().norm();
  const Eigen::RowVector3d box =
      model.mean().colwise().maxCoeff() - model.mean().colwise().minCoeff();
  return {distances.mean() / box.maxCoeff(), distances.maxCoeff() / box.maxCoeff()};
}

bool ExpressionUse::is_constant() const {
  constexpr double kMean = 0.7, kShare = 0.5;
  return mean > kMean || at_one > kShare;
}

std::vector<ExpressionUse> expression_use(const Eigen::MatrixXd& beta) {
  std::vector<ExpressionUse> uses;
  for (const auto& column : beta.colwise()) {
    const double frames = double(column.size());
    uses.push_back({column.mean(), double((column.array() <= 0).count()) / frames,
                    double((column.array() >= 1).count()) / frames});
  }
  return uses;
}

int averted_landmarks(const Positions& mesh, const Triangles& triangles,
                      const std::vector<int>& vertices, const AffineCamera& camera) {
  const Eigen::RowVector3d x = camera.row(0).head<3>(), y = camera.row(1).head<3>();
  const Eigen::RowVector3d away = x.cross(y);  // y is down in the image
  Eigen::VectorXd facing = Eigen::VectorXd::Zero(mesh.rows());
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const double turned = normal_of(mesh, triangles, t).dot(away);
    for (int corner = 0; corner < 3; ++corner) facing[triangles(t, corner)] += turned;
  }
  return static_cast<int>(
      std::ranges::count_if(vertices, [&](int vertex) { return facing[vertex] > 0; }));
}

}  // namespace mimetra
