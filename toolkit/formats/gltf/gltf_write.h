#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "toolkit/io/format.h"
#include "toolkit/io/weight_track.h"
#include "toolkit/mesh/context.h"
#include "toolkit/model/animation.h"
#include "toolkit/model/blendshape_model.h"

/// Writes glTF 2.0 in single precision: a .glb, or a .gltf with NAME.bin beside it. Polygons become
/// triangles in the order from which FB_ngon_encoding restores them.
namespace mimetra {

/// Most frames of a sequence that is not an Animation. Each frame is a morph target with a weight
/// in every frame.
constexpr int kMostGltfFrames = 1000;

/// Writes any sequence: its rest pose, a morph target for each frame, and weights that show one
/// frame after the other. Throws OutputError. Throws MismatchError for more than kMostGltfFrames
/// frames, and for times below 0 or too close for single precision. Also throws it for poses too
/// far from the origin for single precision, and for a .glb of more than 4 GB.
std::unique_ptr<FrameSink> begin_gltf(const SequenceHeader& header,
                                      const std::filesystem::path& target,
                                      const WriteOptions& options, const Context& context = {});

/// Writes a model and its weights over time. Throws as begin_gltf(), and Cancelled.
std::vector<std::filesystem::path> write_gltf(const Animation& animation,
                                              const std::filesystem::path& target,
                                              const WriteOptions& options,
                                              const Context& context = {});

/// Writes a model with its expressions, and weights over time if `performance` has names. Throws as
/// write_gltf(), and MismatchError for a model with identities, which glTF cannot store.
std::vector<std::filesystem::path> write_gltf_model(const MorphableModel& model,
                                                    const WeightTrack& performance,
                                                    const std::filesystem::path& target,
                                                    const WriteOptions& options,
                                                    const Context& context = {});

}  // namespace mimetra
