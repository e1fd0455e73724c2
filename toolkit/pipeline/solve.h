#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/similarity.h"
#include "toolkit/model/animation.h"
#include "toolkit/pipeline/analysis.h"
#include "toolkit/pipeline/target.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/blendshape_transfer.h"
#include "toolkit/transfer/following_parts.h"
#include "toolkit/transfer/local_weights.h"
#include "toolkit/transfer/vertex_transfer.h"

namespace mimetra {

/// Unknowns of a solve.
enum class Space {
  automatic,  ///< weights if the target has expressions, otherwise vertices
  blendshape,
  vertex
};

constexpr std::string_view choice_name(Space value) {
  switch (value) {
    case Space::automatic:
      return "auto";
    case Space::blendshape:
      return "blendshape";
    case Space::vertex:
      return "vertex";
  }
  return {};
}

/// How the source's rest pose is turned towards the target's, which may use other axes.
enum class Axes {
  fit,  ///< by the similarity that fits best
  none  ///< not at all, as in the paper's deformation gradients
};

constexpr std::string_view choice_name(Axes value) {
  switch (value) {
    case Axes::fit:
      return "fit";
    case Axes::none:
      return "none";
  }
  return {};
}

struct SolveOptions {
  Space space = Space::automatic;
  Axes axes = Axes::fit;
  /// Edges in the sum of eq. 10 and 12. Default: all edges; in a transfer, the edges of the
  /// analysis' compatibility.
  std::optional<EdgeSum> edges = {};
  /// Time constant in seconds. A penalty on the second derivative smooths the weights or, in vertex
  /// space, the positions (smooth_weights(), MotionFilter).
  double smoothness = 0;
  /// Options of the blendshape space, as in BlendshapeTransferOptions.
  double ridge = 0;
  double sparsity = 0;
  double symmetry = 0;
  Exclusive exclusive = Exclusive::none;
  /// Options of the vertex space, as in VertexTransferOptions.
  TriangleWeight triangle_weight = TriangleWeight::unit;
  Outside outside = Outside::fixed;
  double outside_weight = VertexTransferOptions().outside_weight;
  double outside_smoothness = 0;
  std::optional<Anchor> anchor = {};
  VertexIndex anchor_vertex = -1;
  /// Blendshape space: solves for separate weights of each region and of the surface around them.
  /// All triangles are used.
  bool per_region = false;
  /// Geodesic distance from a region's rim over which the region fades out, on the target. With
  /// per_region, the weights of each region fade (default kUsualFalloff). Otherwise the vertices'
  /// share of the motion fades (bordered_selection()).
  ///
  /// Without a falloff the border is hard, and a target without expressions tears there.
  /// kBareFalloff is wide enough for such targets.
  std::optional<Length> falloff = {};
  /// Pull of each region's weights towards the weights of the whole face:
  /// LocalWeightsOptions::ridge.
  double region_ridge = LocalWeightsOptions().ridge;
  /// Distances that measure the falloff. Default: heat distances; in a transfer, the distances of
  /// the analysis.
  std::optional<DistanceOptions> distances = {};

  static constexpr Length kUsualFalloff = Length::share(0.1);
  static constexpr Length kBareFalloff = Length::share(0.2);

