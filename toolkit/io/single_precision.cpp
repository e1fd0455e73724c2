#include "toolkit/io/single_precision.h"

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace fs = std::filesystem;

std::string beyond_single(Eigen::Index vertex, double coordinate) {
  return "vertex " + std::to_string(vertex) + " is at " + readable(coordinate) +
         ", and single precision ends at " + readable(kLargestSingle) +
         "; write double precision (.npy without option 'single', or .ply with option 'double'), "
         "or scale it";
}

bool needs_double(const PositionsView& poses, double extent) {
  constexpr double kRounding = 6e-8;     // relative rounding of float32
  constexpr double kMostRounded = 1e-5;  // relative to the longest side; well below what is visible
  const double farthest = poses.cwiseAbs().maxCoeff();
  return farthest > kLargestSingle || kRounding * farthest > kMostRounded * extent;
}

void check_single_range(const fs::path& target, int first, const Frames& poses) {
  Eigen::Index row = 0, column = 0;
  const double farthest = poses.cwiseAbs().maxCoeff(&row, &column);
  if (farthest <= kLargestSingle) return;
  throw MismatchError(target.string() + ": frame " + std::to_string(first + row) + ": " +
                      beyond_single(column / 3, farthest));
}

void check_single_precision(const fs::path& target, const PositionsView& poses, double extent,
                            SinglePrecision why) {
  if (!needs_double(poses, extent)) return;
  const bool is_asked = why == SinglePrecision::asked;
  throw MismatchError(
      target.string() + ": " +
      (is_asked ? "option 'single'"
                : target.extension().string() + " holds single precision only, which") +
      " would round motion that one sees: the mesh lies " +
      readable(poses.cwiseAbs().maxCoeff() / extent, 2) + " times its size from the origin; " +
      (is_asked ? "leave the option out, or move it" : "move it, or write .npy"));
}

}  // namespace mimetra
