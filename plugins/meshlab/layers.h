#pragma once

#include <string>
#include <vector>

#include <common/meshmodel.h>

#include "plugins/meshlab/toolkit.h"

/// Conversion of MeshLab's layers to sequences and of results to layers.
namespace mimetra_meshlab {

/// Visible layers in order, without `left_out`. Removes deleted elements from them.
std::vector<MeshModel*> visible_layers(MeshDocument& document, const MeshModel* left_out = nullptr);

/// Makes one frame of each layer and applies the layers' matrices. Triangles that MeshLab joins to
/// polygons become polygons. Throws Failure that names the first layer without faces, or with other
/// faces than the first layer.
Frames frames_of(const std::vector<MeshModel*>& layers);

/// Throws Failure that says how the faces of `found` differ from the faces of `expected`.
void check_same_faces(const Frames& found, const std::string& found_name, const Frames& expected,
                      const std::string& expected_name);

/// True if both have the same number of vertices and the same polygons in the same order.
bool have_same_faces(const Frames& a, const Frames& b);

/// Shows values as vertex quality and colours; values that are not finite become -1.
void show_values(MeshModel& layer, const std::vector<double>& values);

/// Shows regions as quality with one colour a region, and selects their vertices and faces.
void show_regions(MeshModel& layer, const std::vector<double>& region);

/// Adds a hidden layer with the positions of a frame and the faces of `base`, or else of `frames`.
MeshModel& add_layer(MeshDocument& document, const std::string& label, const Frames& frames,
                     std::int64_t frame, MeshModel* base);

}  // namespace mimetra_meshlab
