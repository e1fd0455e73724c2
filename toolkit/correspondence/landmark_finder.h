#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// A grey picture with its pixels row by row, from the top left.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
  bool contains(int x, int y) const { return x >= 0 && x < width && y >= 0 && y < height; }
};

/// Number of landmarks in iBUG's scheme. The jaw has 0 to 16, the brows 17 to 26, the nose 27 to
/// 35. The eyes have 36 to 47, the lips 48 to 67.
constexpr int kFaceLandmarks = 68;

struct FoundFace {
  /// Columns and rows in pixels. (0, 0) is the middle of the top left pixel.
  Eigen::Matrix<double, kFaceLandmarks, 2> landmarks;
  /// Certainty that this is a face, in [0, 1).
  double confidence = 0;
};

/// Finds the most certain face of a picture, or nothing. The face must be upright, look at the
/// viewer and be at least 80 pixels wide. Several threads call it.
using LandmarkFinder = std::function<std::optional<FoundFace>(const GreyImage&)>;

}  // namespace mimetra