  static constexpr Option kSpace{"space", &SolveOptions::space};
  static constexpr Option kAxes{"axes", &SolveOptions::axes};
  static constexpr Option kSmoothness{
      "smoothness", &SolveOptions::smoothness, {.minimum = 0, .maximum = 60}, "s"};
  static constexpr Option kPerRegion{"per_region", &SolveOptions::per_region};
  static constexpr Option kFalloff{"falloff", &SolveOptions::falloff, {.minimum = 1e-9}};
  static constexpr Option kRidge{"ridge", &SolveOptions::ridge,
                                 BlendshapeTransferOptions::kRidge.range};
  static constexpr Option kSparsity{"sparsity", &SolveOptions::sparsity,
                                    BlendshapeTransferOptions::kSparsity.range};
  static constexpr Option kSymmetry{"symmetry", &SolveOptions::symmetry,
                                    BlendshapeTransferOptions::kSymmetry.range};
  static constexpr Option kExclusive{"exclusive", &SolveOptions::exclusive};
  static constexpr Option kTriangleWeight{"triangle_weight", &SolveOptions::triangle_weight};
  static constexpr Option kOutside{"outside", &SolveOptions::outside};
  static constexpr Option kOutsideWeight{"outside_weight", &SolveOptions::outside_weight,
                                         VertexTransferOptions::kOutsideWeight.range};
  static constexpr Option kOutsideSmoothness{"outside_smoothness",
                                             &SolveOptions::outside_smoothness,
                                             VertexTransferOptions::kOutsideSmoothness.range};
  static constexpr Option kEdges{"edges", &SolveOptions::edges};
  static constexpr Option kAnchor{"anchor", &SolveOptions::anchor};
  static constexpr Option kAnchorVertex{"anchor_vertex", &SolveOptions::anchor_vertex,
                                        VertexTransferOptions::kAnchorVertex.range};
  static constexpr Option kRegionRidge{"region_ridge", &SolveOptions::region_ridge,
                                       LocalWeightsOptions::kRidge.range};
  static constexpr auto declared() {
    return std::tuple(kSpace, kAxes, kEdges, kSmoothness, kRidge, kSparsity, kSymmetry, kExclusive,
                      kTriangleWeight, kOutside, kOutsideWeight, kOutsideSmoothness, kAnchor,
                      kAnchorVertex, kPerRegion, kFalloff, kRegionRidge);
  }
};

/// Returns the edges that eq. 10 and 12 sum over.
EdgeSum edge_sum(Compatibility compatibility);

/// Returns the options with edges and distances of the analysis, unless they are set.
SolveOptions with_analysis(SolveOptions options, const AnalysisOptions& analysis);

/// True for the vertex space, and if a target has no expressions.
bool solves_for_vertices(const BlendshapeModel& target, Space space);

/// Checks the rules of a solve for weights. Throws OptionError if the target has no pair for a
/// symmetry (Topic::no_pairs), or no group of exclusive expressions (Topic::no_exclusives). Throws
/// what ExpressionRules() throws. With per_region, throws std::invalid_argument for a target that
/// is solved for vertices, for smoothness, and for rules of expressions.
void check_rules(const Target& target, const SolveOptions& options);

/// Throws OptionError (Topic::soft_outside) for Outside::identity in vertex space. Such triangles
/// cannot hold the end of a soft border. \pre the regions' border is soft
void check_soft_border(const Target& target, const SolveOptions& options);

/// Returns a search for prepare_source(), or an empty one if no target is solved for weights. The
/// search finds the head's motion together with the expressions of the first such target. It
/// compares that motion with the stable motion on vertices that were held out. It may refer to the
/// target's model.
///
/// Eight patches of the mesh are held out, one after the other. Both fits use the rest of the mesh
/// in at most fifty frames. They predict the patch with the motion and the expressions that they
/// find.
///
/// The search throws OptionError (Topic::undetermined_axes) as placed_at(), what reading throws,
/// Cancelled.
JointSearch joint_search(const std::vector<Target>& targets, const SolveOptions& options = {});

/// A source that was carried to a target's place.
struct PlacedSource {
  /// The source with carried frames, rest pose and head motion. `given` and `moving` are unchanged.
  Source source;
  /// From the source's rest pose to the target's.
  Similarity similarity;
};

/// Carries the source to the target's unit, place and axes, by the similarity from its rest pose to
/// the target's neutral. The fit uses the vertices of triangles or, if faces differ, target
/// vertices and their carriers. If both shapes are equal, the result is the source itself, bit by
/// bit.
///
/// Axes::none does not turn the source. Notes a mirrored target under its name. Throws OptionError
/// (Topic::undetermined_axes) if the rest poses leave the rotation open. \pre the target is a
/// MatchedTarget
PlacedSource placed_at(const Target& target, const Source& source, Axes axes = Axes::fit,
                       const Context& context = {});

/// Triangles and vertices that a transfer uses.
struct Selection {
  std::vector<int> triangles;  ///< L
  std::vector<bool> inside;    ///< vertices inside the regions (N); empty for all
  /// Vertices of each region, in the regions' order; empty for all triangles.
  std::vector<std::vector<VertexIndex>> regions = {};
  /// Share of the wanted motion that each vertex takes (N), in [0, 1]. Empty for a hard border.
  /// Vertices inside have weights above 0, and L contains every triangle with a vertex inside.
  Eigen::VectorXd weights = {};
};

Selection selection_of(const Regions& regions);
/// All triangles.
Selection whole(const FrameSource& sequence);

/// Selects the target's triangles for a transfer by regions of the source. If faces differ, these
/// are the triangles over the source's (triangles_over()) and in gaps between them. \pre the target
/// is a MatchedTarget
Selection selection_of(const Regions& regions, const Target& target);
/// All triangles of the target.
Selection whole(const Target& target);

/// Vertices of the target over each region of the source.
std::vector<std::vector<VertexIndex>> regions_over(const Pairing& pairing, const Regions& regions);

/// A connected part of a target without a partner in the source, which followed the surface around
/// it.
struct FollowingPart {
  int component;  ///< rank in surface_parts()
  int vertices;
  double farthest;  ///< largest distance of a vertex from rest in any frame, in the target's unit
};

/// Returns the parts that follow and their largest moves, sorted by component.
std::vector<FollowingPart> described(const FollowingParts& parts,
                                     const std::vector<double>& farthest,
                                     const BlendshapeModel& model);

/// Notes of a solve about a target, each starting with the target's name.
class TargetNotes {
 public:
  TargetNotes(const std::string& name, const Context& context)
      : start_(name + ": "), context_(context) {}

