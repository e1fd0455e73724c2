#include "toolkit/operations/analysis.h"

#include <algorithm>

#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/progress.h"
#include "toolkit/mesh/stopwatch.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/json.h"

namespace mimetra {

namespace {

enum class Welding { exact, none };

constexpr std::string_view choice_name(Welding value) {
  switch (value) {
    case Welding::exact:
      return "exact";
    case Welding::none:
      return "none";
  }
  return {};
}

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

enum class Compatibility { none, splocs2013 };

constexpr std::string_view choice_name(Compatibility value) {
  switch (value) {
    case Compatibility::none:
      return "none";
    case Compatibility::splocs2013:
      return "splocs2013";
  }
  return {};
}

Weld weld_of(const Parameters& parameters, const Positions& positions) {
  switch (parameters.choice<Welding>("weld")) {
    case Welding::exact:
      return Weld::exact(positions);
    case Welding::none:
      break;
  }
  return Weld::none(static_cast<int>(positions.rows()));
}

MeshSequence with_decomposition_rest(const Parameters& parameters, const MeshSequence& sequence) {
  const std::string& rest = parameters.text("rest");
  const auto pose = choice_of<RestPose>(rest);
  if (!pose) return sequence.with_rest(read_rest(rest, sequence));
  switch (*pose) {
    case RestPose::first:
      return sequence.with_rest(sequence.frame(0));
    case RestPose::mean:
      break;
  }
  return sequence.with_rest(mean_pose(sequence));
}

/// Longest side that any single frame's bounding box has: the reference's unit of length.
double largest_frame_extent(const MeshSequence& sequence) {
  double largest = 0;
  for (int f = 0; f < sequence.frames(); ++f) {
    largest = std::max(largest, extent(sequence.frame(f)));
  }
  return largest;
}

/// Vertices that were welded at rest and part by more than this share of the longest side are
/// reported: well above float32 rounding, well below what one sees.
constexpr double kPartingShare = 1e-4;

void warn_of_parting(const Invocation& invocation, const MeshSequence& sequence) {
  if (invocation.parameters.choice<Welding>("weld") == Welding::none) return;
  const auto parting =
      parting_vertices(sequence, Weld::exact(sequence.rest()), kPartingShare * sequence.extent());
  if (parting.empty()) return;
  invocation.warn(std::to_string(parting.size()) +
                  " vertices coincide at rest and part later (the first is vertex " +
                  std::to_string(parting.front()) +
                  "); distances pass from one to the other, use --weld none to keep them apart");
}

/// Manifests keep all digits; a rotation that was typed or rounded by another tool passes too.
constexpr double kRotationTolerance = 1e-4;

RigidTransform transform_of(const Json& json) {
  RigidTransform transform;
  const auto rotation = json.at("rotation").get<std::vector<double>>();
  const auto translation = json.at("translation").get<std::vector<double>>();
  if (rotation.size() != 9 || translation.size() != 3) {
    throw std::invalid_argument("expected 9 numbers of rotation and 3 of translation a frame");
  }
  transform.rotation =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation.data());
  transform.translation = Eigen::Map<const Eigen::Vector3d>(translation.data());
  const Eigen::Matrix3d& R = transform.rotation;
  if (!(R * R.transpose()).isIdentity(kRotationTolerance) || R.determinant() < 0) {
    throw std::invalid_argument("its rotation is no rotation matrix (row by row)");
  }
  return transform;
}

}  // namespace

SurfaceDistances distances_on(const Invocation& invocation, const Positions& rest,
                              const Triangles& triangles) {
  SurfaceDistances distances(rest, triangles, weld_of(invocation.parameters, rest),
                             invocation.parameters.choice<GeodesicMethod>("geodesics"),
                             invocation.threads);
  if (distances.degenerate_triangles() > 0) {
    invocation.warn(std::to_string(distances.degenerate_triangles()) +
                    " triangles without area were left out of the geodesic distances");
  }
  if (!distances.vertices_without_face().empty()) {
    invocation.warn(std::to_string(distances.vertices_without_face().size()) +
                    " vertices belong to no triangle with area, the first is vertex " +
                    std::to_string(distances.vertices_without_face().front()) +
                    "; they are in no region");
  }
  return distances;
}

std::vector<Parameter> alignment_parameters() {
  return {file_parameter<HeadMotion>(
      "align", {},
      "head motion to take out first: fitted on what moves least, on all vertices, none, or "
      "as an align run's manifest tells; default none where the neutral is known, else stable")};
}

std::vector<Parameter> geodesic_parameters() {
  return {
      choice_parameter("geodesics", GeodesicMethod::heat, "how distances are computed"),
      choice_parameter("weld", Welding::exact,
                       "treat vertices at one place as one for distances (UV seams)"),
  };
}

