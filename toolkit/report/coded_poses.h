#pragma once

#include <cstdint>
#include <optional>
#include <vector>

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

}  // namespace mimetra
