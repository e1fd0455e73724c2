#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "toolkit/pipeline/analysis.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/region_completion.h"

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

/// Connected parts of a smaller share of the surface are hardly what a face's regions are meant
/// for: single teeth, lashes.
constexpr double kSmallPart = 0.02;

/// Regions of an analysis, of which the strongest are kept that hold no more than the share of the
/// triangles; what find_regions() notes is noted, and regions whose centres lie on a small part of
/// the surface (Topic::small_parts), those that note_large_regions() finds, and components that
/// give no region because they move a rim most. Throws std::invalid_argument for options out of
/// range, OptionError (Topic::triangle_bound) where the strongest region alone holds more.
Regions choose_regions(const Analysis& analysis, const RegionChoiceOptions& options = {},
                       const Context& context = {});

/// Says which discs of a radius that was not given as a length hold more than half of a mesh of
/// this size (Topic::large_regions): they tell nothing apart.
void note_large_regions(const Regions& regions, const RegionChoiceOptions& options, double size,
                        const Triangles& triangles, const Context& context);

/// Whether each of several targets has regions that may hold what another's do not: those that are
/// chosen for it, and those that make room for its own discs.
bool has_own_regions(const RegionChoiceOptions& options);

/// Throws OptionError (Topic::triangle_bound) that says why no region fits into a share of the
/// triangles.
[[noreturn]] void refuse_bound(double share, const std::string& reason);

/// Regions that were made before.
struct GivenRegions {
  /// In errors.
  std::string name = "the regions";
  Regions regions;
};

/// Throws MismatchError where they are of another mesh than the sequence, or hold no triangle.
void check_regions(const GivenRegions& given, const FrameSource& sequence);

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

}  // namespace mimetra
