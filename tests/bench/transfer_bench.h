#pragma once

#include <vector>

#include "subjects.h"
#include "suite.h"

namespace mimetra::bench {

constexpr const char* kBlendshapeSetup = "eq. 10 Gram matrix and folding";
constexpr const char* kBlendshapeWeights = "eq. 10 transfer";
constexpr const char* kVertexSetup = "vertex space set-up: factor";
constexpr const char* kVertexFrames = "vertex space transfer";

/// Blendshape weights on `share` of the target's triangles: set-up, all frames, and the two halves
/// of a frame where `with_halves`.
std::vector<Row> blendshape_rows(const Subject& subject, double share, bool with_halves,
                                 const Settings& settings);

/// Vertex space over all triangles: set-up and all frames.
std::vector<Row> vertex_rows(const Subject& subject, const Settings& settings);

}  // namespace mimetra::bench
