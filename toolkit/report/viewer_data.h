#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "toolkit/drawing/picture.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {

/// Coordinates are at most this many steps from the centre.
constexpr int kMostSteps = 4095;

using StepMatrix = Eigen::Matrix<std::int16_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Poses as integer steps from a centre.
struct QuantizedPoses {
  Eigen::RowVector3d center;  ///< centre of the rest pose's bounding box
  double step = 0;            ///< length; the largest error of a coordinate is half a step
  StepMatrix poses;           ///< rest pose, then the frames, (1 + F) x 3N
};

QuantizedPoses quantized(const MeshSequence& sequence, const std::vector<int>& frames);

/// Poses as mixtures of a few poses. In steps from the centre, coordinate i of frame f is
///
///   rest_i / kStepsOfRest + basis_step / kWeightOfOne sum_k weights_fk basis_ki
///
/// plus a correction if this sum is off by more than a step.
struct MixedPoses {
  static constexpr int kStepsOfRest = 8;
  static constexpr int kWeightOfOne = 32767;

  struct Correction {
    int frame, coordinate, steps;
  };

  Eigen::RowVector3d center;            ///< centre of the rest pose's bounding box
  double step = 0;                      ///< length; the largest error of a coordinate is one step
  StepMatrix rest;                      ///< 1 x 3N
  double basis_step = 0;                ///< in steps
  StepMatrix basis;                     ///< R x 3N
  StepMatrix weights;                   ///< F x R
  std::vector<Correction> corrections;  ///< by frame, then by coordinate
};

/// Finds a few poses whose mixtures give the frames with an error of at most a quarter of a step
/// (root mean square). Returns nullopt if that takes more than `most` poses, or more than half as
/// many as there are frames. Throws Cancelled.
std::optional<MixedPoses> mixed(const MeshSequence& sequence, const std::vector<int>& frames,
                                Eigen::Index most, const Context& context = {});

/// A mesh that the viewer plays.
struct ViewerMesh {
  std::string role;  ///< "source" or "target"
  std::string name;
  MeshSequence sequence;
  std::vector<int> regions;  ///< strongest region of each vertex (N), -1 outside
};

/// Contents of the viewer. Meshes share the times of the first, and regions have the same colour in
/// all of them.
struct ViewerScene {
  std::vector<ViewerMesh> meshes;
  Viewpoint viewpoint = {.yaw = 0, .pitch = 0};
};

/// `count` of `frames` frames, evenly spread, including the first and the last (all, if there are
/// fewer). \pre count >= 2
std::vector<int> thinned(int frames, int count);

/// A scene as the report contains it.
struct PackedScene {
  std::string json;  ///< empty if not even two frames fit
  int frames = 0;
};

/// Packs a scene into `bytes`. It packs all frames if mixtures of a few poses give each mesh's
/// poses to a step and fit. Otherwise it packs as many frames as fit, but not more than 30 a
/// second.
PackedScene packed(const ViewerScene& scene, std::size_t bytes, const Context& context = {});

/// Encodes bytes as base64.
std::string base64(std::string_view bytes);

/// Script of the reports' 3D viewer: JavaScript with all its dependencies, and without text that
/// could end its script element. Empty in a build without npm.
std::string_view viewer_script();

}  // namespace mimetra
