#include <algorithm>
#include <compare>
#include <numeric>
#include <utility>

#include "geodesic/glued_surface.h"

namespace mimetra::geodesic {
namespace {

int next_in_triangle(int halfedge) {
  return halfedge % 3 == 2 ? halfedge - 2 : halfedge + 1;
}

VertexIndex corner_vertex(const Triangles& triangles, int halfedge) {
  return triangles(halfedge / 3, halfedge % 3);
}

bool same_direction(const Triangles& triangles, int a, int b) {
  return corner_vertex(triangles, a) == corner_vertex(triangles, b);
}

/// The other half-edge of each edge that exactly two triangles share; -1 elsewhere.
std::vector<int> partners(const Triangles& triangles) {
  struct Side {
    VertexIndex low, high;
    int halfedge;
    auto operator<=>(const Side&) const = default;
  };
  std::vector<Side> sides;
  sides.reserve(triangles.size());
  for (int h = 0; h < triangles.size(); ++h) {
    const auto [low, high] =
        std::minmax({corner_vertex(triangles, h), corner_vertex(triangles, next_in_triangle(h))});
    sides.push_back({low, high, h});
  }
  std::sort(sides.begin(), sides.end());
  std::vector<int> partner(triangles.size(), -1);
  for (auto first = sides.begin(); first != sides.end();) {
    const auto last = std::find_if(first, sides.end(), [&](const Side& side) {
      return side.low != first->low || side.high != first->high;
    });
    if (last - first == 2) {
      partner[first[0].halfedge] = first[1].halfedge;
      partner[first[1].halfedge] = first[0].halfedge;
    }
    first = last;
  }
  return partner;
}

/// Which triangles must be turned so that neighbours run the same way round; the lowest triangle
/// of each patch stays as it is.
std::vector<char> turned_triangles(const Triangles& triangles, const std::vector<int>& partner) {
  std::vector<char> turned(triangles.rows(), 0), seen(triangles.rows(), 0);
  std::vector<int> open;
  for (int seed = 0; seed < triangles.rows(); ++seed) {
    if (seen[seed]) continue;
    seen[seed] = 1;
    open.assign(1, seed);
    // Nearest first, so that the seam of a one-sided surface is short.
    for (std::size_t next = 0; next < open.size(); ++next) {
      const int t = open[next];
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        if (partner[h] < 0 || seen[partner[h] / 3]) continue;
        const int neighbor = partner[h] / 3;
        turned[neighbor] = turned[t] != same_direction(triangles, h, partner[h]);
        seen[neighbor] = 1;
        open.push_back(neighbor);
      }
    }
  }
  return turned;
}

/// `halfedge` after its triangle has exchanged corners 1 and 2.
int turned_halfedge(int halfedge) {
  return halfedge - halfedge % 3 + (2 - halfedge % 3);
}

/// Turns triangles and renames the partners' half-edges.
void orient(Triangles& triangles, std::vector<int>& partner) {
  const std::vector<char> turned = turned_triangles(triangles, partner);
  const auto renamed = [&](int h) { return turned[h / 3] ? turned_halfedge(h) : h; };
  std::vector<int> result(partner.size(), -1);
  for (int h = 0; h < static_cast<int>(partner.size()); ++h) {
    if (partner[h] >= 0) result[renamed(h)] = renamed(partner[h]);
  }
  partner = std::move(result);
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    if (turned[t]) std::swap(triangles(t, 1), triangles(t, 2));
  }
}

/// Lowest corner that is the same vertex of the surface, for each corner.
std::vector<int> joined_corners(const std::vector<int>& twin) {
  std::vector<int> parent(twin.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int corner) {
    while (parent[corner] != corner) corner = parent[corner] = parent[parent[corner]];
    return corner;
  };
  const auto join = [&](int a, int b) {
    const auto [low, high] = std::minmax({root(a), root(b)});
    parent[high] = low;
  };
  for (int h = 0; h < static_cast<int>(twin.size()); ++h) {
    if (twin[h] < 0) continue;
    join(h, next_in_triangle(twin[h]));
    join(next_in_triangle(h), twin[h]);
  }
  for (int& corner : parent) corner = root(corner);
  return parent;
}

}  // namespace

GluedSurface glued(Eigen::Index vertices, const Triangles& triangles) {
  GluedSurface surface{triangles, partners(triangles), {}};
  orient(surface.triangles, surface.twin);
  for (int h = 0; h < static_cast<int>(surface.twin.size()); ++h) {
    const int twin = surface.twin[h];
    // What still runs the same way closes a one-sided surface: both sides become border.
    if (twin >= 0 && same_direction(surface.triangles, h, twin)) {
      surface.twin[h] = surface.twin[twin] = -1;
    }
  }
  const std::vector<int> joined = joined_corners(surface.twin);
  std::vector<std::vector<int>> corners_of(vertices);
  for (int h = 0; h < static_cast<int>(joined.size()); ++h) {
    if (joined[h] == h) corners_of[corner_vertex(surface.triangles, h)].push_back(h);
  }
  std::vector<VertexIndex> number(joined.size(), -1);
  for (VertexIndex vertex = 0; vertex < vertices; ++vertex) {
    for (const int corner : corners_of[vertex]) {
      number[corner] = static_cast<VertexIndex>(surface.vertex.size());
      surface.vertex.push_back(vertex);
    }
  }
  for (int h = 0; h < static_cast<int>(joined.size()); ++h) {
    surface.triangles(h / 3, h % 3) = number[joined[h]];
  }
  return surface;
}

}  // namespace mimetra::geodesic
