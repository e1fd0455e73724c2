#include "toolkit/mesh/surface.h"

#include <algorithm>
#include <compare>
#include <functional>
#include <numeric>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/disjoint_sets.h"

namespace mimetra {
namespace {

void check_indices(int vertices, std::span<const VertexIndex> corners,
                   const std::vector<int>& offsets) {
  const auto is_outside = [vertices](VertexIndex v) { return v < 0 || v >= vertices; };
  const auto outside = std::ranges::find_if(corners, is_outside);
  if (outside == corners.end()) return;
  const auto corner = static_cast<int>(outside - corners.begin());
  const auto face = std::ranges::upper_bound(offsets, corner) - offsets.begin() - 1;
  throw std::invalid_argument("face " + std::to_string(face) + " uses vertex " +
                              std::to_string(*outside) + ", expected 0 to " +
                              std::to_string(vertices - 1));
}

/// Faces that repeat a vertex, ascending; empty if collapsed faces are kept.
std::vector<int> left_out_of(std::span<const VertexIndex> corners, const std::vector<int>& offsets,
                             Collapsed collapsed) {
  std::vector<int> faces;
  if (collapsed == Collapsed::kept) return faces;
  std::vector<VertexIndex> around;
  for (std::size_t face = 0; face + 1 < offsets.size(); ++face) {
    around.assign(corners.begin() + offsets[face], corners.begin() + offsets[face + 1]);
    std::ranges::sort(around);
    if (std::ranges::adjacent_find(around) != around.end()) faces.push_back(static_cast<int>(face));
  }
  return faces;
}

/// Corners of faces, face after face. Corner c also denotes the side from it to the next corner.
class Corners {
 public:
  Corners(std::vector<VertexIndex> vertex, std::vector<int> offsets)
      : vertex_(std::move(vertex)), offsets_(std::move(offsets)), face_(vertex_.size()) {
    for (int face = 0; face < faces(); ++face) {
      std::fill(face_.begin() + first(face), face_.begin() + first(face + 1), face);
    }
  }

  int count() const { return static_cast<int>(vertex_.size()); }
  int faces() const { return static_cast<int>(offsets_.size()) - 1; }
  int first(int face) const { return offsets_[at(face)]; }
  int face(int c) const { return face_[at(c)]; }
  VertexIndex from(int c) const { return vertex_[at(c)]; }
  VertexIndex to(int c) const { return vertex_[at(next(c))]; }
  int next(int c) const { return c + 1 < first(face(c) + 1) ? c + 1 : first(face(c)); }
  int previous(int c) const { return c > first(face(c)) ? c - 1 : first(face(c) + 1) - 1; }

  /// Reverses the winding of a face, keeping its first corner.
  void turn(int face) {
    std::reverse(vertex_.begin() + first(face) + 1, vertex_.begin() + first(face + 1));
  }
  /// Number of side `c` after its face is turned.
  int turned(int c) const { return first(face(c)) + first(face(c) + 1) - 1 - c; }

