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

/// By what regions are chosen.
enum class Selector {
  energy,   ///< where the source's components move most
  transfer  ///< by what they tell of a target's expressions (RegionSelection)
};

/// As people choose it.
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
  /// Share of the source's triangles that the regions may hold, those that complete them included;
  /// by default any for Selector::energy, and kUsualShare for Selector::transfer.
  std::optional<double> triangles = {};
  /// Number of discs that Selector::transfer may choose, >= 1; by default any. Where it is given,
  /// `triangles` is any by default.
  std::optional<int> discs = {};
  /// Leaves out regions by energy whose centres lie on the rim of the surface (near_rims()), which
  /// noise moves where a scan ends. Where a model makes the motion of a rim, it is worth as much as
  /// any other.
  bool drop_rims = false;
  /// Geodesic radius of a region. One of no size would hold nothing but its centre, and no triangle
  /// would be sure to be in it.
  Length radius = Length::share(RegionOptions::kRadiusShare);
  /// As in RegionOptions.
  RegionShape shape = RegionShape::disc;
  std::optional<double> coverage = {};
  /// Completes the regions for a target with expressions: CompletionOptions::share and limit.
  double complete = CompletionOptions().share;
  double complete_limit = CompletionOptions().limit;

  /// Above it regions by the transfer cost hardly anything.
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

/// Regions of an analysis, of which the strongest are kept that hold no more than the share of the
/// triangles; what find_regions() notes is noted, and regions whose centres lie on a small part of
/// the surface (Topic::small_parts), those that note_large_regions() finds, and components that
/// give no region because they move a rim most. Throws std::invalid_argument for options out of
/// range, OptionError (Topic::triangle_bound) where the strongest region alone holds more.
Regions choose_regions(const Analysis& analysis, const RegionChoiceOptions& options = {},
                       const Context& context = {});

/// Whether each of several targets has regions that may hold what another's do not: those that are
/// chosen for it, and those that make room for its own discs.
bool has_own_regions(const RegionChoiceOptions& options);

/// Regions that were found on fewer vertices.
struct SimplifiedRegions {
  Simplification mesh;
  Regions regions;  ///< on the given mesh (carried_regions())
  double seconds = 0;
};

/// Decomposes a source on a share of its vertices, chooses regions there, and measures their discs
/// along the whole mesh: much less work where the mesh is fine. Throws std::invalid_argument for
/// RegionShape::support, which is no disc; what simplify(), analyse() and choose_regions() throw.
SimplifiedRegions regions_by_simplified(const Source& source, const SimplifyOptions& simplifying,
                                        const AnalysisOptions& analysis = {},
                                        const RegionChoiceOptions& choice = {},
                                        const Context& context = {});

/// Regions that were made before.
struct GivenRegions {
  /// In errors.
  std::string name = "the regions";
  Regions regions;
};

/// Throws MismatchError where they are of another mesh than the sequence, or hold no triangle.
void check_regions(const GivenRegions& given, const FrameSource& sequence);

/// Completes regions of one source for several targets: discs of half their radius are added until
/// they see every expression of a target.
class RegionCompleter {
 public:
  /// Distances along the source's rest pose are made, as the options of the analysis say, when they
  /// are needed first.
  RegionCompleter(const Source& source, const RegionChoiceOptions& options,
                  const AnalysisOptions& analysis);
  RegionCompleter(const Analysis& analysis, const RegionChoiceOptions& options);

  /// The regions themselves where a target is solved for vertices, or for weights of each region,
  /// which look at all triangles; and those whose border is soft, which somebody painted as they
  /// are. Where the options bound the share of the triangles, the weakest
  /// regions make room for the discs that are added, the last one apart, beside which as many are
  /// added as fit. Notes, under the target's name, what was added and left out
  /// (Topic::completed_regions). Throws what completed() throws.
  Regions operator()(const Regions& regions, const Target& target, const SolveOptions& options,
                     const Context& context = {});

 private:
  /// The most regions with the discs that complete them, within `bound` as a share of the
  /// triangles.
  CompletedRegions completed_within(double bound, const Regions& regions, const Target& target,
                                    const CompletionOptions& options);

