#include "toolkit/operations/parameter_files.h"

#include <algorithm>
#include <array>
#include <sstream>

#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "toolkit/io/json_text.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/regions_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/face_order.h"
#include "toolkit/mesh/surface_parts.h"
#include "toolkit/mesh/text.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

namespace {

/// Manifests keep all digits. The tolerance admits rotations that were typed, or rounded by other
/// tools.
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

Positions read_rest(const std::string& path, const FrameSource& sequence) {
  TriMesh rest = read_mesh(path);
  if (rest.positions.rows() != sequence.vertices()) {
    throw MismatchError(path + ": " + std::to_string(rest.positions.rows()) +
                        " vertices, expected " + std::to_string(sequence.vertices()) +
                        " as in the sequence");
  }
  const Connectivity& faces = sequence.connectivity();
  if (rest.connectivity.triangles.rows() > 0 && !same_faces(faces, rest.connectivity) &&
      !in_order_of(faces, rest.connectivity)) {
    throw MismatchError(
        path + ": face " + std::to_string(first_different_face(faces, rest.connectivity)) +
        " has other vertices than in the sequence; check --match compares the numbering, "
        "convert --match renumbers");
  }
  return std::move(rest.positions);
}

std::vector<VertexIndex> spread_vertices(int vertices) {
  std::vector<VertexIndex> spread(8);
  for (std::size_t i = 0; i < spread.size(); ++i) {
    spread[i] = static_cast<VertexIndex>(static_cast<long long>(i) * (vertices - 1) / 7);
  }
  return spread;
}

KeptMotion read_motion(const std::string& path, int frames) {
  KeptMotion kept;
  try {
    const Json json = read_json(path, "the manifest of an align run with result.motion");
    const Json& result = json.at("result");
    for (const Json& entry : result.at("motion")) kept.transforms.push_back(transform_of(entry));
    if (result.contains("extent")) {
      const auto extent = result["extent"].get<std::array<double, 3>>();
      kept.extent = Eigen::Vector3d(extent.data());
    }
    if (result.contains("places")) {
      kept.vertices = result.at("vertices").get<int>();
      const auto places = result["places"].get<std::array<std::array<double, 3>, 8>>();
      kept.places = Eigen::Map<const Positions>(places.front().data(), 8, 3);
    }
  } catch (const Json::exception&) {
    throw IoError(path,
                  "expected the manifest of an align run with result.motion and result.extent");
  } catch (const std::invalid_argument& error) {
    throw IoError(
        path, "motion of frame " + std::to_string(kept.transforms.size()) + ": " + error.what());
  }
  if (std::ssize(kept.transforms) != frames) {
    throw MismatchError(path + ": " + std::to_string(kept.transforms.size()) +
                        " rigid transforms, expected " + std::to_string(frames) +
                        ", one per frame of the sequence");
  }
  return kept;
}

namespace {

/// How a text describes a set of vertices, apart from a file.
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

/// Vertices with a name, such as the vertices of a group.
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

namespace {

/// Text of a value as on the command line.
std::string typed(const Json& value) {
  return value.is_string() ? value.get<std::string>() : json_text(value);
}

/// Joins values by commas, such as [10, 30] and ["a.txt", "b.txt"].
std::string listed_values(const Json& values) {
  std::string text;
  for (const Json& value : values) text += (text.empty() ? "" : ",") + typed(value);
  return text;
}

}  // namespace

void set_from_file(const std::string& path, Parameters& parameters) {
  const Json options = read_json(path);
  if (!options.is_object()) throw IoError(path, "expected an object of option names and values");
  for (const auto& [name, value] : options.items()) {
    const Parameter* parameter = parameters.find(name);
    if (!parameter) {
      throw UsageError(path + ": '" + name +
                       "' is no parameter of the operation; `mimetra operations` lists them, all "
                       "else is said on the command line");
    }
    const std::string text = value.is_array() ? listed_values(value) : typed(value);
    try {
      parameters.set(name, parse_value(*parameter, text));
    } catch (const UsageError& error) {
      throw UsageError(path + ": " + error.what());
    }
  }
}

}  // namespace mimetra
