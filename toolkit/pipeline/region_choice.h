#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/mesh/simplification.h"
#include "toolkit/pipeline/solve.h"
#include "toolkit/transfer/region_completion.h"
#include "toolkit/transfer/region_selection.h"

namespace mimetra {

/// Criterion for choosing regions.
enum class Selector {
  energy,   ///< strongest motion of the source's components
  transfer  ///< information about a target's expressions (RegionSelection)
};

constexpr std::string_view choice_name(Selector value) {
  switch (value) {
    case Selector::energy:
      return "energy";
    case Selector::transfer:
      return "transfer";
  }
  return {};
}

struct RegionChoiceOptions {
  Selector select = Selector::energy;
  /// Largest share of the source's triangles in the regions, completing discs included. Default: no
  /// limit for Selector::energy, kUsualShare for Selector::transfer.
  std::optional<double> triangles = {};
  /// Largest number of discs for Selector::transfer, >= 1; no limit by default. If it is set,
  /// `triangles` has no limit by default.
  std::optional<int> discs = {};
  /// Drops regions by energy with centres on the rim of the surface (near_rims()). Noise moves rims
  /// where a scan ends. If a model drives the rim, its motion is as good as any other.
  bool drop_rims = false;
  /// Geodesic radius of a region, > 0. A region of radius 0 would contain only its centre, and
  /// perhaps no triangle.
  Length radius = Length::share(RegionOptions::kRadiusShare);
  /// See RegionOptions.
  RegionShape shape = RegionShape::disc;
  std::optional<double> coverage = {};
  /// Completes the regions for a target with expressions: CompletionOptions::share and limit.
  double complete = CompletionOptions().share;
  double complete_limit = CompletionOptions().limit;

  /// Beyond this share, regions for the transfer lose hardly any accuracy.
  static constexpr double kUsualShare = 0.3;

  static constexpr Option kSelect{"select", &RegionChoiceOptions::select};
  static constexpr Option kTriangles{
      "triangles", &RegionChoiceOptions::triangles, {.minimum = 1e-9, .maximum = 1}};
  static constexpr Option kDiscs{"discs", &RegionChoiceOptions::discs, {.minimum = 1}};
  static constexpr Option kDropRims{"drop_rims", &RegionChoiceOptions::drop_rims};
  static constexpr Option kRadius{"radius", &RegionChoiceOptions::radius, {.minimum = 1e-9}};
  static constexpr Option kShape{"shape", &RegionChoiceOptions::shape};
  static constexpr Option kCoverage{"coverage", &RegionChoiceOptions::coverage,
                                    RegionOptions::kCoverage.range};
  static constexpr Option kComplete{"complete", &RegionChoiceOptions::complete,
                                    CompletionOptions::kShare.range};
  static constexpr Option kCompleteLimit{"complete_limit", &RegionChoiceOptions::complete_limit,
                                         CompletionOptions::kLimit.range};
  static constexpr auto declared() {
    return std::tuple(kSelect, kTriangles, kDiscs, kDropRims, kRadius, kShape, kCoverage, kComplete,
                      kCompleteLimit);
  }
};

/// Finds the regions of an analysis and keeps the strongest ones, up to the share of triangles.
///
/// Notes what find_regions() notes, and regions with centres on a small part of the surface
/// (Topic::small_parts). Notes discs of more than half the mesh (Topic::large_regions), and
/// components that give no region because they move a rim most.
///
/// Throws std::invalid_argument for options out of range. Throws OptionError
/// (Topic::triangle_bound) if the strongest region alone exceeds the share, and MismatchError if no
/// region is left.
Regions choose_regions(const Analysis& analysis, const RegionChoiceOptions& options = {},
                       const Context& context = {});

/// Whether each of several targets has regions of its own. That is so if regions are chosen for the
/// target, or if they make room for its completing discs.
bool has_own_regions(const RegionChoiceOptions& options);

/// Regions that were found on a simplified mesh.
struct SimplifiedRegions {
  Simplification mesh;
  Regions regions;  ///< on the given mesh (carried_regions())
  double seconds = 0;
};

/// Decomposes a source on a share of its vertices, chooses regions there, and measures their discs
/// along the whole mesh. This is much less work on fine meshes. Throws std::invalid_argument for
/// RegionShape::support, which is not a disc, and what simplify(), analyse() and choose_regions()
/// throw.
SimplifiedRegions regions_by_simplified(const Source& source, const SimplifyOptions& simplifying,
                                        const AnalysisOptions& analysis = {},
                                        const RegionChoiceOptions& choice = {},
                                        const Context& context = {});

/// Regions of an earlier run.
struct GivenRegions {
  /// Name in errors.
  std::string name = "the regions";
  Regions regions;
};

/// Throws MismatchError if the regions belong to another mesh than the sequence, or contain no
/// triangle.
void check_regions(const GivenRegions& given, const FrameSource& sequence);

/// Completes regions of one source for several targets. Adds discs of half the options' radius
/// until the regions see every expression of a target.
class RegionCompleter {
 public:
  /// Distances along the source's rest pose are set up at their first use, with the options of the
  /// analysis.
  RegionCompleter(const Source& source, const RegionChoiceOptions& options,
                  const AnalysisOptions& analysis);
  RegionCompleter(const Analysis& analysis, const RegionChoiceOptions& options);

