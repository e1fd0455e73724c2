#include "plugins/meshlab/polygons.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace mimetra_meshlab {

namespace {

using Corner = std::pair<std::int32_t, std::int32_t>;  // from vertex, to vertex

std::int32_t vertex_of(const CMeshO& mesh, const CFaceO& face, int corner) {
  return static_cast<std::int32_t>(face.cV(corner % 3) - mesh.vert.data());
}

Corner edge_of(const CMeshO& mesh, const CFaceO& face, int edge) {
  return {vertex_of(mesh, face, edge), vertex_of(mesh, face, edge + 1)};
}

/// The first triangle of each triangle's polygon.
std::vector<int> first_triangles(const CMeshO& mesh) {
  std::vector<int> first(mesh.face.size());
  std::iota(first.begin(), first.end(), 0);
  const auto root = [&first](int face) {
    while (first[face] != face) face = first[face] = first[first[face]];
    return face;
  };
  std::map<Corner, int> faux;
  for (std::size_t i = 0; i < mesh.face.size(); ++i) {
    for (int edge = 0; edge < 3; ++edge) {
      if (mesh.face[i].IsF(edge)) faux[edge_of(mesh, mesh.face[i], edge)] = static_cast<int>(i);
    }
  }
  for (const auto& half : faux) {
    const auto other = faux.find({half.first.second, half.first.first});
    if (other == faux.end()) continue;
    const int a = root(half.second);
    const int b = root(other->second);
    first[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = root(static_cast<int>(i));
  return first;
}

/// The vertices around triangles, from the first vertex of the first; empty where the triangles'
/// outer edges are not one loop without a vertex twice.
std::vector<std::int32_t> outline(const CMeshO& mesh, const std::vector<int>& triangles) {
  std::map<std::int32_t, std::int32_t> next;
  std::size_t outer = 0;
  std::map<Corner, int> inner;
  for (const int face : triangles) {
    for (int edge = 0; edge < 3; ++edge) ++inner[edge_of(mesh, mesh.face[face], edge)];
  }
  for (const auto& edge : inner) {
    if (inner.count({edge.first.second, edge.first.first})) continue;
    next[edge.first.first] = edge.first.second;
    ++outer;
  }
  std::vector<std::int32_t> loop;
  const std::int32_t start = vertex_of(mesh, mesh.face[triangles.front()], 0);
  for (std::int32_t v = start; loop.size() <= outer;) {
    const auto step = next.find(v);
    if (step == next.end()) return {};
    loop.push_back(v);
    v = step->second;
    if (v == start) break;
  }
  const bool whole = loop.size() == outer && outer == triangles.size() + 2;
  return whole ? loop : std::vector<std::int32_t>();
}

}  // namespace

void append_faces(const CMeshO& mesh, Frames& frames) {
  const std::vector<int> first = first_triangles(mesh);
  std::vector<std::vector<int>> members(mesh.face.size());
  for (std::size_t i = 0; i < first.size(); ++i) members[first[i]].push_back(static_cast<int>(i));
  const auto append = [&frames](const std::vector<std::int32_t>& polygon) {
    frames.face_sizes.push_back(static_cast<std::int32_t>(polygon.size()));
    frames.corners.insert(frames.corners.end(), polygon.begin(), polygon.end());
  };
  for (const std::vector<int>& triangles : members) {
    if (triangles.empty()) continue;
    if (triangles.size() > 1) {
      const std::vector<std::int32_t> polygon = outline(mesh, triangles);
      if (!polygon.empty()) {
        append(polygon);
        continue;
      }
    }
    for (const int face : triangles) {
      append({vertex_of(mesh, mesh.face[face], 0), vertex_of(mesh, mesh.face[face], 1),
              vertex_of(mesh, mesh.face[face], 2)});
    }
  }
}

void add_polygons(const Frames& frames, CMeshO& mesh) {
  std::size_t begin = 0;
  for (const std::int32_t size : frames.face_sizes) {
    const std::int32_t* corner = frames.corners.data() + begin;
    for (int i = 1; i + 1 < size; ++i) {
      const bool is_flat =
          corner[0] == corner[i] || corner[i] == corner[i + 1] || corner[i + 1] == corner[0];
      if (is_flat) continue;  // as MeshLab does when it reads a file
      const auto face =
          vcg::tri::Allocator<CMeshO>::AddFace(mesh, corner[0], corner[i], corner[i + 1]);
      if (i > 1) face->SetF(0);
      if (i + 2 < size) face->SetF(2);
    }
    begin += size;
  }
}

}  // namespace mimetra_meshlab
