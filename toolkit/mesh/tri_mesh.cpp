#include <algorithm>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {
namespace {

void check_polygons(int vertices, const Polygons& polygons) {
  if (polygons.offsets.empty() || polygons.offsets.front() != 0 ||
      polygons.offsets.back() != static_cast<int>(polygons.corners.size()) ||
      !std::is_sorted(polygons.offsets.begin(), polygons.offsets.end())) {
    throw std::invalid_argument("polygon offsets must rise from 0 to the number of corners, " +
                                std::to_string(polygons.corners.size()));
  }
  for (int face = 0; face < polygons.size(); ++face) {
    const int first = polygons.offsets[face], last = polygons.offsets[face + 1];
    if (last - first < 3) {
      throw std::invalid_argument("face " + std::to_string(face) + " has " +
                                  std::to_string(last - first) + " corners, expected at least 3");
    }
    for (int corner = first; corner < last; ++corner) {
      const int vertex = polygons.corners[corner];
      if (vertex < 0 || vertex >= vertices) {
        throw std::invalid_argument("face " + std::to_string(face) + " uses vertex " +
                                    std::to_string(vertex) + ", expected 0 to " +
                                    std::to_string(vertices - 1));
      }
    }
  }
}

bool same_up_to_rotation(const int* a, const int* b, int corners) {
  for (int shift = 0; shift < corners; ++shift) {
    if (std::equal(a + shift, a + corners, b) && std::equal(a, a + shift, b + corners - shift)) {
      return true;
    }
  }
  return corners == 0;
}

bool same_face(const Polygons& a, const Polygons& b, int face) {
  const int corners = a.offsets[face + 1] - a.offsets[face];
  if (corners != b.offsets[face + 1] - b.offsets[face]) return false;
  return same_up_to_rotation(a.corners.data() + a.offsets[face], b.corners.data() + b.offsets[face],
                             corners);
}

using Words = std::vector<std::string>;

/// Keywords of a kind. Each has its own state: `o` does not end what `g` began.
std::vector<std::string_view> keywords(FaceGroupKind kind) {
  if (kind == FaceGroupKind::material) return {"usemtl"};
  return {"g", "o"};
}

/// Names after the keyword: each word for groups, the whole text with spaces for materials.
Words names_in(const std::string& statement, const std::string& keyword, FaceGroupKind kind) {
  std::istringstream rest(statement.substr(keyword.size()));
  Words words{std::istream_iterator<std::string>(rest), {}};
  if (kind == FaceGroupKind::group || words.empty()) return words;
  return {statement.substr(keyword.size() + 1)};
}

void add_face(std::vector<NamedFaces>& named, const std::string& name, int face) {
  auto found = std::ranges::find(named, name, &NamedFaces::name);
  if (found == named.end()) found = named.insert(found, {name, {}});
  if (found->faces.empty() || found->faces.back() != face) found->faces.push_back(face);
}

}  // namespace

Connectivity Connectivity::from_polygons(int vertices, Polygons polygons) {
  check_polygons(vertices, polygons);
  Connectivity result;
  result.vertices = vertices;
  // A polygon with c corners gives c - 2 triangles.
  const auto triangles = static_cast<int>(polygons.corners.size()) - 2 * polygons.size();
  result.triangles.resize(triangles, 3);
  result.polygon_of_triangle.reserve(triangles);
  for (int face = 0; face < polygons.size(); ++face) {
    const int first = polygons.offsets[face];
    for (int corner = first + 1; corner + 1 < polygons.offsets[face + 1]; ++corner) {
      result.triangles.row(static_cast<int>(result.polygon_of_triangle.size()))
          << polygons.corners[first],
          polygons.corners[corner], polygons.corners[corner + 1];
      result.polygon_of_triangle.push_back(face);
    }
  }
  result.polygons = std::move(polygons);
  return result;
}