  Positions rest_;
  Triangles triangles_;
  RegionChoiceOptions options_;
  double radius_;
  std::vector<bool> inside_;  // where discs may lie, or empty
  DistanceOptions of_distances_;
  DistanceFunction distances_;  // or empty
  std::optional<DiscSearch> search_;
};

/// How much the options let be chosen for a transfer.
SelectionBound selection_bound(const RegionChoiceOptions& options);

/// Throws OptionError (Topic::no_selection) where regions are to be chosen for a target that is
/// solved for vertices.
void check_selection(const Target& target, const RegionChoiceOptions& regions, Space space);

/// Regions of one source that are chosen for the transfer to a target (RegionSelection), for
/// several targets: discs of kDiscRadius times the radius of the options, of which kCandidates lie
/// around vertices that are far from each other.
class RegionSelector {
 public:
  /// Measured on faces of several models: smaller discs follow what is needed, larger ones tell
  /// each region's place better.
  static constexpr double kDiscRadius = 0.35;
  static constexpr int kCandidates = 400;
  /// Frames that are looked at, evenly spread over the clip where it has more.
  static constexpr int kMostFrames = 100;

  /// Discs lie on the source's moving_parts(), or where the analysis says. `source` gives the
  /// surface along which distances run, as the options of the analysis say; they are made when they
  /// are needed first. Throws std::invalid_argument for options out of range.
  RegionSelector(const Source& source, const RegionChoiceOptions& options,
                 const AnalysisOptions& analysis);

  /// The regions for a target, in the order in which they were chosen, with the share of the
  /// vertices' motion that they hold as energy. Where all discs hold less than the share of the
  /// triangles that was asked for, that is noted under the target's name (Topic::few_discs).
  ///
  /// Throws OptionError (Topic::no_selection) for a target that is solved for vertices and
  /// (Topic::triangle_bound) where no disc fits, Cancelled, and what RegionSelection and distances
  /// throw. \pre the target is a MatchedTarget, the source is placed_at() it
  Regions operator()(const Source& source, const Target& target, const SolveOptions& options,
                     const Context& context = {});
  /// The same for several bounds instead of that of the options.
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
  std::vector<bool> inside_;  // where discs may lie, or empty
  std::vector<Disc> candidates_;
};

/// Refuses a border that a transfer cannot have, before anything is computed. `given` are regions
/// of an earlier run, or null. Throws what check_soft_border() throws for a soft border;
/// OptionError (Topic::no_full_weight) if no vertex has the weight 1 around which regions could
/// fade out; and std::invalid_argument for SolveOptions::per_region with regions whose vertices
/// have weights.
void check_border(const GivenRegions* given, const Target& target, const SolveOptions& options);

/// Carries weights of a source's vertices (N) to a target's vertices (N). A vertex takes the mean
/// of its carriers' weights, by their shares. A vertex without carriers takes the harmonic
/// interpolation of the weights around it (least sum of squared differences along edges), or 0 if
/// no connected vertex has carriers. `weld` and `triangles` (M x 3) belong to the target; vertices
/// at one place have carriers if one of them has.
Eigen::VectorXd carried_weights(const Eigen::VectorXd& weights, const Pairing& pairing,
                                const Weld& weld, const Triangles& triangles);

/// The selection_of() regions of the source on a target, with the regions' weights there. The
/// weights fade out around the vertices of weight 1, over the falloff of the options.
/// FollowingParts take the weight of the surface around them on a paired target, and with a falloff
/// on any target. The border is hard without weights and falloff, and with
/// SolveOptions::per_region, where the falloff belongs to the weights of each region.
///
/// A relative falloff is a share of the size of the moving_parts(), if the target has the source's
/// faces and `moving` lists vertices. Otherwise it is a share of the size of the parts with
/// weights.
///
/// Throws OptionError (Topic::no_full_weight) if no vertex has the weight 1; MismatchError if no
/// vertex of the target has a weight; std::invalid_argument for a falloff out of range; and what
/// distances_along() throws. \pre a MatchedTarget
Selection bordered_selection(const Regions& regions, const Target& target,
                             const SolveOptions& options,
                             const std::vector<VertexIndex>& moving = {},
                             const Context& context = {});

/// The regions with the border that they have on a target with the source's faces. Regions of a
/// paired target stay as they are.
Regions with_border(Regions regions, const Selection& selection, const Target& target);

}  // namespace mimetra
