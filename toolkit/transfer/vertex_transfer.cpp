#include "toolkit/transfer/vertex_transfer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "geodesic/sparse_factor.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/deformation_gradients.h"
#include "toolkit/transfer/following_parts.h"
#include "toolkit/transfer/gradient_system.h"
#include "toolkit/transfer/seams.h"
#include "toolkit/transfer/soft_border.h"
#include "toolkit/transfer/vertex_pull.h"

namespace mimetra {

namespace {

/// Number of frames whose x, y and z are one block of right-hand sides.
constexpr int kLanes = VertexPull::kLanes;
using Rows = VertexPull::Rows;
using Row = Eigen::RowVector<double, VertexPull::kWidth>;

double area(const Positions& rest, const Triangles& triangles, int triangle) {
  const Eigen::Matrix3d frame = triangle_frame(rest, triangles, triangle);
  return frame.col(0).cross(frame.col(1)).norm() / 2;
}

void check_options(const VertexTransferOptions& options, Eigen::Index vertices) {
  check_options(options);
  if (!options.inside.empty() && options.inside.size() != static_cast<std::size_t>(vertices)) {
    throw std::invalid_argument("inside: expected one entry for each of " +
                                std::to_string(vertices) + " vertices, found " +
                                std::to_string(options.inside.size()));
  }
  if (options.weights.size() > 0) {
    check_weights(options.weights, vertices);
    if (options.outside == Outside::identity) {
      throw std::invalid_argument(
          "outside: triangles that keep their shape hold no vertex, and with weights those of "
          "weight 0 stay; take Outside::fixed");
    }
  }
  if (options.anchor == Anchor::vertex &&
      (options.anchor_vertex < 0 || options.anchor_vertex >= vertices)) {
    throw std::invalid_argument("anchor vertex " + std::to_string(options.anchor_vertex) +
                                ": expected 0 to " + std::to_string(vertices - 1));
  }
}

void check(const Positions& source_rest, const Positions& target_rest, const Triangles& triangles,
           const VertexTransferOptions& options) {
  check_sizes(source_rest, target_rest, options.pairing.get());
  if (triangles.size() > 0 &&
      (triangles.minCoeff() < 0 || triangles.maxCoeff() >= target_rest.rows())) {
    throw std::invalid_argument("a triangle uses a vertex outside 0 to " +
                                std::to_string(target_rest.rows() - 1));
  }
  check_options(options, target_rest.rows());
  if (options.weld.representative.empty()) return;
  // A mesh's box is at least as long across as the mesh. Two vertices may be welded through a
  // third, hence the factor 2.
  constexpr double kApart = 2 * kPartedShare;
  if (!options.pairing) options.weld.check(source_rest, kApart * box_diagonal(source_rest));
  options.weld.check(target_rest, kApart * box_diagonal(target_rest));
}

/// Options with an entry of the weld for each vertex. The anchor becomes the lowest of its welded
/// vertices, and the weights define the vertices inside.
VertexTransferOptions completed(VertexTransferOptions options, Eigen::Index vertices) {
  std::vector<VertexIndex>& one = options.weld.representative;
  if (one.empty()) options.weld = Weld::none(static_cast<int>(vertices));
  if (options.anchor == Anchor::vertex) options.anchor_vertex = one[options.anchor_vertex];
  if (options.weights.size() > 0) {
    options.inside.resize(one.size());
    for (VertexIndex v = 0; v < vertices; ++v) options.inside[v] = options.weights[v] > 0;
    // Weights of only 0 and 1 are a hard border: one row of triangles has no room for a soft one.
    if ((options.weights.array() == 0 || options.weights.array() == 1).all()) options.weights = {};
  }
  return options;
}

/// Source triangles on welded vertices, so that neighbours are found across seams. The target's
/// weld is carried over to the source as far as the pairing allows.
Triangles welded_source(const Triangles& welded_target, const Weld& weld, const Pairing* pairing) {
  if (!pairing) return welded_target;
  if (!pairing->is_one_to_one()) return pairing->source_triangles();
  Weld of_source = Weld::none(pairing->source_vertices());
  for (VertexIndex v = 0; v < pairing->target_vertices(); ++v) {
    const auto here = pairing->carriers(v), one = pairing->carriers(weld.representative[v]);
    if (here.empty() || one.empty()) continue;
    of_source.representative[here.front().vertex] = one.front().vertex;
  }
  return of_source.welded(pairing->source_triangles());
}

std::vector<bool> mask_of(const std::vector<int>& selected, Eigen::Index triangles) {
  std::vector<bool> in_l(triangles, false);
  for (const int triangle : selected) in_l[triangle] = true;
  return in_l;
}

}  // namespace

/// Minimising over the fourth vertex leaves the part of ||T_i - Q_i||_F^2 in the plane of the
/// target's triangle. It is || sum_v p_v g_iv^T - Q_i P_i ||^2 with the gradients g_iv of the hat
/// functions and the projection P_i onto the plane. In displacements d = p - p_rest the normal
/// equations are
///   sum_w (sum_i w_i g_iv . g_iw) d_w = sum_i w_i (Q_i - I) g_iv,
/// one N x N matrix for x, y and z. With Q_i - I = (U~_i - U_i) U_i^-1, a frame needs only the
/// constant vectors U_i^-1 g_iv. Only differences occur, so the place of the mesh does not matter.
///
/// Welded vertices share d: their rows and columns add up. Vertices that rounding or noise holds
/// apart at rest stay apart.
struct VertexTransfer::State {
  State(const Positions& source, const Positions& target, const Triangles& triangles,
        const std::vector<int>& selected, const VertexTransferOptions& options,
        const Context& context);

