#include "fitting/fit_verdict.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/Geometry>

#include "toolkit/mesh/median.h"
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
  // Slivers of a model turn over in people that it is made of, up to 6 of 13120 in twenty of them.
  constexpr double kMostFlipped = 1e-3;
  return alpha_max > kLargest || flipped > kMostFlipped * triangles;
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
  verdict.triangles = static_cast<int>(triangles.rows());
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

double FitResiduals::typical() const {
  std::vector<double> seen;
  std::ranges::copy_if(of_frames, std::back_inserter(seen),
                       [](double residual) { return !std::isnan(residual); });
  return seen.empty() ? 0 : median(std::move(seen));
}

FitResiduals residuals_of(const MeshSequence& sequence, const FittedCoefficients& fit,
                          const MappedLandmarks& mapped) {
  const auto landmarks = static_cast<Eigen::Index>(mapped.vertices.size());
  FitResiduals residuals{
      Eigen::VectorXd::Constant(fit.frames(), std::numeric_limits<double>::quiet_NaN()),
      Eigen::VectorXd::Zero(landmarks)};
  Eigen::VectorXd times_seen = Eigen::VectorXd::Zero(landmarks);
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) continue;
    const Eigen::RowVector4d depth =
        fit.depths.rows() > 0 ? fit.depths.row(f) : Eigen::RowVector4d(0, 0, 0, 1);
    const ImagePoints expected =
        project(fit.cameras[static_cast<std::size_t>(f)],
                Positions(sequence.frame(f)(mapped.vertices, Eigen::all)), depth);
    const Eigen::RowVectorXd row = mapped.points.row(f);
    const ImagePoints points = row.reshaped<Eigen::RowMajor>(landmarks, 2);
    std::vector<Eigen::Index> seen;
    for (Eigen::Index i = 0; i < landmarks; ++i) {
      if (!points.row(i).hasNaN()) seen.push_back(i);
    }
    if (seen.empty()) continue;
    const Eigen::VectorXd squares = (points - expected)(seen, Eigen::all).rowwise().squaredNorm();
    residuals.of_frames[f] = std::sqrt(squares.mean()) / rms_radius(points(seen, Eigen::all));
    residuals.of_landmarks(seen) += squares;
    times_seen(seen).array() += 1;
  }
  residuals.of_landmarks =
      (residuals.of_landmarks.array() / times_seen.array().max(1)).sqrt().matrix();
  return residuals;
}

double stretch_of(const std::vector<AffineCamera>& cameras, const FittedCoefficients& fit) {
  double sum = 0;
  int seen = 0;
  for (int f = 0; f < fit.frames(); ++f) {
    if (fit.landmarks[f] == 0) continue;
    const auto axes = cameras[static_cast<std::size_t>(f)].leftCols<3>();
    sum += std::log(axes.row(0).norm() / axes.row(1).norm());
    ++seen;
  }
  return seen > 0 ? std::exp(sum / seen) : 1;
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