 private:
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  std::vector<VertexIndex> vertex_;
  std::vector<int> offsets_, face_;
};

/// Opposite side of each side whose edge exactly two faces share; -1 for other sides.
std::vector<int> twins_of(const EdgeSides& edges, int sides) {
  std::vector<int> twin(static_cast<std::size_t>(sides), -1);
  edges.for_each_edge([&twin](std::span<const int> sides_of_edge) {
    if (sides_of_edge.size() != 2) return;
    const int a = sides_of_edge[0], b = sides_of_edge[1];
    twin[static_cast<std::size_t>(a)] = b;
    twin[static_cast<std::size_t>(b)] = a;
  });
  return twin;
}

/// Faces that must be turned so that neighbours are wound the same way. The lowest face of each
/// connected set is not turned.
std::vector<int> faces_to_turn(const Corners& corners, const std::vector<int>& twin) {
  const auto faces = static_cast<std::size_t>(corners.faces());
  std::vector<bool> is_turned(faces, false), seen(faces, false);
  std::vector<int> open;
  for (int seed = 0; seed < corners.faces(); ++seed) {
    if (seen[static_cast<std::size_t>(seed)]) continue;
    seen[static_cast<std::size_t>(seed)] = true;
    open.assign(1, seed);
    // Breadth first, so that the seam of a one-sided surface is short.
    for (std::size_t next = 0; next < open.size(); ++next) {
      const int face = open[next];
      for (int c = corners.first(face); c < corners.first(face + 1); ++c) {
        const int across = twin[static_cast<std::size_t>(c)];
        if (across < 0) continue;
        const auto neighbor = static_cast<std::size_t>(corners.face(across));
        if (seen[neighbor]) continue;
        const bool same_way = corners.from(c) == corners.from(across);
        is_turned[neighbor] = is_turned[static_cast<std::size_t>(face)] != same_way;
        seen[neighbor] = true;
        open.push_back(static_cast<int>(neighbor));
      }
    }
  }
  std::vector<int> turned;
  for (std::size_t face = 0; face < faces; ++face) {
    if (is_turned[face]) turned.push_back(static_cast<int>(face));
  }
  return turned;
}

/// Turns faces and renumbers the sides in `twin`. Twins that still run the same way would close a
/// one-sided surface and are separated.
void orient(Corners& corners, const std::vector<int>& turned, std::vector<int>& twin) {
  std::vector<bool> is_turned(static_cast<std::size_t>(corners.faces()), false);
  for (const int face : turned) {
    is_turned[static_cast<std::size_t>(face)] = true;
    corners.turn(face);
  }
  const auto renamed = [&](int c) {
    return is_turned[static_cast<std::size_t>(corners.face(c))] ? corners.turned(c) : c;
  };
  std::vector<int> oriented(twin.size(), -1);
  for (int c = 0; c < corners.count(); ++c) {
    const int across = twin[static_cast<std::size_t>(c)];
    if (across < 0) continue;
    const int side = renamed(c), other = renamed(across);
    if (corners.from(side) != corners.from(other)) oriented[static_cast<std::size_t>(side)] = other;
  }
  twin = std::move(oriented);
}

/// For each corner, the lowest corner at the same vertex of the surface.
std::vector<int> joined_corners(const Corners& corners, const std::vector<int>& twin) {
  DisjointSets sets(corners.count());
  for (int c = 0; c < corners.count(); ++c) {
    const int across = twin[static_cast<std::size_t>(c)];
    if (across >= 0) sets.join(c, corners.next(across));
  }
  std::vector<int> lowest(twin.size());
  for (int c = 0; c < corners.count(); ++c) {
    lowest[static_cast<std::size_t>(c)] = sets.lowest(c);
  }
  return lowest;
}

/// Vertices of the surface, including copies.
struct Copies {
  std::vector<int> of_corner;       ///< vertex of the surface at each corner
  std::vector<VertexIndex> copied;  ///< given vertex of each copy
};

/// Numbers the surface's vertices: the first at each given vertex keeps its number, further ones
/// are copies.
Copies numbered(int vertices, const Corners& corners, const std::vector<int>& lowest,
                const std::vector<int>& left_out) {
  std::vector<bool> is_out(static_cast<std::size_t>(corners.faces()), false);
  for (const int face : left_out) is_out[static_cast<std::size_t>(face)] = true;
  std::vector<bool> is_taken(static_cast<std::size_t>(vertices), false);
  std::vector<std::pair<VertexIndex, int>> others;  // given vertex and lowest corner
  Copies copies{std::vector<int>(lowest.size(), -1), {}};
  for (int c = 0; c < corners.count(); ++c) {
    if (is_out[static_cast<std::size_t>(corners.face(c))]) continue;
    if (lowest[static_cast<std::size_t>(c)] != c) continue;
    const VertexIndex vertex = corners.from(c);
    if (is_taken[static_cast<std::size_t>(vertex)]) {
      others.emplace_back(vertex, c);
    } else {
      copies.of_corner[static_cast<std::size_t>(c)] = vertex;
      is_taken[static_cast<std::size_t>(vertex)] = true;
    }
  }
  std::ranges::sort(others);
  for (const auto& [vertex, corner] : others) {
    copies.of_corner[static_cast<std::size_t>(corner)] =
        vertices + static_cast<int>(copies.copied.size());
    copies.copied.push_back(vertex);
  }
  for (std::size_t c = 0; c < lowest.size(); ++c) {
    copies.of_corner[c] = copies.of_corner[static_cast<std::size_t>(lowest[c])];
  }
  return copies;
}

using VertexHandle = OpenMesh::VertexHandle;
using HalfedgeHandle = OpenMesh::HalfedgeHandle;

/// Fills OpenMesh's kernel item by item, because add_face() refuses two edges between the same
/// vertices.
class HalfEdgeBuilder {
 public:
  HalfEdgeBuilder(const Corners& corners, const std::vector<int>& twin,
                  const std::vector<int>& vertex_of_corner, Surface::HalfEdges& mesh)
      : corners_(corners),
        twin_(twin),
        vertex_(vertex_of_corner),
        mesh_(mesh),
        handle_(twin.size()) {}

