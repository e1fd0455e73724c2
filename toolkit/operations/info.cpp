#include <sstream>

#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/mesh/inspection.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/operations/reports.h"
#include "toolkit/operations/toolkit_operations.h"

namespace mimetra {

namespace {

/// Reports the connected parts, in the order of the numbers for --only and --without.
Json json_of(const SurfaceParts& parts) {
  std::vector<int> vertices(parts.count(), 0);
  for (const int part : parts.of_vertex) ++vertices[part];
  Json list = Json::array();
  for (int part = 0; part < parts.count(); ++part) {
    list.push_back({{"vertices", vertices[part]}, {"share", parts.share(part)}});
  }
  return list;
}

/// Lists the first parts' shares of the surface: "97.1 %, 1.2 %, ...".
std::string shares_of(const SurfaceParts& parts) {
  std::vector<std::string> shares;
  shares.reserve(static_cast<std::size_t>(parts.count()));
  for (int part = 0; part < parts.count(); ++part) shares.push_back(percent(parts.share(part)));
  return listed(shares);
}

const char* place_of(Field::Location location) {
  return location == Field::Location::vertices ? "vertices" : "faces";
}

Json json_of(const std::vector<Field>& fields) {
  Json list = Json::array();
  for (const Field& field : fields) {
    list.push_back(
        {{"name", field.name}, {"on", place_of(field.location)}, {"numbers", field.values.cols()}});
  }
  return list;
}

/// Lists the first names: "region, roi on vertices; in_L on faces".
std::string names_of(const std::vector<Field>& fields) {
  std::vector<std::string> places;
  for (const auto location : {Field::Location::vertices, Field::Location::triangles}) {
    std::vector<std::string> names;
    for (const Field& field : fields) {
      if (field.location == location) names.push_back(field.name);
    }
    if (!names.empty()) places.push_back(listed(names) + " on " + place_of(location));
  }
  return joined(places, "; ");
}

Json report_of(const FrameSource& sequence, const MeshReport& mesh, const SurfaceParts& parts,
               double motion) {
  return {{"frames", sequence.frames()},
          {"vertices", mesh.vertices},
          {"faces", mesh.faces},
          {"triangles", mesh.triangles},
          {"components", mesh.components},
          {"boundary_edges", mesh.boundary_edges},
          {"nonmanifold_edges", mesh.nonmanifold_edges},
          {"inconsistent_edges", mesh.inconsistent_edges},
          {"degenerate_triangles", mesh.degenerate_triangles.size()},
          {"vertices_without_face", mesh.vertices_without_face.size()},
          {"welded_vertices", mesh.welded_vertices},
          {"components_after_welding", mesh.components_after_welding},
          {"surface_components", json_of(parts)},
          {"boundary_edges_after_welding", mesh.boundary_edges_after_welding},
          {"extent", {mesh.extent[0], mesh.extent[1], mesh.extent[2]}},
          {"motion", motion},
          {"rest_known", sequence.rest_is_known()},
          {"times_known", sequence.times_are_known()},
          {"seconds", seconds(sequence)}};
}

std::string summary_of(const FrameSource& sequence, const MeshReport& mesh,
                       const SurfaceParts& parts, double motion) {
  std::ostringstream text;
  text << "frames      " << sequence.frames() << " (" << times_text(sequence) << ")\n"
       << "vertices    " << mesh.vertices << ", " << mesh.welded_vertices
       << " of them at the place of another\n"
       << "faces       " << mesh.faces << " (" << mesh.triangles << " triangles)\n"
       << "components  " << mesh.components << ", welded " << mesh.components_after_welding
       << ", by surface " << shares_of(parts) << '\n'
       << "edges       " << mesh.boundary_edges << " boundary, welded "
       << mesh.boundary_edges_after_welding << "; " << mesh.nonmanifold_edges << " non-manifold, "
       << mesh.inconsistent_edges << " wound against each other\n"
       << "defects     " << mesh.degenerate_triangles.size() << " degenerate triangles, "
       << mesh.vertices_without_face.size() << " vertices without face\n"
       << "extent      " << readable(mesh.extent[0]) << " x " << readable(mesh.extent[1]) << " x "
       << readable(mesh.extent[2]) << '\n'
       << "motion      " << readable(motion) << " (RMS distance from the rest pose: "
       << (sequence.rest_is_known() ? "the neutral" : "the first frame") << ")\n";
  return text.str();
}

}  // namespace

Operation info_operation() {
  Operation operation;
  operation.name = "info";
  operation.summary = "What a sequence is made of: frames, vertices, faces, defects";
  operation.inputs = {{"sequence", DataKind::sequence, "sequence to look at"}};
  operation.inputs.front().streamed = operation.inputs.front().fields = true;
  operation.examples = {"info takes/smile_%04d.obj", "info actor/ --weights take.csv --json"};
  operation.run = [](const Invocation& invocation) {
    const FieldSequence& shown = invocation.get<FieldSequence>("sequence");
    const FrameSource& sequence = *shown.frames;
    const MeshReport mesh = inspect(sequence.rest(), sequence.connectivity());
    const SurfaceParts parts = surface_parts(sequence.rest(), sequence.triangles());
    const double moved = motion(sequence, invocation.context);
    Json report = report_of(sequence, mesh, parts, moved);
    std::string summary = summary_of(sequence, mesh, parts, moved);
    if (!shown.fields.empty()) {
      report["fields"] = json_of(shown.fields);
      summary += "fields      " + names_of(shown.fields) + '\n';
    }
    return Outcome{{}, json_text(report), summary};
  };
  return operation;
}

}  // namespace mimetra