std::vector<Parameter> decomposition_parameters(int count) {
  std::vector<Parameter> parameters = {
      {"k", ParameterKind::integer, std::int64_t{count}, "number of components", "", 1},
      file_parameter<RestPose>("rest", RestPose::first,
                               "rest pose of the decomposition: a frame, the mean, or a mesh"),
      {"d-min", ParameterKind::length, "0.1",
       "geodesic distance up to which sparsity costs nothing"},
      {"d-max", ParameterKind::length, "0.7", "geodesic distance from which it costs all"},
      {"sparsity", ParameterKind::number, DecompositionOptions{}.sparsity,
       "weight lambda of the sparsity term", "", 0},
      {"rho", ParameterKind::number, DecompositionOptions{}.rho, "penalty of ADMM", "", 1e-6},
      {"iterations", ParameterKind::integer, std::int64_t{DecompositionOptions{}.iterations},
       "outer iterations at most", "", 1},
      {"admm-iterations", ParameterKind::integer,
       std::int64_t{DecompositionOptions{}.admm_iterations}, "ADMM steps in each", "", 1},
      {"tolerance", ParameterKind::number, DecompositionOptions{}.tolerance,
       "stop when the energy changes by less than this share; 0 runs all iterations", "", 0, 1},
      {"signed", ParameterKind::flag, false, "allow negative weights"},
      choice_parameter("precision", DecompositionOptions{}.precision,
                       "of the iterations; single moves components by about 1e-6 of themselves"),
      {"basis-tolerance", ParameterKind::number, DecompositionOptions{}.basis_tolerance,
       "iterate on as few poses over time as leave out this share of the motion, 1e-6 or more; 0 "
       "on all",
       "", 0, 0.5},
      choice_parameter("compat", Compatibility::none,
                       "splocs2013: follow the reference implementation to the letter"),
  };
  for (const Parameter& parameter : geodesic_parameters()) parameters.push_back(parameter);
  return parameters;
}

/// A region of no size holds nothing but its centre, and no triangle is sure to be in it.
constexpr double kLeastRadius = 1e-9;

std::vector<Parameter> region_parameters() {
  return {
      {"radius", ParameterKind::length, "0.1", "geodesic radius of a region", "", kLeastRadius},
      choice_parameter(
          "region", RegionOptions{}.shape,
          "disc: within the radius; support: vertices with 95 % of the component's energy"),
      {"coverage",
       ParameterKind::number,
       {},
       "take the strongest regions until they hold this share of the motion energy",
       "",
       1e-9,
       1},
  };
}

Positions read_rest(const std::string& text, const MeshSequence& sequence) {
  Positions rest = read_mesh(text).positions;
  if (rest.rows() != sequence.vertices()) {
    throw MismatchError(text + ": " + std::to_string(rest.rows()) + " vertices, expected " +
                        std::to_string(sequence.vertices()) + " as in the sequence");
  }
  return rest;
}

std::vector<RigidTransform> read_motion(const std::string& path, int frames) {
  std::vector<RigidTransform> motion;
  try {
    const Json json = Json::parse(read_file(path));
    for (const Json& entry : json.at("result").at("motion")) motion.push_back(transform_of(entry));
  } catch (const Json::exception&) {
    throw IoError(path, "expected the manifest of an align run with result.motion");
  } catch (const std::invalid_argument& error) {
    throw IoError(path, "motion of frame " + std::to_string(motion.size()) + ": " + error.what());
  }
  if (static_cast<int>(motion.size()) != frames) {
    throw MismatchError(path + ": " + std::to_string(motion.size()) +
                        " rigid transforms, expected " + std::to_string(frames) +
                        ", one per frame of the sequence");
  }
  return motion;
}

SupportRange support_range(const Parameters& parameters, double unit) {
  const SupportRange range = {parameters.length("d-min", unit), parameters.length("d-max", unit)};
  if (range.d_min < range.d_max) return range;
  throw UsageError("--d-min: expected less than --d-max, found " + parameters.text("d-min") +
                   " and " + parameters.text("d-max"));
}

HeadMotionSource alignment_of(const Invocation& invocation, const SequenceRead& read) {
  if (const auto text = invocation.parameters.optional_text("align")) {
    if (const auto fitted = choice_of<HeadMotion>(*text)) return *fitted;
    return std::filesystem::path(*text);
  }
  const bool still =
      read.model_driven || read.sequence.rest_is_known() || read.sequence.frames() == 1;
  return still ? HeadMotion::none : HeadMotion::stable;
}

Alignment without_motion(const Invocation& invocation, const SequenceRead& read,
                         const MeshSequence& sequence) {
  const HeadMotionSource source = alignment_of(invocation, read);
  if (const auto* manifest = std::get_if<std::filesystem::path>(&source)) {
    return align(sequence, read_motion(manifest->string(), sequence.frames()));
  }
  switch (std::get<HeadMotion>(source)) {
    case HeadMotion::stable:
      return align(sequence, {.vertices = AlignmentVertices::stable});
    case HeadMotion::all:
      return align(sequence, {.vertices = AlignmentVertices::all});
    case HeadMotion::none:
      break;
  }
  return {sequence, {}};
}

