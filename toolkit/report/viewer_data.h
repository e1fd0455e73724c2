#pragma once

#include <string>
#include <vector>

#include "toolkit/drawing/viewpoint.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// A mesh that a report plays.
struct ViewerMesh {
  std::string role;  ///< "source" or "target"
  std::string name;
  MeshSequence sequence;
  std::vector<int> regions;  ///< strongest region of each vertex (N), -1 outside
};

/// What a report plays: meshes with the times of the first, whose regions have one colour in all.
struct ViewerScene {
  std::vector<ViewerMesh> meshes;
  Viewpoint viewpoint = {.yaw = 0, .pitch = 0};
};

/// `count` of `frames` frames, evenly spread, the first and the last among them (all where there
/// are fewer). \pre count >= 2
std::vector<int> thinned(int frames, int count);

/// A scene as a report holds it.
struct PackedScene {
  std::string json;  ///< empty where not even two frames fit
  int frames = 0;
};

/// All frames, where the poses of each mesh are mixtures of few, to a step, that `bytes` hold;
/// otherwise as many as they hold, but not more than 30 a second.
PackedScene packed(const ViewerScene& scene, std::size_t bytes, const Context& context = {});

}  // namespace mimetra
