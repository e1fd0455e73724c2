#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace mimetra {

/// A grey picture: its pixels row after row, from the top left.
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

/// Landmarks of iBUG's scheme: 0 to 16 along the jaw, 17 to 26 brows, 27 to 35 nose, 36 to 47 eyes,
/// 48 to 67 lips.
constexpr int kFaceLandmarks = 68;

/// A face in a picture.
struct FoundFace {
  /// Columns and rows in pixels; 0, 0 is the middle of the pixel at the top left.
  Eigen::Matrix<double, kFaceLandmarks, 2> landmarks;
  /// In [0, 1); the larger, the more certainly it is a face.
  double confidence = 0;
};

/// Finds the most certain face of a picture that is upright, looks at the viewer and is 80 pixels
/// wide at least; none where there is none. Called from several threads.
using LandmarkFinder = std::function<std::optional<FoundFace>(const GreyImage&)>;

}  // namespace mimetra
