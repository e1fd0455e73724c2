#include "plugins/meshlab/layers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <vcg/complex/algorithms/update/color.h>
#include <vcg/complex/append.h>

namespace mimetra_meshlab {

namespace {

using Corner = std::pair<std::int32_t, std::int32_t>;  // from vertex, to vertex

std::int32_t vertex_of(const CMeshO& mesh, const CFaceO& face, int corner) {
  return static_cast<std::int32_t>(face.cV(corner % 3) - mesh.vert.data());
}

Corner edge_of(const CMeshO& mesh, const CFaceO& face, int edge) {
  return {vertex_of(mesh, face, edge), vertex_of(mesh, face, edge + 1)};
}

/// First triangle of each triangle's polygon.
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

/// Vertices around triangles, starting at the first vertex of the first triangle. Empty if the
/// outer edges are not one loop that visits each vertex once.
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

/// Appends the faces of a mesh without deleted elements. Triangles whose common edges MeshLab marks
/// as faux form a polygon, which begins with the first vertex of its first triangle. Triangles that
/// do not form a simple polygon stay triangles.
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

/// Adds polygons as fans of triangles with faux inner edges.
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

const vcg::Color4b kOutside(200, 200, 200, 255);

std::string label_of(const MeshModel& layer) {
  return "layer '" + layer.label().toStdString() + "'";
}

void append_positions(const MeshModel& layer, Frames& frames) {
  const Matrix44m& placed = layer.cm.Tr;
  Matrix44m identity;
  identity.SetIdentity();
  const bool moved = !(placed == identity);
  for (const CVertexO& vertex : layer.cm.vert) {
    for (int row = 0; row < 3; ++row) {
      double value = vertex.cP()[row];
      if (moved) {
        value = placed.ElementAt(row, 3);
        for (int k = 0; k < 3; ++k) {
          value += static_cast<double>(placed.ElementAt(row, k)) * vertex.cP()[k];
        }
      }
      frames.positions.push_back(value);
    }
  }
}

/// Corners of all polygons, each rotated so that its smallest vertex comes first.
std::vector<std::int32_t> turned_corners(const Frames& frames) {
  std::vector<std::int32_t> corners = frames.corners;
  auto begin = corners.begin();
  for (const std::int32_t size : frames.face_sizes) {
    std::rotate(begin, std::min_element(begin, begin + size), begin + size);
    begin += size;
  }
  return corners;
}

/// Index of the first polygon that differs; the number of polygons if none differs.
std::size_t first_difference(const Frames& a, const Frames& b) {
  const std::vector<std::int32_t> a_corners = turned_corners(a);
  const std::vector<std::int32_t> b_corners = turned_corners(b);
  std::size_t begin = 0;
  for (std::size_t face = 0; face < a.face_sizes.size(); ++face) {
    const std::size_t end = begin + a.face_sizes[face];
    const bool same =
        a.face_sizes[face] == b.face_sizes[face] &&
        std::equal(a_corners.begin() + begin, a_corners.begin() + end, b_corners.begin() + begin);
    if (!same) return face;
    begin = end;
  }
  return a.face_sizes.size();
}

void set_quality(MeshModel& layer, const std::vector<double>& values) {
  if (values.size() != layer.cm.vert.size()) {
    throw Failure(label_of(layer) + ": has " + std::to_string(layer.cm.vert.size()) +
                  " vertices, expected " + std::to_string(values.size()) + " as in the result");
  }
  layer.updateDataMask(MeshModel::MM_VERTQUALITY);
  for (std::size_t i = 0; i < values.size(); ++i) {
    layer.cm.vert[i].Q() = static_cast<float>(values[i]);
  }
}

std::string counted(const std::string& what, std::size_t found, std::size_t expected) {
  return ": " + std::to_string(found) + ' ' + what + ", expected " + std::to_string(expected) +
         " as in ";
}

}  // namespace

std::vector<MeshModel*> visible_layers(MeshDocument& document, const MeshModel* left_out) {
  std::vector<MeshModel*> layers;
  for (MeshModel* layer : document.meshList) {
    if (!layer->isVisible() || layer == left_out) continue;
    vcg::tri::Allocator<CMeshO>::CompactEveryVector(layer->cm);
    layers.push_back(layer);
  }
  return layers;
}

Frames frames_of(const std::vector<MeshModel*>& layers) {
  Frames sequence;
  for (const MeshModel* layer : layers) {
    Frames frame;
    frame.count = 1;
    frame.vertices = static_cast<std::int64_t>(layer->cm.vert.size());
    append_faces(layer->cm, frame);
    if (frame.face_sizes.empty()) {
      throw Failure(label_of(*layer) + " has no faces; hide it, or choose a surface");
    }
    append_positions(*layer, frame);
    if (sequence.count == 0) {
      sequence = std::move(frame);
      continue;
    }
    check_same_faces(frame, label_of(*layer), sequence, label_of(*layers.front()));
    sequence.positions.insert(sequence.positions.end(), frame.positions.begin(),
                              frame.positions.end());
    ++sequence.count;
  }
  return sequence;
}

void check_same_faces(const Frames& found, const std::string& found_name, const Frames& expected,
                      const std::string& expected_name) {
  const std::string remedy = expected_name + "; hide layers that belong to another mesh";
  if (found.vertices != expected.vertices) {
    throw Failure(found_name + counted("vertices", found.vertices, expected.vertices) + remedy);
  }
  if (found.face_sizes.size() != expected.face_sizes.size()) {
    throw Failure(found_name +
                  counted("faces", found.face_sizes.size(), expected.face_sizes.size()) + remedy);
  }
  const std::size_t face = first_difference(found, expected);
  if (face < found.face_sizes.size()) {
    throw Failure(found_name + ": face " + std::to_string(face) + " is not that of " + remedy);
  }
}

bool have_same_faces(const Frames& a, const Frames& b) {
  return a.vertices == b.vertices && a.face_sizes == b.face_sizes && a.corners == b.corners;
}

void show_values(MeshModel& layer, const std::vector<double>& values) {
  std::vector<double> numbers = values;
  // MeshLab's colours and histograms need finite numbers.
  for (double& value : numbers) value = std::isfinite(value) ? value : -1;
  set_quality(layer, numbers);
  layer.updateDataMask(MeshModel::MM_VERTCOLOR);
  vcg::tri::UpdateColor<CMeshO>::PerVertexQualityRamp(layer.cm);
}

void show_regions(MeshModel& layer, const std::vector<double>& region) {
  set_quality(layer, region);
  layer.updateDataMask(MeshModel::MM_VERTCOLOR);
  const int count = static_cast<int>(*std::max_element(region.begin(), region.end())) + 1;
  for (std::size_t i = 0; i < region.size(); ++i) {
    CVertexO& vertex = layer.cm.vert[i];
    const int index = static_cast<int>(region[i]);
    vertex.C() = index < 0 ? kOutside : vcg::Color4b::Scatter(count, index, 0.6f, 0.95f);
    if (index < 0) {
      vertex.ClearS();
    } else {
      vertex.SetS();
    }
  }
  vcg::tri::UpdateSelection<CMeshO>::FaceFromVertexLoose(layer.cm);
}

MeshModel& add_layer(MeshDocument& document, const std::string& label, const Frames& frames,
                     std::int64_t frame, MeshModel* base) {
  const bool keeps_current = false;
  MeshModel& layer = *document.addNewMesh("", QString::fromStdString(label), keeps_current);
  if (base) {
    layer.updateDataMask(base);
    vcg::tri::Append<CMeshO, CMeshO>::Mesh(layer.cm, base->cm);
    layer.cm.textures = base->cm.textures;
  } else {
    layer.updateDataMask(MeshModel::MM_POLYGONAL);
    vcg::tri::Allocator<CMeshO>::AddVertices(layer.cm, frames.vertices);
    add_polygons(frames, layer.cm);
  }
  const double* position = frames.positions.data() + frame * frames.vertices * 3;
  for (CVertexO& vertex : layer.cm.vert) {
    for (int k = 0; k < 3; ++k) vertex.P()[k] = static_cast<float>(*position++);
  }
  layer.UpdateBoxAndNormals();
  document.setVisible(layer.id(), false);
  return layer;
}

}  // namespace mimetra_meshlab
