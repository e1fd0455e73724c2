#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "toolkit/pipeline/source.h"
#include "toolkit/splocs/decomposition.h"

namespace mimetra {

/// Which vertices count as one for distances.
enum class Welding {
  exact,  ///< those at one place (UV seams)
  none
};

/// As people choose it.
constexpr std::string_view choice_name(Welding value) {
  switch (value) {
    case Welding::exact:
      return "exact";
    case Welding::none:
      return "none";
  }
  return {};
}

struct DistanceOptions {
  GeodesicMethod method = GeodesicMethod::heat;
  Welding welding = Welding::exact;
  /// 0 for all there are; the result does not depend on it.
  int threads = 0;
  Notes notes = {};

  static constexpr Option kMethod{"method", &DistanceOptions::method};
  static constexpr Option kWelding{"welding", &DistanceOptions::welding};
  static constexpr auto declared() { return std::tuple(kMethod, kWelding); }
};

/// Distances along a mesh. Notes triangles and vertices that had to be left out. Throws
/// std::invalid_argument as SurfaceDistances does, and for options out of range.
SurfaceDistances distances_along(const Positions& rest, const Triangles& triangles,
                                 const DistanceOptions& options = {});

/// Distances between which a support map rises, absolute.
struct SupportRange {
  double d_min;
  double d_max;
};

/// For a mesh whose longest side is `longest_side`. Throws OptionError (Topic::support_range)
/// unless d_min is below d_max.
SupportRange support_range(const Length& d_min, const Length& d_max, double longest_side);

/// The rest pose of a decomposition.
enum class RestPose { first, mean };

/// As people choose it.
constexpr std::string_view choice_name(RestPose value) {
  switch (value) {
    case RestPose::first:
      return "first";
    case RestPose::mean:
      return "mean";
  }
  return {};
}

enum class Compatibility {
  none,
  /// The reference implementation to the letter: lengths are shares of the longest side that any
  /// single frame has, signs are decided as there, ten iterations run unless another number is
  /// asked for, all of them, the last is returned, and the rest pose is the first frame unless one
  /// is asked for.
  splocs2013
};

/// As people choose it.
constexpr std::string_view choice_name(Compatibility value) {
  switch (value) {
    case Compatibility::none:
      return "none";
    case Compatibility::splocs2013:
      return "splocs2013";
  }
  return {};
}

struct AnalysisOptions {
  /// A frame, the mean of all, or a given pose (N x 3); by default the source's.
  std::optional<std::variant<RestPose, Positions>> rest = {};
  /// Distance up to which sparsity costs nothing, and from which it costs all.
  Length d_min = Length::share(DecompositionOptions::kMinimumShare);
  Length d_max = Length::share(DecompositionOptions::kMaximumShare);
  Compatibility compatibility = Compatibility::none;
  /// Its lengths, distances, threads and progress are those of the analysis, and its sign rule,
  /// tolerance and returned iterate those of the compatibility where there is one.
  DecompositionOptions decomposition = {.count = 30};
  /// Its threads and notes are those of the analysis.
  DistanceOptions distances = {};
  /// 0 for all there are; the result does not depend on it.
  int threads = 0;
  Progress progress = {};
  Notes notes = {};

  static constexpr Option kRest{"rest", &AnalysisOptions::rest};
  static constexpr Option kMinimum{"d_min", &AnalysisOptions::d_min};
  static constexpr Option kMaximum{"d_max", &AnalysisOptions::d_max};
  static constexpr Option kCompatibility{"compatibility", &AnalysisOptions::compatibility};
  static constexpr auto declared() { return std::tuple(kMinimum, kMaximum, kCompatibility); }
};

/// Components of a sequence, and the distances along their rest pose.
struct Analysis {
  Components components;
  SurfaceDistances distances;
  double seconds = 0;
};

/// Decomposes a source, all frames of which are in memory meanwhile. Notes vertices that are welded
/// at rest and part later. Throws OptionError (Topic::component_count, Topic::support_range) and
/// what decompose() throws.
Analysis analyse(const Source& source, const AnalysisOptions& options = {});

/// Components of an earlier run.
struct GivenComponents {
  /// In errors.
  std::string name = "the components";
  Components components;
};

/// The same for components that are known already: of the options only the distances count. Throws
/// MismatchError where they hold no weights, are of another mesh than the sequence, or all of them
/// died.
Analysis analysis_of(const GivenComponents& given, const FrameSource& sequence,
                     const AnalysisOptions& options = {});

}  // namespace mimetra
