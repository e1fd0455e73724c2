#pragma once

#include <string>

#include "toolkit/pipeline/analysis.h"
#include "toolkit/regions/regions.h"
#include "toolkit/transfer/region_completion.h"

namespace mimetra {

struct RegionChoiceOptions {
  /// Geodesic radius of a region. One of no size would hold nothing but its centre, and no triangle
  /// would be sure to be in it.
  Length radius = Length::share(RegionOptions::kRadiusShare);
  /// Its radius and distances are those of the choice.
  RegionOptions regions = {};
  /// Of the regions for a target with expressions; its edges are those of the solve.
  CompletionOptions completion = {};
  Notes notes = {};

  static constexpr Option kRadius{"radius", &RegionChoiceOptions::radius, {.minimum = 1e-9}};
  static constexpr auto declared() { return std::tuple(kRadius); }
};

/// Connected parts of a smaller share of the surface are hardly what a face's regions are meant
/// for: single teeth, lashes.
constexpr double kSmallPart = 0.02;

/// Regions of an analysis; what find_regions() notes is noted, and regions whose centres lie on a
/// small part of the surface (Topic::small_parts). Throws std::invalid_argument for
/// options out of range.
Regions choose_regions(const Analysis& analysis, const RegionChoiceOptions& options = {});

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
};

Selection selection_of(const Regions& regions);
/// All triangles.
Selection whole(const FrameSource& sequence);

}  // namespace mimetra
