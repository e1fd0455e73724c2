#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "toolkit/pipeline/source.h"
#include "toolkit/splocs/decomposition.h"
#include "toolkit/splocs/surface_distances.h"

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

/// Of positions (N x 3).
Weld weld_of(const Positions& positions, Welding welding);

struct DistanceOptions {
  GeodesicMethod method = GeodesicMethod::heat;
  Welding welding = Welding::exact;

  static constexpr Option kMethod{"method", &DistanceOptions::method};
  static constexpr Option kWelding{"welding", &DistanceOptions::welding};
  static constexpr auto declared() { return std::tuple(kMethod, kWelding); }
};

/// Distances along a mesh. Notes triangles and vertices that had to be left out, and seams that
/// rounding opened. Throws std::invalid_argument as SurfaceDistances does, and for options out of
/// range.
SurfaceDistances distances_along(const Positions& rest, const Triangles& triangles,
                                 const DistanceOptions& options = {}, const Context& = {});

/// What the heat method takes for one mesh, with the fill-in of its factors: measured on surfaces
/// of 7 to 325 thousand vertices.
inline constexpr double kHeatBytesPerVertex = 3700;

/// Bytes that distances from several sources take besides what planned_decomposition() counts, if
/// each thread asks from one source at a time: exact ones, and CGAL's, whose object each thread
/// has for itself.
double distance_bytes(GeodesicMethod method, Eigen::Index vertices, int sources, const Context&);

/// The context with the memory that these distances leave. Throws MismatchError if they take more
/// than there is.
Context beside_distances(GeodesicMethod method, Eigen::Index vertices, int sources, const Context&);

/// Distances between which a support map rises, absolute.
struct SupportRange {
  double d_min;
  double d_max;
};

/// In the unit of `diameter`, of which the two are shares. Throws OptionError
/// (Topic::support_range) unless d_min is below d_max.
SupportRange support_range(const Length& d_min, const Length& d_max, double diameter);

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
  /// single frame has, X is divided by its standard deviation, signs are decided as there, ten
  /// iterations run unless another number is asked for, all of them, the last is returned, and the
  /// rest pose is the first frame unless one is asked for. All vertices count alike, whatever part
  /// they lie on.
  splocs2013,
  /// The same, and eq. 10 and 12 sum over two edges of each triangle as they are written.
  paper
};

/// As people choose it.
constexpr std::string_view choice_name(Compatibility value) {
  switch (value) {
    case Compatibility::none:
      return "none";
    case Compatibility::splocs2013:
      return "splocs2013";
    case Compatibility::paper:
      return "paper";
  }
  return {};
}

struct AnalysisOptions {
  /// Number of components K.
  int count = 30;
  /// A frame, the mean of all, or a given pose (N x 3); by default the source's.
  std::optional<std::variant<RestPose, Positions>> rest = {};
  /// Distance up to which sparsity costs nothing, and from which it costs all.
  Length d_min = Length::share(DecompositionOptions::kMinimumShare);
  Length d_max = Length::share(DecompositionOptions::kMaximumShare);
  Compatibility compatibility = Compatibility::none;
  /// Where components and regions may lie (N), empty for everywhere. What the other vertices do
  /// changes nothing: components are zero there, and no centre or region lies there.
  std::vector<bool> inside = {};
  /// As in DecompositionOptions. A compatibility runs all iterations, and refuses a tolerance.
  double sparsity = DecompositionOptions().sparsity;
  double rho = DecompositionOptions().rho;
  std::optional<int> iterations = {};
  int admm_iterations = DecompositionOptions().admm_iterations;
  double tolerance = DecompositionOptions::kUsualTolerance;
  bool nonnegative = true;
  double basis_tolerance = 0;
  IterationPrecision precision = IterationPrecision::double_precision;
  DistanceOptions distances = {};

