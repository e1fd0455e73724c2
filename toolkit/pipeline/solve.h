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

/// The unknowns.
enum class Space {
  automatic,  ///< weights where the target has expressions, otherwise vertices
  blendshape,
  vertex
};

/// As people choose it.
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

/// How the source's rest pose is turned to the target's, whose axes may be others.
enum class Axes {
  fit,  ///< by the similarity that fits best
  none  ///< not at all; the paper's deformation gradients
};

/// As people choose it.
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
  /// The sum of eq. 10 and 12: all edges by default; in a transfer, the edges that the analysis'
  /// compatibility names.
  std::optional<EdgeSum> edges = {};
  /// Time constant in seconds: weights, or in vertex space positions, are drawn to a small second
  /// derivative (smooth_weights(), MotionFilter).
  double smoothness = 0;
  /// Blendshape space, as in BlendshapeTransferOptions.
  double ridge = 0;
  double sparsity = 0;
  double symmetry = 0;
  Exclusive exclusive = Exclusive::none;
  /// Vertex space, as in VertexTransferOptions.
  TriangleWeight triangle_weight = TriangleWeight::unit;
  Outside outside = Outside::fixed;
  double outside_weight = VertexTransferOptions().outside_weight;
  double outside_smoothness = 0;
  std::optional<Anchor> anchor = {};
  VertexIndex anchor_vertex = -1;
  /// Blendshape space: each region has weights of its own, and what lies around them too; all
  /// triangles are looked at.
  bool per_region = false;
  /// Geodesic distance from a region's rim over which it fades out, on the target: the weights of
  /// each region (there kUsualFalloff where none is given), otherwise the motion that vertices
  /// take (bordered_selection()); without it a region's border is hard, and tears meshes without
  /// expressions from what lies outside: kBareFalloff is wide enough for them.
  std::optional<Length> falloff = {};
  /// Pull of each region's weights towards those of the whole face: LocalWeightsOptions::ridge.
  double region_ridge = LocalWeightsOptions().ridge;
  /// How the falloff is measured: by heat distances by default; in a transfer, as in the analysis.
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

/// What eq. 10 and 12 sum over.
EdgeSum edge_sum(Compatibility compatibility);

/// The options, with what a solve takes from the analysis unless it is given: edges and distances.
SolveOptions with_analysis(SolveOptions options, const AnalysisOptions& analysis);

/// True for the vertex space, and where a target has no expressions to solve for.
bool solves_for_vertices(const BlendshapeModel& target, Space space);

/// Throws OptionError where the target has no pair for a symmetry (Topic::no_pairs), or none of the
/// groups that are to exclude each other (Topic::no_exclusives), and what ExpressionRules() throws;
/// nothing where it is solved for vertices. Throws std::invalid_argument where each region is to
/// have weights of its own and the target has none, or they are to be smooth or to follow rules.
void check_rules(const Target& target, const SolveOptions& options);

/// Throws OptionError (Topic::soft_outside) where the border of regions is soft and, in vertex
/// space, triangles outside are to keep their shape.
void check_soft_border(const Target& target, const SolveOptions& options);

/// For prepare_source(): finds the head's motion together with the expressions of the first of the
/// targets that is solved for weights, and compares it with the stable one on vertices that were
/// held out; empty where no target is. It refers to the target.
///
/// Eight patches of the mesh are held out, one after the other: both fits see the rest of at most
/// fifty frames, and predict the patch by the motion and the expressions that they find.
///
/// What it returns throws OptionError (Topic::undetermined_axes) as placed_at(), what reading
/// throws, Cancelled.
JointSearch joint_search(const std::vector<Target>& targets, const SolveOptions& options = {});

/// A source as it looks where the target is.
struct PlacedSource {
  /// Its frames, rest pose and head motion, carried there; `given` is not.
  Source source;
  /// From the source's rest pose to the target's.
  Similarity similarity;
};

/// Carries the source by the similarity from its rest pose to the target's neutral, over the
/// vertices that triangles use (where faces differ, target vertices and their carriers), so that
/// unit, place and axes are the target's; bit by bit the source itself where both are equal. With
/// Axes::none it is not turned. Notes a mirrored target under its name. Throws OptionError
/// (Topic::undetermined_axes) where the rest poses leave the rotation open. \pre a MatchedTarget
PlacedSource placed_at(const Target& target, const Source& source, Axes axes = Axes::fit,
                       const Context& context = {});

/// What a transfer looks at.
struct Selection {
  std::vector<int> triangles;  ///< L
  std::vector<bool> inside;    ///< vertices inside the regions (N); empty for all
  /// Vertices of each region, in the regions' order; none for all triangles.
  std::vector<std::vector<VertexIndex>> regions = {};
  /// Share of the wanted motion that each vertex takes (N), in [0, 1]; empty where the regions'
  /// border is hard. Vertices inside are those above 0, and L holds all triangles with one of them.
  Eigen::VectorXd weights = {};
};

