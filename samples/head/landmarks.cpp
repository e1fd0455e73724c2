#include <algorithm>
#include <cmath>

#include "samples/head/features.h"
#include "samples/head/head.h"
#include "samples/head/head_shape.h"

namespace mimetra::samples {
namespace {

/// A landmark on the left side of the face, and that on the right side which mirrors it (the same
/// in the middle): iBUG's numbers, and where it is on the front of the rest pose, mm.
struct Place {
  int left;
  int right;
  double x;
  double y;
  double row = 0;  ///< that it lies on, or 0 for any
  int rim = 0;     ///< of that row
};

constexpr double kBetweenLips = kMouthHeight;

const Place kPlaces[] = {
    // Chin.
    {9, 9, 0, -107},
    // Eyebrows, from the nose outwards.
    {23, 22, 11, 20},
    {24, 21, 20, 23},
    {25, 20, 31, 25.5},
    {26, 19, 42, 24},
    {27, 18, 52, 17},
    // Nose: its ridge downwards, then its base outwards.
    {28, 28, 0, 2},
    {29, 29, 0, -11},
    {30, 30, 0, -24},
    {31, 31, 0, -35},
    {34, 34, 0, -48.5},
    {35, 33, 6.5, -47},
    {36, 32, 13, -43.5},
    // Eyes: the inner corner, along the upper lid to the outer one, and back.
    {43, 40, 17.5, -3, kEyeRow},
    {44, 39, 26, 4, kEyeRow, 1},
    {45, 38, 36, 4, kEyeRow, 1},
    {46, 37, 45, -4, kEyeRow},
    {47, 42, 36, -5, kEyeRow, -1},
    {48, 41, 26, -5, kEyeRow, -1},
    // Outline of the lips: the upper one from its middle to the corner, then the lower one back.
    {52, 52, 0, kBetweenLips + 5},
    {53, 51, 6, kBetweenLips + 6},
    {54, 50, 15, kBetweenLips + 4.5},
    {55, 49, kMouthHalfWidth, kBetweenLips, kMouthRow},
    {56, 60, 16, kBetweenLips - 7.5},
    {57, 59, 8, kBetweenLips - 10},
    {58, 58, 0, kBetweenLips - 10.5},
    // Between the lips, likewise.
    {63, 63, 0, kBetweenLips, kMouthRow, 1},
    {64, 62, 8, kBetweenLips, kMouthRow, 1},
    {65, 61, 21, kBetweenLips, kMouthRow, 1},
    {66, 68, 8, kBetweenLips, kMouthRow, -1},
    {67, 67, 0, kBetweenLips, kMouthRow, -1},
};

/// The skin vertex on the front of the face that is nearest to a place, on one side (1 the left).
VertexIndex nearest(const HeadGrid& grid, const Positions& rest, const Place& place, int side) {
  constexpr double kFront = 20;  // mm before the middle of the head
  double least = INFINITY;
  VertexIndex found = -1;
  for (std::size_t i = 0; i < grid.vertices.size(); ++i) {
    const HeadVertex& vertex = grid.vertices[i];
    const auto point = rest.row(static_cast<Eigen::Index>(i));
    if (vertex.part != HeadVertex::Part::skin || point.z() < kFront) continue;
    if (place.row != 0 && (vertex.v != place.row || vertex.rim != place.rim)) continue;
    const double distance = std::hypot(point.x() - side * place.x, point.y() - place.y);
    if (distance >= least) continue;
    least = distance;
    found = static_cast<VertexIndex>(i);
  }
  return found;
}

}  // namespace

std::vector<std::pair<int, VertexIndex>> head_landmarks() {
  const HeadGrid grid = head_grid();
  const Positions rest = head_positions(grid);
  std::vector<std::pair<int, VertexIndex>> landmarks;
  for (const Place& place : kPlaces) {
    landmarks.emplace_back(place.left, nearest(grid, rest, place, 1));
    if (place.right != place.left) {
      landmarks.emplace_back(place.right, nearest(grid, rest, place, -1));
    }
  }
  std::ranges::sort(landmarks);
  return landmarks;
}

}  // namespace mimetra::samples