  void build(int vertices, const std::vector<int>& left_out) {
    mesh_.reserve(static_cast<std::size_t>(vertices), twin_.size() / 2 + twin_.size() / 16,
                  static_cast<std::size_t>(corners_.faces()));
    for (int v = 0; v < vertices; ++v) mesh_.new_vertex();
    for (int c = 0; c < corners_.count(); ++c) {
      if (vertex(c).is_valid() && !handle(c).is_valid()) add_edge(c);
    }
    if (!left_out.empty()) mesh_.request_face_status();
    for (int face = 0; face < corners_.faces(); ++face) add_face(face);
    for (int c = 0; c < corners_.count(); ++c) {
      if (vertex(c).is_valid() && twin(c) < 0) close_border(c);
    }
  }

 private:
  int twin(int c) const { return twin_[static_cast<std::size_t>(c)]; }
  VertexHandle vertex(int c) const { return VertexHandle(vertex_[static_cast<std::size_t>(c)]); }
  HalfedgeHandle& handle(int c) { return handle_[static_cast<std::size_t>(c)]; }

  void add_edge(int c) {
    handle(c) = mesh_.new_edge(vertex(c), vertex(corners_.next(c)));
    if (twin(c) >= 0) handle(twin(c)) = mesh_.opposite_halfedge_handle(handle(c));
  }

  void add_face(int number) {
    const OpenMesh::FaceHandle face = mesh_.new_face();
    const int first = corners_.first(number);
    if (!vertex(first).is_valid()) {
      mesh_.status(face).set_deleted(true);
      return;
    }
    mesh_.set_halfedge_handle(face, handle(first));
    for (int c = first; c < corners_.first(number + 1); ++c) {
      mesh_.set_face_handle(handle(c), face);
      mesh_.set_next_halfedge_handle(handle(c), handle(corners_.next(c)));
      mesh_.set_halfedge_handle(vertex(c), handle(c));
    }
  }

  /// Links the half-edge opposite to side `c`, which has no face, to the next one along the border.
  void close_border(int c) {
    // Turn about the vertex where the side starts, up to the other border of its fan.
    int last = corners_.previous(c);
    while (twin(last) >= 0) last = corners_.previous(twin(last));
    const HalfedgeHandle border = mesh_.opposite_halfedge_handle(handle(last));
    mesh_.set_next_halfedge_handle(mesh_.opposite_halfedge_handle(handle(c)), border);
    // OpenMesh expects a border vertex to refer to its outgoing half-edge along the border.
    mesh_.set_halfedge_handle(vertex(c), border);
  }

