#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "toolkit/pipeline/source.h"
#include "toolkit/splocs/decomposition.h"
#include "toolkit/splocs/surface_distances.h"

namespace mimetra {

/// Which vertices count as one vertex in distances.
enum class Welding {
  exact,  ///< vertices at the same position (UV seams)
  none
};

constexpr std::string_view choice_name(Welding value) {
  switch (value) {
    case Welding::exact:
      return "exact";
    case Welding::none:
      return "none";
  }
  return {};
}

/// Vertices that count as one, for positions (N x 3).
Weld weld_of(const Positions& positions, Welding welding);

struct DistanceOptions {
  GeodesicMethod method = GeodesicMethod::heat;
  Welding welding = Welding::exact;

  static constexpr Option kMethod{"method", &DistanceOptions::method};
  static constexpr Option kWelding{"welding", &DistanceOptions::welding};
  static constexpr auto declared() { return std::tuple(kMethod, kWelding); }
};

/// Computes distances along a mesh. Notes triangles and vertices that had to be left out, and seams
/// that rounding opened. Throws std::invalid_argument as SurfaceDistances does, and for options out
/// of range.
SurfaceDistances distances_along(const Positions& rest, const Triangles& triangles,
                                 const DistanceOptions& options = {}, const Context& = {});

/// Memory of the heat method for one mesh, with the fill-in of its factors. Measured on surfaces of
/// 7 to 325 thousand vertices.
inline constexpr double kHeatBytesPerVertex = 3700;

/// Bytes that distances from several sources need beyond what planned_decomposition() counts. Each
/// thread queries one source at a time. Exact distances need such memory, and so does CGAL's
/// method, because each thread keeps its own CGAL object.
double distance_bytes(GeodesicMethod method, Eigen::Index vertices, int sources, const Context&);

/// Returns the context with the memory that these distances leave. Throws MismatchError if they
/// need more memory than the context has.
Context beside_distances(GeodesicMethod method, Eigen::Index vertices, int sources, const Context&);

/// Distances between which a support map rises from 0 to 1, absolute.
struct SupportRange {
  double d_min;
  double d_max;
};

/// Converts both lengths to the unit of `diameter`; relative lengths are shares of it. Throws
/// OptionError (Topic::support_range) unless d_min is below d_max.
SupportRange support_range(const Length& d_min, const Length& d_max, double diameter);

/// Rest pose of a decomposition.
enum class RestPose { first, mean };

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
  /// Follows the reference implementation to the letter:
  /// - Lengths are shares of the longest side of any single frame's bounding box.
  /// - X is divided by its standard deviation, and signs are decided as in the reference.
  /// - All iterations run, ten by default, and the last one is returned.
  /// - The rest pose is the first frame, unless a rest pose is given.
  /// - All vertices count alike, whatever part they belong to.
  splocs2013,
  /// Follows splocs2013, and sums eq. 10 and 12 over two edges of each triangle, as printed.
  paper
};

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
  /// First frame, mean of all frames, or a given pose (N x 3). Default: the source's rest pose.
  std::optional<std::variant<RestPose, Positions>> rest = {};
  /// Sparsity costs nothing up to d_min from a component's centre, and the full price from d_max
  /// on.
  Length d_min = Length::share(DecompositionOptions::kMinimumShare);
  Length d_max = Length::share(DecompositionOptions::kMaximumShare);
  Compatibility compatibility = Compatibility::none;
  /// Vertices on which components and regions may lie (N), empty for all. The other vertices change
  /// nothing: components are zero there, and no centre or region lies there.
  std::vector<bool> inside = {};
  /// See DecompositionOptions. A compatibility runs all iterations and refuses a tolerance.
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

/// Components of a sequence and the distances along their rest pose. Also says which vertices
/// regions may contain (N, or empty) and how vertices are welded.
struct Analysis {
  Components components;
  SurfaceDistances distances;
  std::vector<bool> inside = {};
  double seconds = 0;
  Welding welding = Welding::exact;
  /// Diameter of the moving_parts(). Relative lengths are shares of it, except d_min and d_max with
  /// a compatibility.
  double size = 0;
};

/// Returns the source's frames with the rest pose that analyse() uses.
std::shared_ptr<const FrameSource> work_of(const Source& source, const AnalysisOptions& options);

/// Share of each vertex (N) in the motion energy of the vertices `inside` (N, empty for all). The
/// energy is the squared distance from the rest pose. All shares are 0 if nothing moves.
Eigen::VectorXd motion_on_vertices(const FrameSource& sequence,
                                   const std::vector<bool>& inside = {},
                                   const Context& context = {});

/// Connected parts of a surface, each weighted by its area as a share of the largest part's area.
/// Areas count only vertices `inside` (N, or empty for all). So a tooth weighs as little as its
/// share of the skin, however dense its mesh. Empty if there is one part, or if nothing has area.
PartWeights part_weights(const Positions& rest, const Triangles& triangles,
                         const std::vector<bool>& inside = {}, Welding welding = Welding::exact);

/// Converts the options, except lengths, distances and part weights.
DecompositionOptions decomposition_options(const AnalysisOptions& options);

/// Number of components that analyse() computes, at most options.count. Within d_min of its centre
/// a component may move everything, so F frames distinguish only F components there. The limit is F
/// times the number of such discs on the surface; more components would die or repeat others.
/// Further limits are 3 N and the number of vertices inside. A compatibility has no limit. d_min is
/// a share of `size`.
int component_count(const FrameSource& sequence, double size, const AnalysisOptions& options);

/// Decomposes a source, with all its frames in memory. Connected parts are weighted by
/// part_weights(), except with a compatibility.
///
/// Notes vertices that are welded at rest and part later, and a component count below the requested
/// one. Notes if only a section of a part moves.
///
/// Throws OptionError (Topic::component_count, Topic::support_range, Topic::no_vertex_inside).
/// Throws std::invalid_argument for options out of range, or a tolerance with a compatibility.
/// Throws MismatchError if nothing moves inside, and what decompose() throws.
Analysis analyse(const Source& source, const AnalysisOptions& options = {},
                 const Context& context = {});

/// Components of an earlier run.
struct GivenComponents {
  /// Name in errors.
  std::string name = "the components";
  Components components;
};

/// Throws MismatchError if the components have no weights, belong to another mesh than the
/// sequence, or have all died.
void check_components(const GivenComponents& given, const FrameSource& sequence);

/// Returns the Analysis of given components. Of the options only `distances` and `inside` count;
/// centres outside move to the strongest vertex inside. `moving` lists the vertices that move in
/// the sequence. Throws as check_components() and distances_along() do, and OptionError
/// (Topic::no_vertex_inside).
Analysis analysis_of(const GivenComponents& given, const FrameSource& sequence,
                     const std::vector<VertexIndex>& moving, const AnalysisOptions& options = {},
                     const Context& context = {});

}  // namespace mimetra