  std::vector<int> uncollapsed(std::vector<int> selected) const;
  void weigh();
  double wanted_weight(int triangle) const;
  void fix();
  Triplets stiffness() const;
  double smoothness_across(int triangle, int neighbor) const;
  std::vector<SmoothEdge> smooth_edges() const;
  void factor();
  void prepare_pull(const DeformationGradients& gradients);
  Row shift_of(const std::vector<VertexIndex>& piece, const Eigen::Ref<const Frames>& frames,
               const Rows& displacement) const;
  void undrift(const Eigen::Ref<const Frames>& frames, Rows& displacement) const;
  Row motion_of(const std::vector<Pairing::Carrier>& carriers,
                const Eigen::Ref<const Frames>& frames) const;
  Frames solve(const Eigen::Map<const Frames>& frames) const;
  void solve_all(const FrameSource& performance, const Context::TakeBlock& take,
                 const Context& context) const;
  std::array<int, 3> unknowns_of(int triangle) const;
  bool collapses(int triangle) const;

  Positions source_rest, target_rest;
  VertexTransferOptions options;
  const Pairing* pairing;  // from the options, or null
  Triangles triangles,
      welded;  // target's triangles: as given, and on the lowest of welded vertices
  std::shared_ptr<const FollowingParts> following;  // null without a pairing
  std::optional<SoftBorder> border;
  std::vector<SmoothEdge> edges;
  std::vector<bool> in_l;       // per triangle
  std::vector<double> weights;  // per triangle; 0 if it takes no part
  std::vector<bool> fixed;      // per vertex
  VertexUnknowns unknowns;      // in the order of elimination
  geodesic::SparseFactor solver;
  std::optional<VertexPull> pull;
  int collapsed = 0;
  int degenerate_source = 0;
  int degenerate_target = 0;
};

VertexTransfer::State::State(const Positions& source, const Positions& target,
                             const Triangles& faces, const std::vector<int>& selected,
                             const VertexTransferOptions& given, const Context& context)
    : source_rest(source),
      target_rest(target),
      options(completed(given, target.rows())),
      pairing(options.pairing.get()),
      triangles(faces),
      welded(options.weld.welded(faces)) {
  following = options.following;
  if (pairing && !following) {
    following = std::make_shared<FollowingParts>(target_rest, triangles, options.weld, *pairing);
  }
  if (options.weights.size() > 0) border.emplace(target_rest, triangles, options.weights);
  const std::vector<int> solved = uncollapsed(selected);
  // Neighbours are found across seams.
  const Triangles joined = welded_source(welded, options.weld, pairing);
  const DeformationGradients gradients =
      gradients_between(source_rest, triangles, pairing, solved, &joined);
  in_l = mask_of(selected, triangles.rows());
  degenerate_source = gradients.replaced();
  weigh();
  fix();
  unknowns = number_unknowns(triangles, weights, fixed, options.weld);
  if (options.anchor && !unknowns.held.empty()) {
    throw std::invalid_argument(
        "an anchor was given, but fixed vertices hold the mesh in place already; let the vertices "
        "outside the regions move (Outside::identity) or select all triangles");
  }
  context.report(0.3);
  factor();
  context.report(0.8);
  prepare_pull(gradients);
  context.report(1);
}

/// Triangles of L that take part. Throws std::invalid_argument if a row is out of range.
std::vector<int> VertexTransfer::State::uncollapsed(std::vector<int> selected) const {
  for (const int t : selected) {
    if (t >= 0 && t < triangles.rows()) continue;
    throw std::invalid_argument("triangle " + std::to_string(t) + " is selected, expected 0 to " +
                                std::to_string(triangles.rows() - 1));
  }
  std::erase_if(selected, [this](int t) { return collapses(t); });
  return selected;
}

/// Weight of a triangle before its shape is considered.
double VertexTransfer::State::wanted_weight(int triangle) const {
  if (following && following->without_motion()[triangles(triangle, 0)]) return 0;
  if (!in_l[triangle]) return options.outside == Outside::identity ? options.outside_weight : 0;
  const bool is_shown = !pairing || pairing->triangles().has_partner(triangle);
  const double weight = is_shown ? 1 : options.outside_weight;
  if (!border) return weight;
  return border->share(triangle) > 0 ? weight * border->stiffness(triangle) : 0;
}

void VertexTransfer::State::weigh() {
  weights.assign(triangles.rows(), 0);
  for (int t = 0; t < triangles.rows(); ++t) {
    weights[t] = wanted_weight(t);
    if (weights[t] == 0) continue;
    if (collapses(t)) {
      weights[t] = 0;
      ++collapsed;
      continue;
    }
    const double share = target_share(quality_of(target_rest, triangles, t));
    if (share < 0.5) ++degenerate_target;
    weights[t] *= share;
    if (options.triangle_weight == TriangleWeight::area) {
      weights[t] *= area(target_rest, triangles, t);
    }
  }
}

/// Fixes vertices outside, and vertices that no triangle determines.
///
/// If one of some welded vertices is outside, all are fixed. Otherwise the seam would tear at the
/// regions' border. If a triangle determines one of them, all move, since the other side of a seam
/// may have no triangle with area in L. A single vertex of a mesh without duplicates behaves the
/// same.
void VertexTransfer::State::fix() {
  const std::vector<VertexIndex>& one = options.weld.representative;
  std::vector<bool> movable(target_rest.rows(), true), determined(target_rest.rows(), false);
  if (options.outside == Outside::fixed && !options.inside.empty()) {
    for (std::size_t v = 0; v < one.size(); ++v) {
      if (!options.inside[v]) movable[one[v]] = false;
    }
  } else if (options.outside == Outside::fixed) {
    for (int t = 0; t < triangles.rows(); ++t) {
      if (in_l[t] || collapses(t)) continue;
      for (const VertexIndex vertex : welded.row(t)) movable[vertex] = false;
    }
  }
  for (int t = 0; t < triangles.rows(); ++t) {
    if (weights[t] == 0) continue;
    for (const VertexIndex vertex : welded.row(t)) determined[vertex] = true;
  }
  fixed.resize(one.size());
  for (std::size_t v = 0; v < one.size(); ++v) fixed[v] = !movable[one[v]] || !determined[one[v]];
}

/// Returns true if two vertices of a triangle are welded.
bool VertexTransfer::State::collapses(int triangle) const {
  for (const int a : {0, 1, 2}) {
    const int b = (a + 1) % 3;
    if (triangles(triangle, a) != triangles(triangle, b) &&
        welded(triangle, a) == welded(triangle, b)) {
      return true;
    }
  }
  return false;
}

std::array<int, 3> VertexTransfer::State::unknowns_of(int triangle) const {
  const auto corners = triangles.row(triangle);
  return {unknowns.of_vertex[corners[0]], unknowns.of_vertex[corners[1]],
          unknowns.of_vertex[corners[2]]};
}

Triplets VertexTransfer::State::stiffness() const {
  Triplets entries;
  for (int t = 0; t < triangles.rows(); ++t) {
    if (weights[t] == 0) continue;
    add_products<3>(hat_gradients(target_rest, triangles, t), weights[t], unknowns_of(t), entries);
  }
  return entries;
}

/// Weight of the difference between two neighbours' displacement gradients. It is positive across
/// edges with a triangle outside L, or in a soft border.
double VertexTransfer::State::smoothness_across(int triangle, int neighbor) const {
  if (border) {
    // A triangle that stays is flat, and its neighbours should begin flat.
    const auto takes_part = [this](int t) { return weights[t] > 0 || border->share(t) == 0; };
    if (!takes_part(triangle) || !takes_part(neighbor)) return 0;
    if (weights[triangle] == 0 && weights[neighbor] == 0) return 0;
    return border->smoothness(triangle, neighbor);
  }
  if ((in_l[triangle] && in_l[neighbor]) || weights[triangle] == 0 || weights[neighbor] == 0) {
    return 0;
  }
  return options.outside_smoothness;
}

std::vector<SmoothEdge> VertexTransfer::State::smooth_edges() const {
  std::vector<SmoothEdge> found;
  const bool is_smooth = options.outside == Outside::identity && options.outside_smoothness > 0;
  if (!is_smooth && !border) return found;
  const bool by_area = options.triangle_weight == TriangleWeight::area;
  const auto neighbors = triangle_neighbors(static_cast<int>(target_rest.rows()), welded);
  for (int t = 0; t < triangles.rows(); ++t) {
    for (const int other : neighbors[t]) {
      const double smoothness = other < t ? 0 : smoothness_across(t, other);
      if (smoothness == 0) continue;
      const double scale =
          by_area ? (area(target_rest, triangles, t) + area(target_rest, triangles, other)) / 2 : 1;
      found.push_back({t, other, smoothness * scale});
    }
  }
  return found;
}

void VertexTransfer::State::factor() {
  Triplets entries = stiffness();
  edges = smooth_edges();
  for (const SmoothEdge& edge : edges) {
    add_smoothness(target_rest, triangles, edge, unknowns.of_vertex, entries);
  }
  solver = factor_of(entries, unknowns.count);
  for (int& unknown : unknowns.of_vertex) {
    if (unknown >= 0) unknown = solver.order()[unknown];
  }
}

void VertexTransfer::State::prepare_pull(const DeformationGradients& gradients) {
  std::vector<Edges> vectors(gradients.selected().size(), Edges::Zero());
  for (std::size_t s = 0; s < vectors.size(); ++s) {
    const int triangle = gradients.selected()[s];
    if (weights[triangle] == 0) continue;
    const double wanted = border ? weights[triangle] * border->share(triangle) : weights[triangle];
    vectors[s] = wanted * hat_gradients(target_rest, triangles, triangle).rightCols<2>();
  }
  std::vector<VertexPull::Crossing> crossings;
  if (border) {
    PullOverBorder over = pull_over_border(target_rest, triangles, *border, edges, gradients);
    for (std::size_t s = 0; s < vectors.size(); ++s) vectors[s] += over.own[s];
    crossings = std::move(over.crossings);
  }
  pull.emplace(source_rest, pairing ? pairing->source_triangles() : triangles, triangles, gradients,
               vectors, unknowns.of_vertex, crossings);
}

/// Mean translation from the vertices of a piece to the place that the anchor demands. Vertices
/// that take a share of the motion also take this share of the source's motion.
Row VertexTransfer::State::shift_of(const std::vector<VertexIndex>& piece,
                                    const Eigen::Ref<const Frames>& frames,
                                    const Rows& displacement) const {
  Row shift = Row::Zero();
  const Anchor anchor = options.anchor.value_or(Anchor::source_motion);
  if (anchor == Anchor::vertex) {
    const bool holds_it = std::ranges::binary_search(piece, options.anchor_vertex);
    const int row = unknowns.of_vertex[options.anchor_vertex];
    if (holds_it && row >= 0) shift = -displacement.row(row);
    return shift;
  }
  std::vector<Pairing::Carrier> carriers;
  std::size_t carried = 0;
  for (const VertexIndex v : piece) {
    const double share = border ? options.weights[v] : 1;
    if (anchor == Anchor::source_motion && pairing) {
      const auto more = pairing->carriers(v);
      for (const auto& [carrier, weight] : more) carriers.push_back({carrier, share * weight});
      if (more.empty()) continue;
    } else if (anchor == Anchor::source_motion) {
      carriers.push_back({v, share});
    }
    ++carried;
    if (unknowns.of_vertex[v] >= 0) shift -= displacement.row(unknowns.of_vertex[v]);
  }
  if (anchor == Anchor::source_motion) shift += motion_of(carriers, frames);
  return carried > 0 ? Row(shift / static_cast<double>(carried)) : Row(Row::Zero());
}

/// Compensates for fixed vertices around a soft border, which would hold the inside back. Each
/// piece moves on, as far as the border can bear, towards its share of the source's mean motion.
void VertexTransfer::State::undrift(const Eigen::Ref<const Frames>& frames,
                                    Rows& displacement) const {
  for (const std::vector<VertexIndex>& piece : unknowns.held) {
    double share = 0, carried = 0;
    for (const VertexIndex v : piece) {
      if (pairing && pairing->carriers(v).empty()) continue;
      share += options.weights[v];
      ++carried;
    }
    if (carried == 0) continue;
    Row shift = shift_of(piece, frames, displacement) * (carried / share);
    for (int lane = 0; lane < kLanes; ++lane) {
      auto of_frame = shift(Eigen::seqN(lane, Eigen::fix<3>, Eigen::fix<kLanes>));
      of_frame = border->bearable(of_frame);
    }
    for (const VertexIndex v : piece) {
      displacement.row(unknowns.of_vertex[v]) += options.weights[v] * shift;
    }
  }
}

/// Sum of the source's displacements at the carriers, times their weights.
Row VertexTransfer::State::motion_of(const std::vector<Pairing::Carrier>& carriers,
                                     const Eigen::Ref<const Frames>& frames) const {
  Row motion = Row::Zero();
  for (Eigen::Index lane = 0; lane < frames.rows(); ++lane) {
    const PositionsView frame(frames.row(lane).data(), source_rest.rows(), 3);
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const auto& [v, weight] : carriers) sum += weight * (frame.row(v) - source_rest.row(v));
    for (int c = 0; c < 3; ++c) motion[c * kLanes + lane] = sum[c];
  }
  return motion;
}

