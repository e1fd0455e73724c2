#include <algorithm>
#include <iterator>
#include <span>
#include <stdexcept>
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

Eigen::Vector3d box_sides(const Eigen::Ref<const Positions>& positions) {
  if (positions.rows() == 0) return Eigen::Vector3d::Zero();
  return (positions.colwise().maxCoeff() - positions.colwise().minCoeff()).transpose();
}

}  // namespace

Connectivity Connectivity::from_polygons(int vertices, Polygons polygons) {
  check_polygons(vertices, polygons);
  Connectivity result;
  result.vertices = vertices;
  // A polygon of c corners gives c - 2 triangles.
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

namespace {

std::span<const int> corners_of(const Polygons& polygons, int face) {
  const auto first = static_cast<std::size_t>(polygons.offsets[std::size_t(face)]);
  const auto last = static_cast<std::size_t>(polygons.offsets[std::size_t(face) + 1]);
  return std::span(polygons.corners).subspan(first, last - first);
}

/// How a polygon lies in another that has all of its corners.
enum class Lies { apart, straight, turned };

bool has_repeated(std::span<const int> corners) {
  std::vector<int> sorted(corners.begin(), corners.end());
  std::ranges::sort(sorted);
  return std::ranges::adjacent_find(sorted) != sorted.end();
}

/// One that has a corner twice lies in its like only.
Lies lies_in(std::span<const int> whole, std::span<const int> part) {
  if (has_repeated(part)) {
    return std::ranges::is_permutation(whole, part) ? Lies::straight : Lies::apart;
  }
  std::vector<std::ptrdiff_t> places;
  places.reserve(part.size());
  for (const int corner : part) {
    const auto place = std::ranges::find(whole, corner);
    if (place == whole.end()) return Lies::apart;
    places.push_back(place - whole.begin());
  }
  // Around the whole once, either way.
  int falls = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[(i + 1) % places.size()] < places[i]) ++falls;
  }
  if (falls == 1) return Lies::straight;
  return falls + 1 == static_cast<int>(places.size()) ? Lies::turned : Lies::apart;
}

/// Polygons of one mesh in those of a coarser one, or of one that has the same.
struct Split {
  std::vector<int> whole;               ///< for each polygon of the finer mesh, the one it lies in
  std::vector<bool> is_turned;          ///< for each polygon of the coarser, its parts against it
  std::vector<std::vector<int>> parts;  ///< of each polygon of the coarser, ascending
};

/// None unless every polygon of `coarse` is one of `fine` or cut into several, wound all alike, and
/// no polygon is there twice.
std::optional<Split> split_of(const Polygons& coarse, const Polygons& fine, int vertices) {
  const auto wholes = static_cast<std::size_t>(coarse.size());
  Split split{{}, std::vector<bool>(wholes, false), std::vector<std::vector<int>>(wholes)};
  split.whole.reserve(static_cast<std::size_t>(fine.size()));
  std::vector<std::vector<int>> around(static_cast<std::size_t>(vertices));
  for (int face = 0; face < coarse.size(); ++face) {
    for (const int corner : corners_of(coarse, face)) {
      std::vector<int>& faces = around[std::size_t(corner)];
      if (faces.empty() || faces.back() != face) faces.push_back(face);
    }
  }
  for (int face = 0; face < fine.size(); ++face) {
    const auto part = corners_of(fine, face);
    std::optional<int> found;
    Lies lies = Lies::apart;
    for (const int whole : around[std::size_t(part.front())]) {
      const Lies here = lies_in(corners_of(coarse, whole), part);
      if (here == Lies::apart) continue;
      if (found) return {};
      found = whole;
      lies = here;
    }
    if (!found) return {};
    std::vector<int>& parts = split.parts[std::size_t(*found)];
    const bool is_turned = lies == Lies::turned;
    if (!parts.empty() && split.is_turned[std::size_t(*found)] != is_turned) return {};
    split.is_turned[std::size_t(*found)] = is_turned;
    parts.push_back(face);
    split.whole.push_back(*found);
  }
  for (int whole = 0; whole < coarse.size(); ++whole) {
    // A polygon of c corners is worth c - 2 triangles.
    std::ptrdiff_t missing = std::ssize(corners_of(coarse, whole)) - 2;
    for (const int part : split.parts[std::size_t(whole)]) {
      missing -= std::ssize(corners_of(fine, part)) - 2;
    }
    if (missing != 0) return {};
  }
  return split;
}

/// The one of several polygons that has the most of a triangle's corners; the first such.
int nearest_to(const Triangles& triangles, Eigen::Index t, const Polygons& polygons,
               const std::vector<int>& parts) {
  const auto shared = [&](int part) {
    const auto corners = corners_of(polygons, part);
    return std::ranges::count_if(triangles.row(t),
                                 [&](int v) { return std::ranges::count(corners, v) > 0; });
  };
  return *std::ranges::max_element(parts, {}, shared);
}

}  // namespace

std::optional<Connectivity> in_order_of(const Connectivity& reference, const Connectivity& mesh) {
  if (reference.vertices != mesh.vertices) return {};
  const bool is_finer = mesh.polygons.size() > reference.polygons.size();
  const std::optional<Split> split =
      is_finer ? split_of(reference.polygons, mesh.polygons, mesh.vertices)
               : split_of(mesh.polygons, reference.polygons, mesh.vertices);
  if (!split) return {};
  Connectivity ordered = mesh;
  ordered.triangles = reference.triangles;
  for (Eigen::Index t = 0; t < ordered.triangles.rows(); ++t) {
    const int known = reference.polygon_of_triangle[std::size_t(t)];
    const int whole = is_finer ? known : split->whole[std::size_t(known)];
    ordered.polygon_of_triangle[std::size_t(t)] =
        is_finer
            ? nearest_to(reference.triangles, t, mesh.polygons, split->parts[std::size_t(whole)])
            : whole;
    if (split->is_turned[std::size_t(whole)]) {
      std::swap(ordered.triangles(t, 1), ordered.triangles(t, 2));
    }
  }
  return ordered;
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

double extent(const Eigen::Ref<const Positions>& positions) {
  return box_sides(positions).maxCoeff();
}

double box_diagonal(const Eigen::Ref<const Positions>& positions) {
  return box_sides(positions).norm();
}

}  // namespace mimetra
