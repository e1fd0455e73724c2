#pragma once

#include <vector>

#include "tests/bench/subjects.h"
#include "tests/bench/suite.h"

namespace mimetra::bench {

constexpr const char* kBlendshapeSetup = "eq. 10 set-up: Gram matrix";
constexpr const char* kBlendshapeWeights = "eq. 10 transfer";
constexpr const char* kVertexSetup = "vertex space set-up: factor";
constexpr const char* kVertexFrames = "vertex space transfer";

/// Blendshape weights on `share` of the target's triangles: set-up, all frames, and the two halves
/// of a frame where `with_halves`.
std::vector<Row> blendshape_rows(const Subject& subject, double share, bool with_halves,
                                 const Settings& settings);

/// The right-hand sides of eq. 11 over all triangles and frames, on one thread.
std::vector<Case> right_hand_side_cases(const Subject& subject);

/// Vertex space over all triangles: set-up and all frames.
std::vector<Row> vertex_rows(const Subject& subject, const Settings& settings);

}  // namespace mimetra::bench