/// Target poses of up to kLanes frames.
Frames VertexTransfer::State::solve(const Eigen::Map<const Frames>& frames) const {
  Rows displacement = solver.solve<VertexPull::kWidth>((*pull)(frames));
  Frames poses = target_rest.reshaped<Eigen::RowMajor>().transpose().replicate(frames.rows(), 1);
  const auto move = [&poses](VertexIndex vertex, const auto& by) {
    for (Eigen::Index lane = 0; lane < poses.rows(); ++lane) {
      for (int c = 0; c < 3; ++c) poses(lane, 3 * vertex + c) += by[c * kLanes + lane];
    }
  };
  for (const FloatingPiece& piece : unknowns.floating) {
    const Row shift = shift_of(piece.vertices, frames, displacement);
    for (const VertexIndex v : piece.pin) move(v, shift);
    for (const VertexIndex v : piece.vertices) {
      if (unknowns.of_vertex[v] >= 0) displacement.row(unknowns.of_vertex[v]) += shift;
    }
  }
  if (border) undrift(frames, displacement);
  for (VertexIndex v = 0; v < target_rest.rows(); ++v) {
    if (unknowns.of_vertex[v] >= 0) move(v, displacement.row(unknowns.of_vertex[v]));
  }
  if (following) {
    for (Eigen::Index lane = 0; lane < poses.rows(); ++lane) {
      following->place(Eigen::Map<Positions>(poses.row(lane).data(), target_rest.rows(), 3));
    }
  }
  return poses;
}

