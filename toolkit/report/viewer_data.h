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

/// Poses as whole numbers of steps from a centre.
struct QuantizedPoses {
  Eigen::RowVector3d center;  ///< of the rest pose's bounding box
  double step = 0;            ///< length; every coordinate is off by half of it at most
  StepMatrix poses;           ///< the pose at rest, then the frames, 1 + F x 3N
};

QuantizedPoses quantized(const MeshSequence& sequence, const std::vector<int>& frames);

/// Poses as mixtures of few. In steps from the centre, coordinate i of frame f is
///
///     rest_i / kStepsOfRest + basis_step / kWeightOfOne sum_k weights_fk basis_ki
///
/// and what a correction adds to it, where the sum is off by more than a step.
struct MixedPoses {
  static constexpr int kStepsOfRest = 8;
  static constexpr int kWeightOfOne = 32767;

  struct Correction {
    int frame, coordinate, steps;
  };

  Eigen::RowVector3d center;            ///< of the rest pose's bounding box
  double step = 0;                      ///< length; every coordinate is off by one of it at most
  StepMatrix rest;                      ///< 1 x 3N
  double basis_step = 0;                ///< in steps
  StepMatrix basis;                     ///< R x 3N
  StepMatrix weights;                   ///< F x R
  std::vector<Correction> corrections;  ///< by frame, then by coordinate
};

/// Finds a few poses that mix to the frames. Returns nothing if an error of at most a
/// fourth of a step (root mean square) takes more than `most` poses, or more than half as many as
/// there are frames. Throws Cancelled.
std::optional<MixedPoses> mixed(const MeshSequence& sequence, const std::vector<int>& frames,
                                Eigen::Index most, const Context& context = {});

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

/// Bytes as base64.
std::string base64(std::string_view bytes);

/// The 3D viewer of reports: JavaScript with all that it needs, and nothing that could end its
/// script element. Empty in a build without npm.
std::string_view viewer_script();

}  // namespace mimetra