  /// Returns the completed regions. With the options' share of triangles, the weakest regions make
  /// room for the discs. The strongest region stays, with as many discs beside it as fit.
  ///
  /// Returns the regions unchanged for a target solved for vertices and for weights of each region,
  /// because both use all triangles. Regions with a soft border stay unchanged as well. Notes,
  /// under the target's name, what was added and left out (Topic::completed_regions). Throws what
  /// completed() throws.
  Regions operator()(const Regions& regions, const Target& target, const SolveOptions& options,
                     const Context& context = {});

 private:
  /// Returns the most regions that fit with their completing discs into `bound`, a share of the
  /// triangles.
  CompletedRegions completed_within(double bound, const Regions& regions, const Target& target,
                                    const CompletionOptions& options);

  Positions rest_;
  Triangles triangles_;
  RegionChoiceOptions options_;
  double radius_;
  std::vector<bool> inside_;  // vertices on which discs may lie, or empty
  DistanceOptions of_distances_;
  DistanceFunction distances_;  // may be empty before the first use
  std::optional<DiscSearch> search_;
};

/// Limits that the options set for a choice of regions for a transfer.
SelectionBound selection_bound(const RegionChoiceOptions& options);

/// Throws OptionError (Topic::no_selection) if regions are to be chosen for a target that is solved
/// for vertices.
void check_selection(const Target& target, const RegionChoiceOptions& regions, Space space);

/// Chooses regions of one source for the transfer to each of several targets (RegionSelection). The
/// candidates are kCandidates discs of kDiscRadius times the options' radius, around vertices far
/// from each other.
class RegionSelector {
 public:
  /// Measured on faces of several models: smaller discs follow the needed areas more closely,
  /// larger discs locate each region better.
  static constexpr double kDiscRadius = 0.35;
  static constexpr int kCandidates = 400;
  /// Number of frames that are used, evenly spread over longer clips.
  static constexpr int kMostFrames = 100;

  /// Discs stay on analysis.inside, or on the source's moving_parts() if that is empty. Distances
  /// run along the rest pose of `source`, with the options of the analysis, and are set up at their
  /// first use. Throws std::invalid_argument for options out of range.
  RegionSelector(const Source& source, const RegionChoiceOptions& options,
                 const AnalysisOptions& analysis);

  /// Regions for a target, in the order of their choice. Their energy is their share of the
  /// vertices' motion. Notes, under the target's name, if all discs contain fewer triangles than
  /// the options allow (Topic::few_discs).
  ///
  /// Throws OptionError (Topic::no_selection) for a target that is solved for vertices and
  /// (Topic::triangle_bound) if no disc fits. Throws Cancelled, and what RegionSelection and
  /// distances throw. \pre the target is a MatchedTarget, the source is placed_at() it
  Regions operator()(const Source& source, const Target& target, const SolveOptions& options,
                     const Context& context = {});
  /// As operator(), for each of several bounds instead of the options' limits; notes no shortage.
  std::vector<Regions> within(std::span<const SelectionBound> bounds, const Source& source,
                              const Target& target, const SolveOptions& options,
                              const Context& context = {});

 private:
  const std::vector<Disc>& candidates(const Context& context);

  Positions rest_;
  Triangles triangles_;
  RegionChoiceOptions options_;
  DistanceOptions of_distances_;
  double radius_ = 0;
  std::vector<bool> inside_;  // vertices on which discs may lie, or empty
  std::vector<Disc> candidates_;
};

/// Refuses a border that a transfer cannot have, before anything is computed. `given` are regions
/// of an earlier run, or null. Throws what check_soft_border() throws for a soft border. Throws
/// OptionError (Topic::no_full_weight) if no vertex has the weight 1, from which regions could fade
/// out. Throws std::invalid_argument for SolveOptions::per_region with regions that have vertex
/// weights.
void check_border(const GivenRegions* given, const Target& target, const SolveOptions& options);

/// Carries weights of a source's vertices (N) to a target's vertices (N). A vertex takes the mean
/// of its carriers' weights, by their shares. A vertex without carriers takes the harmonic
/// interpolation of the weights around it (least sum of squared differences along edges). It takes
/// 0 if no connected vertex has carriers. `weld` and `triangles` (M x 3) belong to the target.
/// Welded vertices have carriers if one of them has.
Eigen::VectorXd carried_weights(const Eigen::VectorXd& weights, const Pairing& pairing,
                                const Weld& weld, const Triangles& triangles);

/// Returns the selection_of() regions of the source on a target, with the regions' weights there.
/// The weights fade out around the vertices of weight 1, over the options' falloff.
///
/// FollowingParts take the weight of the surface around them on a paired target, and with a falloff
/// on any target. The border is hard without weights and falloff. It is also hard with
/// SolveOptions::per_region, which uses the falloff for the weights of each region.
///
/// A relative falloff is a share of the size of the moving_parts(), if the target has the source's
/// faces and `moving` lists vertices. Otherwise it is a share of the size of the parts with
/// weights.
///
/// Throws OptionError (Topic::no_full_weight) if no vertex has the weight 1, and MismatchError if
/// no vertex of the target has a weight. Throws std::invalid_argument for a falloff out of range,
/// and what distances_along() throws. \pre the target is a MatchedTarget
Selection bordered_selection(const Regions& regions, const Target& target,
                             const SolveOptions& options,
                             const std::vector<VertexIndex>& moving = {},
                             const Context& context = {});

/// Returns the regions with the border that they have on a target with the source's faces. Regions
/// of a paired target stay unchanged.
Regions with_border(Regions regions, const Selection& selection, const Target& target);

}  // namespace mimetra
