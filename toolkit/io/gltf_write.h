#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "toolkit/io/sequence_format.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/animation.h"
#include "toolkit/model/blendshape_model.h"

/// Writing glTF 2.0: a .glb, or a .gltf with NAME.bin beside it, in single precision. Polygons are
/// triangulated, in the order by which FB_ngon_encoding finds them again.
namespace mimetra {

/// Most frames of a sequence that is no Animation: each is a target, which every frame weighs.
constexpr int kMostGltfFrames = 1000;

/// A sequence of any kind: its rest pose, a morph target for each frame, and weights that show one
/// after the other. Throws OutputError; MismatchError for more than kMostGltfFrames, times below 0
/// or too close for single precision, and poses too far from the origin for it.
std::unique_ptr<FrameSink> begin_gltf(const SequenceHeader& header,
                                      const std::filesystem::path& target,
                                      const SequenceWriteOptions& options, const ExtraFiles& extra,
                                      const Context& context = {});

/// A model and its weights over time. Throws the same, and Cancelled.
std::vector<std::filesystem::path> write_gltf(const Animation& animation,
                                              const std::filesystem::path& target,
                                              const SequenceWriteOptions& options,
                                              const ExtraFiles& extra, const Context& context = {});

/// A model with its expressions, and weights over time where `performance` has names. Throws the
/// same; MismatchError for a model with identities, for which glTF has no place.
std::vector<std::filesystem::path> write_gltf_model(const MorphableModel& model,
                                                    const WeightTrack& performance,
                                                    const std::filesystem::path& target,
                                                    const SequenceWriteOptions& options,
                                                    const ExtraFiles& extra,
                                                    const Context& context = {});

}  // namespace mimetra