Analysis analyse(const Invocation& invocation, const SequenceRead& read,
                 const MeshSequence& sequence, int count, const Progress& progress) {
  const Stopwatch stopwatch;
  const Parameters& parameters = invocation.parameters;
  const MeshSequence work = with_decomposition_rest(parameters, sequence);
  if (count > work.vertices()) {
    throw MismatchError("-k: " + std::to_string(count) + " components asked for, the mesh has " +
                        std::to_string(work.vertices()) + " vertices");
  }
  warn_of_parting(invocation, work);
  SurfaceDistances distances = distances_on(invocation, work.rest(), work.triangles());
  DecompositionOptions options;
  const bool reference = parameters.choice<Compatibility>("compat") == Compatibility::splocs2013;
  const double unit = reference ? largest_frame_extent(read.sequence) : work.extent();
  options.count = count;
  const SupportRange range = support_range(parameters, unit);
  options.d_min = range.d_min;
  options.d_max = range.d_max;
  options.sparsity = parameters.number("sparsity");
  options.rho = parameters.number("rho");
  options.iterations = parameters.integer("iterations");
  options.admm_iterations = parameters.integer("admm-iterations");
  options.tolerance = reference ? 0 : parameters.number("tolerance");
  options.nonnegative = !parameters.flag("signed");
  options.sign_rule = reference ? SignRule::literal : SignRule::amplitude;
  options.precision = parameters.choice<IterationPrecision>("precision");
  options.basis_tolerance = parameters.number("basis-tolerance");
  options.distances = distances;
  options.threads = invocation.threads;
  options.progress = progress;
  Components components = decompose(work, options);
  return {std::move(components), std::move(distances), stopwatch.seconds()};
}

Output components_output() {
  return {"components-out", DataKind::components,
          "the components (.h5), for later runs with --components", true};
}

Analysis analysis_for(const Invocation& invocation, const SequenceRead& read) {
  const Components* given = invocation.find<Components>("components");
  if (!given) {
    const Alignment still = without_motion(invocation, read, read.sequence);
    return analyse(invocation, read, still.sequence, invocation.parameters.integer("k"),
                   invocation.progress);
  }
  if (given->weights.size() == 0) {
    throw MismatchError(invocation.inputs.at("components").front().name +
                        ": holds no weights W, without which regions have no motion energy; "
                        "decompose the sequence again");
  }
  if (given->vertices() != read.sequence.vertices() ||
      given->triangles.rows() != read.sequence.triangles().rows() ||
      given->triangles != read.sequence.triangles()) {
    throw MismatchError(invocation.inputs.at("components").front().name + ": components of " +
                        std::to_string(given->vertices()) +
                        " vertices with other triangles than the sequence, which has " +
                        std::to_string(read.sequence.vertices()) + " vertices");
  }
  if (std::ranges::all_of(given->centers, [](VertexIndex center) { return center < 0; })) {
    throw MismatchError(invocation.inputs.at("components").front().name +
                        ": no component moves a vertex, so that there is no region");
  }
  return {*given, distances_on(invocation, given->rest, given->triangles), 0};
}

Regions regions_of(const Invocation& invocation, const Analysis& analysis) {
  const Parameters& parameters = invocation.parameters;
  RegionOptions options;
  options.radius = parameters.length("radius", extent(analysis.components.rest));
  options.shape = parameters.choice<RegionShape>("region");
  options.coverage = parameters.optional_number("coverage");
  options.distances = analysis.distances;
  Regions regions = find_regions(analysis.components, options);
  for (const std::string& note : regions.notes) invocation.warn(note);
  return regions;
}

Json report_of(const Regions& regions) {
  Json list = Json::array();
  for (const Region& region : regions.regions) {
    list.push_back({{"center", region.center},
                    {"radius", region.radius},
                    {"vertices", region.vertices.size()},
                    {"energy_share", region.energy_share},
                    {"component", region.component}});
  }
  return {{"regions", list},
          {"vertices", regions.vertex_count()},
          {"triangles", regions.triangles.size()},
          {"vertex_share", regions.vertex_share()},
          {"triangle_share", regions.triangle_share()},
          {"energy_share", regions.energy_share},
          {"notes", regions.notes}};
}

std::string summary_of(const Regions& regions) {
  return std::to_string(regions.regions.size()) + " regions hold " +
         std::to_string(regions.vertex_count()) + " vertices (" + percent(regions.vertex_share()) +
         "), " + std::to_string(regions.triangles.size()) + " triangles (" +
         percent(regions.triangle_share()) + ") and " + percent(regions.energy_share) +
         " of the motion energy\n";
}

}  // namespace mimetra