  static constexpr Option kCount{"count", &AnalysisOptions::count,
                                 DecompositionOptions::kCount.range};
  static constexpr Option kRest{"rest", &AnalysisOptions::rest};
  static constexpr Option kMinimum{"d_min", &AnalysisOptions::d_min};
  static constexpr Option kMaximum{"d_max", &AnalysisOptions::d_max};
  static constexpr Option kCompatibility{"compatibility", &AnalysisOptions::compatibility};
  static constexpr Option kSparsity{"sparsity", &AnalysisOptions::sparsity,
                                    DecompositionOptions::kSparsity.range};
  static constexpr Option kRho{"rho", &AnalysisOptions::rho, DecompositionOptions::kRho.range};
  static constexpr Option kIterations{"iterations", &AnalysisOptions::iterations,
                                      DecompositionOptions::kIterations.range};
  static constexpr Option kAdmmIterations{"admm_iterations", &AnalysisOptions::admm_iterations,
                                          DecompositionOptions::kAdmmIterations.range};
  static constexpr Option kTolerance{"tolerance", &AnalysisOptions::tolerance,
                                     DecompositionOptions::kTolerance.range};
  static constexpr Option kNonnegative{"nonnegative", &AnalysisOptions::nonnegative};
  static constexpr Option kBasisTolerance{"basis_tolerance", &AnalysisOptions::basis_tolerance,
                                          DecompositionOptions::kBasisTolerance.range};
  static constexpr Option kPrecision{"precision", &AnalysisOptions::precision};
  static constexpr auto declared() {
    return std::tuple(kCount, kMinimum, kMaximum, kCompatibility, kSparsity, kRho, kIterations,
                      kAdmmIterations, kTolerance, kNonnegative, kBasisTolerance, kPrecision);
  }
};

/// Components of a sequence, the distances along their rest pose, where regions may lie (N, or
/// empty), and which vertices are one.
struct Analysis {
  Components components;
  SurfaceDistances distances;
  std::vector<bool> inside = {};
  double seconds = 0;
  Welding welding = Welding::exact;
  /// Diameter of the moving_parts(), of which lengths are shares, but for those of a compatibility.
  double size = 0;
};

/// The source's frames with the rest pose that analyse() decomposes them about.
std::shared_ptr<const FrameSource> work_of(const Source& source, const AnalysisOptions& options);

/// Share of the motion energy, squared distances from the rest pose, on each vertex (N), of that on
/// those `inside` (N, empty for all); 0 where nothing moves.
Eigen::VectorXd motion_on_vertices(const FrameSource& sequence,
                                   const std::vector<bool>& inside = {},
                                   const Context& context = {});

/// Connected parts of a surface, each weighing its area as a share of the largest part's, of which
/// only vertices `inside` (N, or empty) count: what moves a tooth counts as little as a tooth is of
/// the skin, however dense its mesh. Empty where there is one part, or nothing has area.
PartWeights part_weights(const Positions& rest, const Triangles& triangles,
                         const std::vector<bool>& inside = {}, Welding welding = Welding::exact);

/// The decomposition of these options, but for lengths, distances and part weights.
DecompositionOptions decomposition_options(const AnalysisOptions& options);

/// How many of the components asked for are made. Within d_min of its centre a component may move
/// everything, so that F frames tell F components apart there; of the surface there are so many
/// such discs. More components would die, or repeat others. A compatibility takes what is asked
/// for. `size` is what d_min is a share of.
int component_count(const FrameSource& sequence, double size, const AnalysisOptions& options);

/// Decomposes a source, all frames of which are in memory meanwhile; but for a compatibility that
/// decides otherwise, its parts count by part_weights(). Notes vertices that are welded at rest
/// and part later, where fewer components are made than were asked for, and where what moves is a
/// section of a part. Throws OptionError
/// (Topic::component_count, Topic::support_range, Topic::no_vertex_inside) and what decompose()
/// throws.
Analysis analyse(const Source& source, const AnalysisOptions& options = {},
                 const Context& context = {});

/// Components of an earlier run.
struct GivenComponents {
  /// In errors.
  std::string name = "the components";
  Components components;
};

/// Throws MismatchError where they hold no weights, are of another mesh than the sequence, or all
/// of them died.
void check_components(const GivenComponents& given, const FrameSource& sequence);

/// The same for components that are known already: of the options only the distances count, and
/// where regions may lie, which moves the centres outside to the strongest vertices inside.
/// `moving` are the vertices that move in the sequence. Throws as check_components().
Analysis analysis_of(const GivenComponents& given, const FrameSource& sequence,
                     const std::vector<VertexIndex>& moving, const AnalysisOptions& options = {},
                     const Context& context = {});

}  // namespace mimetra