Selection selection_of(const Regions& regions);
/// All triangles.
Selection whole(const FrameSource& sequence);

/// What a transfer by regions of the source looks at on a target: where faces differ, the triangles
/// over theirs (triangles_over()) and in gaps between them. \pre a MatchedTarget
Selection selection_of(const Regions& regions, const Target& target);
/// All triangles of the target.
Selection whole(const Target& target);

/// Vertices of the target that lie over each region of the source.
std::vector<std::vector<VertexIndex>> regions_over(const Pairing& pairing, const Regions& regions);

/// A connected part of a target without a partner in the source that followed the surface around
/// it.
struct FollowingPart {
  int component;  ///< rank among surface_parts()
  int vertices;
  double farthest;  ///< largest move of a vertex from rest in any frame, in the target's unit
};

/// The parts that follow, by component, with how far each moves at most.
std::vector<FollowingPart> described(const FollowingParts& parts,
                                     const std::vector<double>& farthest,
                                     const BlendshapeModel& model);

/// What a solve notes of a target, under its name.
class TargetNotes {
 public:
  TargetNotes(const std::string& name, const Context& context)
      : start_(name + ": "), context_(context) {}

  void add(const std::string& text, Topic topic = Topic::other) const;
  /// Expressions that are not or hardly seen.
  void add(const BlendshapeConditions& conditions) const;
  void add(const std::vector<FollowingPart>& parts) const;
  /// Seams that rounding opened, which nothing holds together.
  void add_almost_welded(const BlendshapeModel& model) const;
  /// Vertices that no triangle moves, where a mesh has triangles.
  void add_unmoved(const Connectivity& connectivity) const;

  /// Triangles that are slivers, or lie between vertices that a seam makes one.
  struct Degenerate {
    int source = 0, target = 0, collapsed = 0;
  };
  void add_degenerate(const Degenerate& triangles) const;

 private:
  std::string start_;
  const Context& context_;
};

/// A target's poses that follow a source.
struct Solution {
  /// Of solve(): without head motion, the rest pose is the neutral. Its frames are computed when
  /// they are read, or stored; it does not need the source or the target any more.
  std::shared_ptr<const FrameSource> sequence;
  /// The same where weights drive it; null in vertex space. Its model is faded() where the
  /// selection has weights.
  std::shared_ptr<const Animation> animation;
  /// The same where each region has weights of its own, else null.
  std::shared_ptr<const RegionalAnimation> regional;
  /// Of the weights of regions: LocalWeights.
  double violation = 0;
  BlendshapeConditions conditions;
  /// Between vertices that are one, in vertex space: they take no part, and are none of the
  /// degenerate ones.
  int collapsed_triangles = 0;
  /// In vertex space, by component.
  std::vector<FollowingPart> following_parts = {};
  int degenerate_source_triangles = 0;
  int degenerate_target_triangles = 0;
  double seconds = 0;  ///< set-up and the solve of all frames

  /// beta, F x D; of R regions with weights of their own F x R D, as in RegionalAnimation, the last
  /// region being what lies around them; empty in vertex space.
  const Eigen::MatrixXd& weights() const;
  /// Names of its columns: those of the expressions, of regions NAME@0, NAME@1, ... in the order of
  /// the selection and NAME@background.
  std::vector<std::string> weight_names() const;
};

/// closed_seams() of a source and a target. \pre as of solve()
Weld closed_seams_of(const Source& source, const Target& target, const Context& context = {});

/// Solves on the selected triangles in blendshape or vertex space; in vertex space closed_seams()
/// stay closed. Notes, under the target's name, expressions that the triangles do not or hardly
/// show (Topic::poor_condition where they do not tell them apart), triangles without area or that a
/// seam collapses, parts that follow the surface around them, and a source whose neutral is not
/// known and whose rest pose does not look like it (Topic::unneutral_rest). \pre the target is a
/// MatchedTarget, the source is placed_at() it
///
/// Where each region has weights of its own, they are found on all triangles and drawn towards
/// those of the whole face, which ridge and sparsity shape; a selection without regions has those.
///
/// Where the selection has weights, vertices take that share of the motion. In vertex space it
/// fades as SoftBorder describes. In blendshape space triangle i counts phi_i times, the mean of
/// its corners' weights, and the result is neutral + phi_v sum_j beta_j dV_j: that of faded()
/// expressions, not the model's at these weights.
///
/// Throws OptionError (Topic::no_expressions, Topic::anchor_vertex, Topic::held_anchor,
/// Topic::anchor_and_weights, Topic::soft_outside) and what check_rules(), BlendshapeTransfer,
/// LocalWeights, closed_seams(), VertexTransfer, reading the source and FrameStore throw;
/// std::invalid_argument where each region is to have weights of its own that are smooth over time,
/// or a target has none, or the selection has weights too; and for weights that are not in [0, 1],
/// one a vertex.
Solution solve(const Source& source, const Target& target, const Selection& selection,
               const SolveOptions& options = {}, const Context& context = {});

}  // namespace mimetra
