#pragma once

namespace mimetra {

/// Numbers that differ by less than this share of themselves tie: rounding, which turning a mesh or
/// another order of its vertices changes, would decide between them.
constexpr double kNearTie = 1e-9;

}  // namespace mimetra
