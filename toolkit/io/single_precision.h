#pragma once

#include <filesystem>
#include <limits>
#include <string>

#include "toolkit/mesh/frame_source.h"

/// What float32 makes of positions. Internal to the formats.
namespace mimetra {

/// The largest number of single precision.
constexpr double kLargestSingle = std::numeric_limits<float>::max();
/// "vertex 7 is at 1e+39, ...": what is wrong with a coordinate beyond it.
std::string beyond_single(Eigen::Index vertex, double coordinate);

/// True where single precision would round motion away, or cannot hold a coordinate: `poses` lie
/// far from the origin for a mesh whose longest side is `extent`.
bool needs_double(const PositionsView& poses, double extent);

/// Throws MismatchError that names frame and vertex where single precision would make a coordinate
/// infinite. `poses` are the frames from `first` on.
void check_single_range(const std::filesystem::path& target, int first, const Frames& poses);
/// Whether a format knows nothing else, or was asked for it.
enum class SinglePrecision { only, asked };
/// Throws MismatchError where a `target` in single precision needs_double().
void check_single_precision(const std::filesystem::path& target, const PositionsView& poses,
                            double extent, SinglePrecision why = SinglePrecision::only);

}  // namespace mimetra
