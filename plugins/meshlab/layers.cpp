#include "plugins/meshlab/layers.h"

#include <algorithm>
#include <cmath>

#include <vcg/complex/algorithms/update/color.h>
#include <vcg/complex/append.h>

#include "plugins/meshlab/polygons.h"

namespace mimetra_meshlab {

namespace {

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

/// Polygons, each turned so that its smallest vertex comes first.
std::vector<std::int32_t> turned_corners(const Frames& frames) {
  std::vector<std::int32_t> corners = frames.corners;
  auto begin = corners.begin();
  for (const std::int32_t size : frames.face_sizes) {
    std::rotate(begin, std::min_element(begin, begin + size), begin + size);
    begin += size;
  }
  return corners;
}

/// The first polygon that differs; the number of polygons where none does.
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
  // MeshLab's colours and histograms need numbers.
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