VertexTransfer::VertexTransfer(const Positions& source_rest, const Positions& target_rest,
                               const Triangles& triangles, const std::vector<int>& selected,
                               const VertexTransferOptions& options, const Context& context) {
  check(source_rest, target_rest, triangles, options);
  state_ = std::make_unique<State>(source_rest, target_rest, triangles, selected, options, context);
}

VertexTransfer::~VertexTransfer() = default;
VertexTransfer::VertexTransfer(VertexTransfer&&) noexcept = default;
VertexTransfer& VertexTransfer::operator=(VertexTransfer&&) noexcept = default;

/// Calls `take` with the poses of every kLanes frames, as Context::for_each_block() does.
void VertexTransfer::State::solve_all(const FrameSource& performance,
                                      const Context::TakeBlock& take,
                                      const Context& context) const {
  if (performance.vertices() != source_rest.rows()) {
    throw MismatchError("the performance has " + std::to_string(performance.vertices()) +
                        " vertices, the source " + std::to_string(source_rest.rows()));
  }
  context.for_each_block(
      performance.frames(), kLanes, 3 * target_rest.rows(),
      [&](int first, int count) { return solve(FrameBlock(performance, first, count).poses()); },
      take);
}

Frames VertexTransfer::frames(const FrameSource& performance, const Context& context) const {
  Frames result(performance.frames(), 3 * state_->target_rest.rows());
  const auto take = [&result](int first, const Frames& poses) {
    result.middleRows(first, poses.rows()) = poses;
  };
  state_->solve_all(performance, take, context);
  return result;
}

void VertexTransfer::write_frames(const FrameSource& performance, FrameSink& sink,
                                  const Context& context) const {
  const auto take = [&sink](int first, const Frames& poses) { sink.write(first, poses); };
  state_->solve_all(performance, take, context);
}

int VertexTransfer::collapsed_triangles() const {
  return state_->collapsed;
}
int VertexTransfer::degenerate_source_triangles() const {
  return state_->degenerate_source;
}
int VertexTransfer::degenerate_target_triangles() const {
  return state_->degenerate_target;
}
const std::vector<bool>& VertexTransfer::fixed() const {
  return state_->fixed;
}

}  // namespace mimetra
