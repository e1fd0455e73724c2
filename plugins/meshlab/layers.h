#pragma once

#include <string>
#include <vector>

#include <common/meshmodel.h>

#include "plugins/meshlab/toolkit.h"

/// MeshLab's layers as sequences, and results as layers.
namespace mimetra_meshlab {

/// The visible layers in their order, but `left_out`. They lose what was marked as deleted.
std::vector<MeshModel*> visible_layers(MeshDocument& document, const MeshModel* left_out = nullptr);

/// One frame a layer, placed by the layers' matrices. Triangles that MeshLab joins to polygons are
/// these polygons. Throws Failure that names the first layer without faces, or with others than the
/// first layer has.
Frames frames_of(const std::vector<MeshModel*>& layers);

/// Throws Failure that says how the faces of `found` differ from those of `expected`.
void check_same_faces(const Frames& found, const std::string& found_name, const Frames& expected,
                      const std::string& expected_name);

/// True where both have the same vertices and polygons, in one order.
bool have_same_faces(const Frames& a, const Frames& b);

/// The values as vertex quality, with its colours; -1 where there is none.
void show_values(MeshModel& layer, const std::vector<double>& values);

/// Regions as quality, each in a colour of its own; their vertices and the faces at them selected.
void show_regions(MeshModel& layer, const std::vector<double>& region);

/// A hidden new layer with the frame's positions on `base`, or of the frame's faces without one.
MeshModel& add_layer(MeshDocument& document, const std::string& label, const Frames& frames,
                     std::int64_t frame, MeshModel* base);

}  // namespace mimetra_meshlab
