#include <algorithm>
#include <cmath>
#include <limits>

#include "toolkit/pipeline/solve.h"
#include "toolkit/transfer/joint_fit.h"

namespace mimetra {

namespace {

/// This many frames show which motion predicts better; the work does not grow with longer clips.
constexpr int kJudgedFrames = 50;
/// Larger patches would leave too little of a face. Smaller patches would be determined by their
/// surroundings.
constexpr int kPatches = 8;

/// Number of the patch of each vertex: the nearest of kPatches centres that are far from each
/// other.
std::vector<int> patches_of(const Positions& rest) {
  std::vector<int> patch(rest.rows(), 0);
  const Eigen::RowVector3d middle = rest.colwise().mean();
  Eigen::VectorXd nearest =
      Eigen::VectorXd::Constant(rest.rows(), std::numeric_limits<double>::infinity());
  Eigen::Index center = 0;
  (rest.rowwise() - middle).rowwise().squaredNorm().maxCoeff(&center);
  for (int p = 0; p < kPatches; ++p) {
    const Eigen::VectorXd distances =
        (rest.rowwise() - rest.row(center).eval()).rowwise().squaredNorm();
    for (Eigen::Index v = 0; v < rest.rows(); ++v) {
      if (distances[v] >= nearest[v]) continue;
      nearest[v] = distances[v];
      patch[v] = p;
    }
    nearest.maxCoeff(&center);
  }
  return patch;
}

/// Some vertices of a sequence, in memory, without triangles.
MeshSequence part_of_vertices(const MeshSequence& sequence,
                              const std::vector<Eigen::Index>& vertices) {
  Connectivity points;
  points.vertices = static_cast<int>(vertices.size());
  Frames frames(sequence.frames(), 3 * vertices.size());
  for (int f = 0; f < sequence.frames(); ++f) {
    const Positions pose = sequence.frame(f)(vertices, Eigen::all);
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return {points, std::move(frames), sequence.known_times(), sequence.rest()(vertices, Eigen::all)};
}

/// Sum over frames and vertices of squared distances to the prediction.
double squared_error(const MeshSequence& sequence, const BlendshapeModel& target,
                     const HeadAndExpressions& found, const std::vector<Eigen::Index>& vertices) {
  const Positions rest = sequence.rest()(vertices, Eigen::all);
  double sum = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    const Eigen::VectorXd field =
        target.expressions().displacements * found.weights.row(f).transpose();
    const PositionsView moved(field.data(), target.vertices(), 3);
    const Positions predicted = found.motion[f].apply(rest + moved(vertices, Eigen::all));
    sum += (predicted - Positions(sequence.frame(f)(vertices, Eigen::all))).squaredNorm();
  }
  return sum;
}

std::vector<int> triangles_outside(const Triangles& triangles, const std::vector<int>& patch,
                                   int held_out) {
  std::vector<int> outside;
  for (int t = 0; t < triangles.rows(); ++t) {
    const auto is_held = [&](VertexIndex vertex) { return patch[vertex] == held_out; };
    if (std::ranges::none_of(triangles.row(t), is_held)) outside.push_back(t);
  }
  return outside;
}

/// Carries a source to the vertices of a target. Vertices without carriers stay at the neutral.
MeshSequence on_target(const MeshSequence& sequence, const BlendshapeModel& target,
                       const Pairing& pairing) {
  const std::vector<VertexIndex> carried = pairing.carried_vertices();
  const auto placed = [&](const PositionsView& pose) {
    Positions result = target.neutral();
    result(carried, Eigen::all) = pairing.carried(pose, carried);
    return result;
  };
  Frames frames(sequence.frames(), 3 * target.vertices());
  for (int f = 0; f < sequence.frames(); ++f) {
    const Positions pose = placed(sequence.frame(f));
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(pose.data(), pose.size());
  }
  return {target.connectivity(), std::move(frames), sequence.known_times(),
          placed(PositionsView(sequence.rest().data(), sequence.vertices(), 3))};
}

/// Errors of both motions as a share of the diameter; empty if there is no patch to hold out.
std::optional<HeldOutErrors> held_out_errors(const std::shared_ptr<const FrameSource>& placed,
                                             const Target& matched, EdgeSum edges,
                                             const Context& context) {
  const BlendshapeModel& target = matched.model;
  const Pairing* pairing = matched.pairing.get();
  const MeshSequence judged = spread_frames(placed, kJudgedFrames, context.part(0, 0));
  const MeshSequence sequence = pairing ? on_target(judged, target, *pairing) : judged;
  const std::vector<int> patch = patches_of(sequence.rest());
  HeldOutErrors sums;
  Eigen::Index points = 0;
  for (int p = 0; p < kPatches; ++p) {
    std::vector<Eigen::Index> held, others;
    for (int v = 0; v < sequence.vertices(); ++v) {
      if (pairing && pairing->carriers(v).empty()) continue;
      (patch[v] == p ? held : others).push_back(v);
    }
    const std::vector<int> triangles =
        with_partners(triangles_outside(target.triangles(), patch, p), pairing);
    if (held.empty() || triangles.empty()) continue;
    const std::vector<RigidTransform> stable =
        rigid_motion(part_of_vertices(sequence, others), {}, context);
    const JointFitOptions joint{.edges = edges};
    JointFitOptions fixed = joint;
    fixed.iterations = 0;
    const auto error = [&](const JointFitOptions& how) {
      const JointFit fit(sequence.rest(), target, triangles, how, context);
      return squared_error(sequence, target, fit(sequence, stable, context), held);
    };
    sums.stable += error(fixed);
    sums.joint += error(joint);
    points += static_cast<Eigen::Index>(held.size());
  }
  if (points == 0) return {};
  const double count = static_cast<double>(points * sequence.frames());
  const double size = sequence.diameter();
  return HeldOutErrors{std::sqrt(sums.stable / count) / size, std::sqrt(sums.joint / count) / size};
}

Similarity inverse(const Similarity& similarity) {
  return {1 / similarity.scale, similarity.rotation.transpose(), similarity.to, similarity.from};
}

JointMotion joint_motion(const Source& source, const Target& target, const SolveOptions& options,
                         const Context& context) {
  const PlacedSource placed = placed_at(target, source, options.axes, context);
  const FrameSource& sequence = *placed.source.sequence;
  const BlendshapeModel& model = target.model;
  const EdgeSum edges = options.edges.value_or(EdgeSum::all);
  const JointFit fit(sequence.rest(), model, all_triangles(model.triangles()),
                     {.edges = edges, .pairing = target.pairing}, context);
  JointMotion joint{fit(sequence, placed.source.motion, context).motion,
                    held_out_errors(placed.source.sequence, target, edges, context)};
  const Similarity back = inverse(placed.similarity);
  for (RigidTransform& motion : joint.motion) motion = back.carry(motion);
  return joint;
}

}  // namespace

JointSearch joint_search(const std::vector<Target>& targets, const SolveOptions& options) {
  const auto found = std::ranges::find_if_not(targets, [&options](const Target& target) {
    return solves_for_vertices(target.model, options.space);
  });
  if (found == targets.end()) return {};
  return [target = *found, options](const Source& source, const Context& context) {
    return joint_motion(source, target, options, context.quiet().without_ranks());
  };
}

}  // namespace mimetra