  const Corners& corners_;
  const std::vector<int>& twin_;
  const std::vector<int>& vertex_;  // -1 in left-out faces
  Surface::HalfEdges& mesh_;
  std::vector<HalfedgeHandle> handle_;
};

std::span<const VertexIndex> corners_of(const Triangles& triangles) {
  return {triangles.data(), static_cast<std::size_t>(triangles.size())};
}

std::vector<int> offsets_of(const Triangles& triangles) {
  std::vector<int> offsets(static_cast<std::size_t>(triangles.rows()) + 1);
  for (std::size_t t = 0; t < offsets.size(); ++t) offsets[t] = 3 * static_cast<int>(t);
  return offsets;
}

}  // namespace

EdgeSides::EdgeSides(int vertices, const Triangles& triangles, Collapsed collapsed)
    : EdgeSides(vertices, corners_of(triangles), offsets_of(triangles),
                left_out_of(corners_of(triangles), offsets_of(triangles), collapsed)) {}

EdgeSides::EdgeSides(int vertices, const Polygons& polygons, Collapsed collapsed)
    : EdgeSides(vertices, polygons.corners, polygons.offsets,
                left_out_of(polygons.corners, polygons.offsets, collapsed)) {}

EdgeSides::EdgeSides(int vertices, std::span<const VertexIndex> corners,
                     const std::vector<int>& offsets, const std::vector<int>& left_out) {
  check_indices(vertices, corners, offsets);
  // Counting sort of the sides by their lower vertex.
  struct Side {
    VertexIndex high;
    int corner;
    auto operator<=>(const Side&) const = default;
  };
  const auto for_each_side = [&](const auto& use) {
    auto skipped = left_out.begin();
    for (int face = 0; face + 1 < std::ssize(offsets); ++face) {
      if (skipped != left_out.end() && *skipped == face) {
        ++skipped;
        continue;
      }
      const int first = offsets[static_cast<std::size_t>(face)];
      const int end = offsets[static_cast<std::size_t>(face) + 1];
      for (int c = first; c < end; ++c) {
        const auto [low, high] =
            std::minmax(corners[static_cast<std::size_t>(c)],
                        corners[static_cast<std::size_t>(c + 1 < end ? c + 1 : first)]);
        if (low != high) use(static_cast<std::size_t>(low), Side{high, c});
      }
    }
  };
  std::vector<std::size_t> end_of(static_cast<std::size_t>(vertices) + 1, 0);
  for_each_side([&end_of](std::size_t low, const Side&) { ++end_of[low + 1]; });
  std::partial_sum(end_of.begin(), end_of.end(), end_of.begin());
  std::vector<Side> sides(end_of.back());
  for_each_side([&](std::size_t low, const Side& side) { sides[end_of[low]++] = side; });

  sides_.reserve(sides.size());
  std::size_t i = 0;
  for (int low = 0; low < vertices; ++low) {
    const std::size_t first = i, end = end_of[static_cast<std::size_t>(low)];
    std::sort(sides.begin() + static_cast<std::ptrdiff_t>(first),
              sides.begin() + static_cast<std::ptrdiff_t>(end));
    for (; i < end; ++i) {
      if (i == first || sides[i].high != sides[i - 1].high) {
        first_of_edge_.push_back(static_cast<int>(i));
      }
      sides_.push_back(sides[i].corner);
    }
  }
  first_of_edge_.push_back(static_cast<int>(sides.size()));
}

Surface::Surface(int vertices, const Triangles& triangles)
    : Surface(vertices, {corners_of(triangles).begin(), corners_of(triangles).end()},
              offsets_of(triangles)) {}

Surface::Surface(int vertices, const Polygons& polygons)
    : Surface(vertices, polygons.corners, polygons.offsets) {}

Surface::Surface(const Triangles& triangles, const Weld& weld)
    : Surface(static_cast<int>(weld.representative.size()), weld.welded(triangles)) {}

Surface::Surface(int vertices, std::vector<VertexIndex> vertex_of_corner, std::vector<int> offsets)
    : vertices_(vertices) {
  left_out_ = left_out_of(vertex_of_corner, offsets, Collapsed::left_out);
  const EdgeSides edges(vertices, vertex_of_corner, offsets, left_out_);
  Corners corners(std::move(vertex_of_corner), std::move(offsets));
  std::vector<int> twin = twins_of(edges, corners.count());
  turned_ = faces_to_turn(corners, twin);
  orient(corners, turned_, twin);
  const Copies copies = numbered(vertices, corners, joined_corners(corners, twin), left_out_);
  HalfEdgeBuilder(corners, twin, copies.of_corner, half_edges_)
      .build(vertices + static_cast<int>(copies.copied.size()), left_out_);
  copied_ = copies.copied;
}

VertexIndex Surface::vertex_of(OpenMesh::VertexHandle vertex) const {
  if (vertex.idx() < vertices_) return vertex.idx();
  return copied_[static_cast<std::size_t>(vertex.idx() - vertices_)];
}

std::vector<OpenMesh::VertexHandle> Surface::copies_of(VertexIndex vertex) const {
  std::vector<OpenMesh::VertexHandle> copies = {VertexHandle(vertex)};
  const auto [first, last] = std::equal_range(copied_.begin(), copied_.end(), vertex);
  for (auto copy = first; copy != last; ++copy) {
    copies.emplace_back(vertices_ + static_cast<int>(copy - copied_.begin()));
  }
  return copies;
}

std::vector<VertexIndex> Surface::neighbors(VertexIndex vertex) const {
  std::vector<VertexIndex> neighbors;
  for (const auto copy : copies_of(vertex)) {
    for (const auto neighbor : half_edges_.vv_range(copy)) {
      neighbors.push_back(vertex_of(neighbor));
    }
  }
  std::ranges::sort(neighbors);
  neighbors.erase(std::unique(neighbors.begin(), neighbors.end()), neighbors.end());
  return neighbors;
}

std::map<VertexIndex, double> within_reach(const Surface& surface, const Positions& positions,
                                           double reach, const std::vector<VertexIndex>& from) {
  using Front = std::pair<double, VertexIndex>;
  std::priority_queue<Front, std::vector<Front>, std::greater<>> fronts;
  for (const VertexIndex v : from) fronts.emplace(0, v);
  std::map<VertexIndex, double> distances;
  while (!fronts.empty()) {
    const auto [distance, vertex] = fronts.top();
    fronts.pop();
    if (!distances.try_emplace(vertex, distance).second) continue;
    for (const VertexIndex to : surface.neighbors(vertex)) {
      const double there = distance + (positions.row(vertex) - positions.row(to)).norm();
      if (there <= reach && !distances.contains(to)) fronts.emplace(there, to);
    }
  }
  return distances;
}

double longest_edge(const Surface& surface, const Positions& positions, VertexIndex vertex) {
  double longest = 0;
  for (const VertexIndex to : surface.neighbors(vertex)) {
    longest = std::max(longest, (positions.row(vertex) - positions.row(to)).norm());
  }
  return longest;
}

ConnectedComponents connected_components(int vertices, const Triangles& triangles) {
  return connected_components(triangles, Weld::none(vertices));
}

ConnectedComponents connected_components(const Triangles& triangles, const Weld& weld) {
  const auto vertices = static_cast<int>(weld.representative.size());
  check_indices(vertices, corners_of(triangles), offsets_of(triangles));
  DisjointSets sets(vertices);
  for (VertexIndex v = 0; v < vertices; ++v) {
    sets.join(v, weld.representative.at(static_cast<std::size_t>(v)));
  }
  for (const auto& triangle : triangles.rowwise()) {
    sets.join(triangle[0], triangle[1]);
    sets.join(triangle[1], triangle[2]);
  }
  ConnectedComponents components;
  components.of_vertex.reserve(weld.representative.size());
  for (VertexIndex v = 0; v < vertices; ++v) {
    const int lowest = sets.lowest(v);
    components.of_vertex.push_back(
        lowest == v ? components.count++ : components.of_vertex[static_cast<std::size_t>(lowest)]);
  }
  return components;
}

}  // namespace mimetra
