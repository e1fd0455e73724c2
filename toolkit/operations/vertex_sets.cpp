#include "toolkit/operations/vertex_sets.h"

#include <algorithm>
#include <sstream>

#include "toolkit/io/regions_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/face_groups.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

/// What a set of vertices is named by, besides a file.
enum class VertexSetKind { component, group, material, field };

constexpr std::string_view choice_name(VertexSetKind value) {
  switch (value) {
    case VertexSetKind::component:
      return "component";
    case VertexSetKind::group:
      return "group";
    case VertexSetKind::material:
      return "material";
    case VertexSetKind::field:
      return "field";
  }
  return {};
}

/// Vertices under a name, such as those of a group.
struct NamedVertices {
  std::string name;
  std::vector<bool> vertices;
};

std::vector<NamedVertices> components_of(const FrameSource& frames) {
  const SurfaceParts parts = surface_parts(frames.rest(), frames.triangles());
  std::vector<NamedVertices> sets;
  sets.reserve(static_cast<std::size_t>(parts.count()));
  for (int part = 0; part < parts.count(); ++part) {
    sets.push_back({std::to_string(part), std::vector<bool>(frames.vertices(), false)});
  }
  for (VertexIndex v = 0; v < frames.vertices(); ++v) sets[parts.of_vertex[v]].vertices[v] = true;
  return sets;
}

std::vector<NamedVertices> groups_of(const Connectivity& connectivity, FaceGroupKind kind) {
  std::vector<NamedVertices> sets;
  for (const NamedFaces& named : named_faces(connectivity, kind)) {
    std::vector<bool> inside(connectivity.vertices, false);
    const Polygons& polygons = connectivity.polygons;
    for (const int face : named.faces) {
      for (int c = polygons.offsets[face]; c < polygons.offsets[face + 1]; ++c) {
        inside[polygons.corners[c]] = true;
      }
    }
    sets.push_back({named.name, std::move(inside)});
  }
  return sets;
}

std::vector<NamedVertices> fields_of(const std::vector<Field>& fields) {
  std::vector<NamedVertices> sets;
  for (const Field& field : fields) {
    if (field.location != Field::Location::vertices) continue;
    std::vector<bool> inside;
    for (const auto& row : field.values.rowwise()) inside.push_back((row.array() != 0).any());
    sets.push_back({field.name, std::move(inside)});
  }
  return sets;
}

std::vector<NamedVertices> sets_of(VertexSetKind kind, const FieldSequence& sequence) {
  switch (kind) {
    case VertexSetKind::component:
      return components_of(*sequence.frames);
    case VertexSetKind::group:
      return groups_of(sequence.frames->connectivity(), FaceGroupKind::group);
    case VertexSetKind::material:
      return groups_of(sequence.frames->connectivity(), FaceGroupKind::material);
    case VertexSetKind::field:
      break;
  }
  return fields_of(sequence.fields);
}

std::string names_of(const std::vector<NamedVertices>& sets) {
  std::vector<std::string> names;
  names.reserve(sets.size());
  for (const NamedVertices& set : sets) names.push_back(set.name);
  constexpr std::size_t kShown = 40;
  return listed(names, kShown);
}

}  // namespace

Parameter vertex_set_parameter(std::string name, std::string help) {
  Parameter parameter{std::move(name), ParameterKind::file, {}, std::move(help)};
  for (const VertexSetKind kind : choices<VertexSetKind>()) {
    parameter.choices.push_back(std::string(choice_name(kind)) +
                                (kind == VertexSetKind::component ? ":N" : ":NAME"));
  }
  return parameter;
}

std::vector<bool> named_vertices(const std::string& text, const FieldSequence& sequence) {
  const FrameSource& frames = *sequence.frames;
  const std::size_t colon = text.find(':');
  const auto kind = choice_of<VertexSetKind>(text.substr(0, colon));
  if (colon == std::string::npos || !kind) {
    return read_regions(text, frames.vertices(), frames.triangles()).inside;
  }
  const std::vector<NamedVertices> sets = sets_of(*kind, sequence);
  std::vector<bool> inside(frames.vertices(), false);
  std::istringstream names(text.substr(colon + 1));
  for (std::string name; std::getline(names, name, ',');) {
    const auto found = std::ranges::find(sets, name, &NamedVertices::name);
    if (found == sets.end()) {
      throw MismatchError(
          std::string(choice_name(*kind)) + " '" + name + "' is not there" +
          (sets.empty() ? "; the sequence has none" : "; there are " + names_of(sets)));
    }
    for (std::size_t v = 0; v < inside.size(); ++v) {
      if (found->vertices[v]) inside[v] = true;
    }
  }
  return inside;
}

}  // namespace mimetra