Connectivity Connectivity::from_triangles(int vertices, const Triangles& triangles) {
  Polygons polygons;
  polygons.corners.assign(triangles.data(), triangles.data() + triangles.size());
  polygons.offsets.resize(triangles.rows() + 1);
  for (std::size_t face = 0; face < polygons.offsets.size(); ++face) {
    polygons.offsets[face] = static_cast<int>(3 * face);
  }
  return from_polygons(vertices, std::move(polygons));
}

bool same_faces(const Connectivity& a, const Connectivity& b) {
  return a.vertices == b.vertices && first_different_face(a, b) == -1;
}

int first_different_face(const Connectivity& a, const Connectivity& b) {
  const int common = std::min(a.polygons.size(), b.polygons.size());
  for (int face = 0; face < common; ++face) {
    if (!same_face(a.polygons, b.polygons, face)) return face;
  }
  return a.polygons.size() == b.polygons.size() ? -1 : common;
}

std::vector<VertexIndex> used_vertices(const Triangles& triangles, Eigen::Index vertices) {
  std::vector<bool> is_used(static_cast<std::size_t>(vertices), triangles.rows() == 0);
  for (const VertexIndex vertex : triangles.reshaped()) is_used[vertex] = true;
  std::vector<VertexIndex> used;
  for (VertexIndex v = 0; v < vertices; ++v) {
    if (is_used[v]) used.push_back(v);
  }
  return used;
}

bool has_texture(const Connectivity& connectivity) {
  const TextureCoordinates& texture = connectivity.texture;
  return !texture.coordinates.empty() &&
         std::ranges::any_of(texture.corners, [](int coordinates) { return coordinates >= 0; });
}

bool is_textured_by_vertex(const Connectivity& connectivity) {
  const TextureCoordinates& texture = connectivity.texture;
  return static_cast<int>(texture.coordinates.size()) == connectivity.vertices &&
         texture.corners == connectivity.polygons.corners;
}

std::optional<std::vector<Eigen::Vector2d>> texture_of_vertices(const Connectivity& connectivity) {
  const TextureCoordinates& texture = connectivity.texture;
  if (!has_texture(connectivity)) return std::nullopt;
  const auto vertices = static_cast<std::size_t>(connectivity.vertices);
  std::vector<Eigen::Vector2d> of_vertices(vertices, Eigen::Vector2d::Zero());
  std::vector<char> is_known(vertices, 0);
  for (std::size_t corner = 0; corner < texture.corners.size(); ++corner) {
    if (texture.corners[corner] < 0) continue;
    const auto vertex = static_cast<std::size_t>(connectivity.polygons.corners[corner]);
    const Eigen::Vector2d& found =
        texture.coordinates[static_cast<std::size_t>(texture.corners[corner])];
    if (is_known[vertex] && of_vertices[vertex] != found) return std::nullopt;
    of_vertices[vertex] = found;
    is_known[vertex] = 1;
  }
  return of_vertices;
}

std::vector<NamedFaces> named_faces(const Connectivity& connectivity, FaceGroupKind kind) {
  const std::vector<std::string_view> known = keywords(kind);
  std::vector<Words> current(known.size());
  std::vector<NamedFaces> named;
  auto group = connectivity.groups.begin();
  for (int face = 0; face < connectivity.polygons.size(); ++face) {
    for (; group != connectivity.groups.end() && group->first_face <= face; ++group) {
      const std::string keyword = group->statement.substr(0, group->statement.find(' '));
      const auto place = std::ranges::find(known, keyword);
      if (place == known.end()) continue;
      current[place - known.begin()] = names_in(group->statement, keyword, kind);
    }
    for (const Words& names : current) {
      for (const std::string& name : names) add_face(named, name, face);
    }
  }
  return named;
}

Eigen::Index first_unusable(const Positions& positions) {
  for (Eigen::Index v = 0; v < positions.rows(); ++v) {
    for (const double value : positions.row(v)) {
      if (!is_coordinate(value)) return v;
    }
  }
  return -1;
}

}  // namespace mimetra
