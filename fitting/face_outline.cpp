#include "fitting/face_outline.h"

#include <algorithm>
#include <limits>
#include <span>

#include "toolkit/mesh/surface.h"

namespace mimetra {

FaceOutline::FaceOutline(const MorphableModel& model) : model_(model) {
  const Triangles& triangles = model.connectivity().triangles;
  EdgeSides(model.connectivity().vertices, triangles, Collapsed::kept)
      .for_each_edge([&](std::span<const int> sides) {
        const int triangle = sides[0] / 3, corner = sides[0] % 3;
        const auto [from, to] =
            std::minmax({triangles(triangle, corner), triangles(triangle, (corner + 1) % 3)});
        edges_.push_back({from, to, {triangle, sides.size() == 2 ? sides[1] / 3 : -1}});
      });
}

Positions FaceOutline::neutral(const Eigen::VectorXd& alpha) const {
  return model_.person(alpha).neutral();
}

std::vector<FaceOutline::Edge> FaceOutline::seen_outline(const ImagePoints& image) const {
  const Triangles& triangles = model_.connectivity().triangles;
  std::vector<bool> front(static_cast<std::size_t>(triangles.rows()));
  for (int t = 0; t < triangles.rows(); ++t) {
    const Eigen::RowVector2d a = image.row(triangles(t, 0));
    const Eigen::RowVector2d b = image.row(triangles(t, 1)) - a;
    const Eigen::RowVector2d c = image.row(triangles(t, 2)) - a;
    front[static_cast<std::size_t>(t)] = b[0] * c[1] < b[1] * c[0];
  }
  std::vector<Edge> outline;
  for (const Edge& edge : edges_) {
    const auto [first, second] = edge.triangles;
    if (second < 0 ||
        front[static_cast<std::size_t>(first)] != front[static_cast<std::size_t>(second)]) {
      outline.push_back(edge);
    }
  }
  return outline;
}

Eigen::MatrixXd FaceOutline::rows_of(int vertex) const {
  const Eigen::MatrixXd& identities = model_.identities().displacements;
  const Eigen::MatrixXd& expressions = model_.expressions().displacements;
  Eigen::MatrixXd rows(3, identities.cols() + expressions.cols());
  if (identities.cols() > 0)
    rows.leftCols(identities.cols()) = identities.middleRows<3>(3 * vertex);
  if (expressions.cols() > 0) {
    rows.rightCols(expressions.cols()) = expressions.middleRows<3>(3 * vertex);
  }
  return rows;
}

OutlineRows FaceOutline::rows_of(const std::vector<Match>& matches,
                                 const ImagePoints& landmarks) const {
  const auto m = static_cast<Eigen::Index>(matches.size());
  const Eigen::Index size = model_.identities().size() + model_.expressions().size();
  OutlineRows rows{ImagePoints(m, 2), ImagePoints(m, 2), ModelPoints(m, 3),
                   Eigen::MatrixXd(3 * m, size), Eigen::VectorXd::Ones(m)};
  for (Eigen::Index i = 0; i < m; ++i) {
    const Match& match = matches[static_cast<std::size_t>(i)];
    rows.image.row(i) = landmarks.row(match.landmark);
    rows.normals.row(i) = match.normal;
    rows.mean.row(i) = (1 - match.share) * model_.mean().row(match.from) +
                       match.share * model_.mean().row(match.to);
    rows.basis(Eigen::seqN(i, 3, m), Eigen::all) =
        (1 - match.share) * rows_of(match.from) + match.share * rows_of(match.to);
  }
  return rows;
}

std::shared_ptr<const OutlineRows> FaceOutline::matched(const FittedFrame& frame,
                                                        const Positions& neutral,
                                                        const ImagePoints& landmarks) const {
  Positions face = neutral;
  face.reshaped<Eigen::RowMajor>() += model_.expressions().displacements * frame.beta();
  const ImagePoints image = frame.projected(face);
  const std::vector<Edge> outline = seen_outline(image);
  std::vector<Match> matches;
  for (Eigen::Index i = 0; i < landmarks.rows(); ++i) {
    const Eigen::RowVector2d place = landmarks.row(i);
    if (!place.allFinite()) continue;
    double least = std::numeric_limits<double>::infinity();
    Match best;
    for (const Edge& edge : outline) {
      const Eigen::RowVector2d from = image.row(edge.from), way = image.row(edge.to) - from;
      const double length = way.norm();
      if (!(length > 0)) continue;
      const double share = std::clamp((place - from).dot(way) / (length * length), 0.0, 1.0);
      const double distance = (place - from - share * way).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      best = {i, edge.from, edge.to, share, Eigen::RowVector2d(way[1], -way[0]) / length};
    }
    if (least < std::numeric_limits<double>::infinity()) matches.push_back(best);
  }
  if (matches.empty()) return nullptr;
  return std::make_shared<const OutlineRows>(rows_of(matches, landmarks));
}

std::vector<std::shared_ptr<const OutlineRows>> ClipOutline::matched(
    const std::vector<FittedFrame>& frames) const {
  const Positions neutral = face->neutral(frames.front().alpha());
  std::vector<std::shared_ptr<const OutlineRows>> rows;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    rows.push_back(face->matched(frames[f], neutral, landmarks[f]));
  }
  return rows;
}

}  // namespace mimetra
