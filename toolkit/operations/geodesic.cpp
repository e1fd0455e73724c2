#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "geodesic/support_map.h"
#include "toolkit/io/json_text.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/option_words.h"
#include "toolkit/operations/pipeline_parameters.h"
#include "toolkit/operations/this_process.h"
#include "toolkit/operations/toolkit_operations.h"
#include "toolkit/pipeline/analysis.h"

namespace mimetra {

namespace {

struct GeodesicCall {
  /// Vertices from which distances are measured.
  std::vector<int> sources = {0};
  /// Distances between which the support map rises.
  Length d_min = AnalysisOptions{}.d_min;
  Length d_max = AnalysisOptions{}.d_max;
  DistanceOptions distances = {};

  static constexpr Option kSources{"sources", &GeodesicCall::sources, {.minimum = 0}};
  static constexpr Option kMinimum{"d_min", &GeodesicCall::d_min};
  static constexpr Option kMaximum{"d_max", &GeodesicCall::d_max};
};

BoundParameters<GeodesicCall> geodesic_parameters() {
  BoundParameters<GeodesicCall> list;
  return list.add("source", GeodesicCall::kSources, "vertices to measure from, 0-based")
      .add("d-min", GeodesicCall::kMinimum, "distance up to which the support map is 0")
      .add("d-max", GeodesicCall::kMaximum, "distance from which the support map is 1")
      .add(&GeodesicCall::distances, distance_parameters());
}

/// Distance to the nearest of the sources. Throws MismatchError for a source without a triangle.
Eigen::VectorXd nearest(const SurfaceDistances& distances, const std::vector<int>& sources,
                        int vertices) {
  Eigen::VectorXd result =
      Eigen::VectorXd::Constant(vertices, std::numeric_limits<double>::infinity());
  for (const int source : sources) {
    if (source >= vertices) {
      throw MismatchError("--source: vertex " + std::to_string(source) + ", the mesh has " +
                          std::to_string(vertices) + " (0-based)");
    }
    const auto& faceless = distances.vertices_without_face();
    if (std::ranges::find(faceless, source) != faceless.end()) {
      throw MismatchError("--source: vertex " + std::to_string(source) +
                          " belongs to no triangle with area; choose another");
    }
    result = result.cwiseMin(distances(source));
  }
  return result;
}

bool is_exact(const Invocation& invocation) {
  return invocation.parameters.choice<GeodesicMethod>("geodesics") == GeodesicMethod::exact;
}

double memory_of_geodesic(const Invocation& invocation) {
  const int vertices = invocation.sequence("mesh").vertices();
  return is_exact(invocation)
             ? distance_bytes(GeodesicMethod::exact, vertices, 1, invocation.context)
             : kHeatBytesPerVertex * vertices;
}

/// Throws if the mesh has no size, or if exact distances need more memory than is left.
void check_mesh(const Invocation& invocation, const MeshSequence& mesh) {
  const std::string& name = invocation.input("mesh").name;
  if (mesh.diameter() == 0) {
    throw IoError(name, "has no size: all vertices of its faces are at one place");
  }
  const double bytes = memory_of_geodesic(invocation), left = available_memory();
  if (bytes <= left || !is_exact(invocation)) return;
  throw MismatchError(name + ": exact distances along " + std::to_string(mesh.vertices()) +
                      " vertices take about " + fixed(std::ceil(bytes / 1e6), 0) + " MB, and " +
                      fixed(std::floor(left / 1e6), 0) +
                      " MB are left on this machine; use --geodesics heat");
}

Outcome run_geodesic(const Invocation& invocation) {
  const MeshSequence& sequence = invocation.sequence("mesh");
  const GeodesicCall call = geodesic_parameters().read(invocation.parameters);
  const MeshSequence mesh = sequence.slice(0, 1).with_rest(sequence.frame(0));
  check_mesh(invocation, mesh);
  const SupportRange range = in_command_terms(invocation.parameters, [&] {
    return support_range(call.d_min, call.d_max, mesh.diameter());
  });
  const SurfaceDistances distances =
      distances_along(mesh.rest(), mesh.triangles(), call.distances, invocation.context.part(0, 0));
  const Eigen::VectorXd distance = nearest(distances, call.sources, mesh.vertices());
  const Eigen::VectorXd support = geodesic::support_map(distance, range.d_min, range.d_max);
  int reached = 0;
  double farthest = 0;
  Eigen::VectorXd shown = distance;
  for (double& value : shown) {
    if (std::isfinite(value)) {
      ++reached;
      farthest = std::max(farthest, value);
    } else {
      value = std::numeric_limits<double>::quiet_NaN();  // infinity would spoil the colour range
    }
  }
  Outcome outcome;
  FieldSequence fields(mesh, {{"distance", Field::Location::vertices, shown},
                              {"support", Field::Location::vertices, support}});
  outcome.outputs["out"].push_back({"", std::move(fields)});
  outcome.report =
      json_text(Json{{"vertices", mesh.vertices()}, {"reached", reached}, {"farthest", farthest}});
  outcome.summary = std::to_string(reached) + " of " + std::to_string(mesh.vertices()) +
                    " vertices reached, the farthest at " + readable(farthest) + '\n';
  return outcome;
}

}  // namespace

Operation geodesic_operation() {
  Operation operation;
  operation.name = "geodesic";
  operation.summary = "Distances along a mesh from a vertex, and the support map around it";
  operation.inputs = {{"mesh", DataKind::sequence, "mesh, or the first frame of a sequence"}};
  operation.outputs = {
      {"out", DataKind::sequence, "the mesh with the fields distance and support"}};
  operation.outputs.front().fields = true;
  operation.parameters = geodesic_parameters().declared();
  operation.examples = {"geodesic neutral.obj --source 1200 -o nose.vtp",
                        "geodesic neutral.obj --source 1200 --geodesics exact -o exact.vtp"};
  operation.run = run_geodesic;
  operation.memory = memory_of_geodesic;
  return operation;
}

}  // namespace mimetra