  void add(const std::string& text, Topic topic = Topic::other) const;
  /// Notes expressions that are not seen, or hardly.
  void add(const BlendshapeConditions& conditions) const;
  void add(const std::vector<FollowingPart>& parts) const;
  /// Notes seams that rounding opened; nothing holds them together.
  void add_almost_welded(const BlendshapeModel& model) const;
  /// Notes vertices without triangles, if the mesh has triangles.
  void add_unmoved(const Connectivity& connectivity) const;

  /// Numbers of triangles that are slivers, or that a seam collapses.
  struct Degenerate {
    int source = 0, target = 0, collapsed = 0;
  };
  void add_degenerate(const Degenerate& triangles) const;

 private:
  std::string start_;
  const Context& context_;
};

/// Poses of a target that follow a source.
struct Solution {
  /// Poses of the target without head motion; the rest pose is the neutral. Frames are computed
  /// when they are read, or stored. The sequence does not need the source or the target.
  std::shared_ptr<const FrameSource> sequence;
  /// The sequence if weights drive it; null in vertex space and for weights of each region. Its
  /// model is faded() if the selection has weights.
  std::shared_ptr<const Animation> animation;
  /// The sequence if each region has its own weights, else null.
  std::shared_ptr<const RegionalAnimation> regional;
  /// Violation of the regions' weights, as in LocalWeights.
  double violation = 0;
  BlendshapeConditions conditions;
  /// Triangles between welded vertices, in vertex space. They are ignored, and do not count as
  /// degenerate.
  int collapsed_triangles = 0;
  /// In vertex space, sorted by component.
  std::vector<FollowingPart> following_parts = {};
  int degenerate_source_triangles = 0;
  int degenerate_target_triangles = 0;
  double seconds = 0;  ///< set-up and the solve of all frames

  /// Weights beta, F x D. With weights of R regions F x R D, as in RegionalAnimation; the last
  /// region is the surface around the others. Empty in vertex space.
  const Eigen::MatrixXd& weights() const;
  /// Names of the columns of weights(): the expressions' names. With weights of each region NAME@0,
  /// NAME@1, ... in the order of the selection, then NAME@background.
  std::vector<std::string> weight_names() const;
};

/// Returns closed_seams() of a source and a target. \pre as for solve()
Weld closed_seams_of(const Source& source, const Target& target, const Context& context = {});

/// Solves on the selected triangles in blendshape or vertex space. In vertex space closed_seams()
/// stay closed.
///
/// Notes, under the target's name:
/// - expressions that the triangles show hardly or not at all; Topic::poor_condition if the
///   triangles cannot distinguish them
/// - triangles without area, and triangles that a seam collapses
/// - parts that follow the surface around them
/// - a source with unknown neutral and a rest pose that does not look neutral
///   (Topic::unneutral_rest)
///
/// With options.per_region, all triangles determine the weights of each region. They are pulled
/// towards the weights of the whole face, which ridge and sparsity shape. A selection without
/// regions gets the weights of the whole face.
///
/// If the selection has weights, vertices take that share of the motion. In vertex space it fades
/// as SoftBorder describes. In blendshape space triangle i is weighted by phi_i, the mean of its
/// corners' weights. The result is neutral + phi_v sum_j beta_j dV_j, the motion of faded()
/// expressions. It differs from the model's pose at these weights.
///
/// Throws OptionError (Topic::no_expressions, Topic::anchor_vertex, Topic::held_anchor,
/// Topic::anchor_and_weights, Topic::soft_outside). Throws what check_rules(), BlendshapeTransfer,
/// LocalWeights, closed_seams(), VertexTransfer, reading the source and FrameStore throw. Throws
/// std::invalid_argument for options.per_region with a selection that has weights, and unless the
/// weights are N numbers in [0, 1].
///
/// \pre the target is a MatchedTarget, the source is placed_at() it
Solution solve(const Source& source, const Target& target, const Selection& selection,
               const SolveOptions& options = {}, const Context& context = {});

}  // namespace mimetra
