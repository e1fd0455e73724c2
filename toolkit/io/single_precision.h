#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "toolkit/mesh/frame_source.h"

/// Effect of single precision on positions.
namespace mimetra {

/// Largest finite number of single precision.
inline constexpr double kLargestSingle = std::numeric_limits<float>::max();
/// Message about a coordinate beyond that limit: "vertex 7 is at 1e+39, ...".
std::string beyond_single(Eigen::Index vertex, double coordinate);

/// True if single precision would round motion visibly or cannot hold a coordinate. This happens if
/// `poses` lie far from the origin relative to the mesh's longest side, `extent`.
bool needs_double(const PositionsView& poses, double extent);

/// Throws MismatchError with frame and vertex if single precision would make a coordinate infinite.
/// `poses` are the frames from `first` on.
void check_single_range(const std::filesystem::path& target, int first, const Frames& poses);
/// Whether the format has single precision only, or the user asked for it.
enum class SinglePrecision { only, asked };
/// Throws MismatchError if `target` has single precision but needs_double() is true.
void check_single_precision(const std::filesystem::path& target, const PositionsView& poses,
                            double extent, SinglePrecision why = SinglePrecision::only);

}  // namespace mimetra
