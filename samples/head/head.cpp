#include "samples/head/head.h"

#include <algorithm>
#include <cmath>

#include "samples/head/anatomy.h"
#include "samples/head/curves.h"
#include "samples/head/expressions.h"
#include "samples/head/head_shape.h"

namespace mimetra::samples {

MorphableModel parametric_head() {
  const HeadGrid grid = head_grid();
  const Positions mean = head_positions(grid);
  const auto connectivity = std::make_shared<const Connectivity>(
      Connectivity::from_polygons(static_cast<int>(grid.vertices.size()), grid.faces));
  return {connectivity, mean, head_identities(mean), head_expressions(grid)};
}

namespace {

/// A landmark on the left side of the face, its mirror image on the right, and their place. In the
/// middle, both have the same iBUG number. The place is on the front of the rest pose, in mm.
struct Place {
  int left;
  int right;
  double x;
  double y;
  double row = 0;  ///< row of the grid, or 0 for any
  int rim = 0;     ///< side of the cut in that row
};

const Place kPlaces[] = {
    // Chin.
    {9, 9, 0, -107},
    // Eyebrows, from the nose outwards.
    {23, 22, 11, 20},
    {24, 21, 20, 23},
    {25, 20, 31, 25.5},
    {26, 19, 42, 24},
    {27, 18, 52, 17},
    // Nose: down the ridge, then along the base outwards.
    {28, 28, 0, 2},
    {29, 29, 0, -11},
    {30, 30, 0, -24},
    {31, 31, 0, -35},
    {34, 34, 0, -48.5},
    {35, 33, 6.5, -47},
    {36, 32, 13, -43.5},
    // Eyes: from the inner corner along the upper lid to the outer corner, and back.
    {43, 40, 17.5, -3, kEyeRow},
    {44, 39, 26, 4, kEyeRow, 1},
    {45, 38, 36, 4, kEyeRow, 1},
    {46, 37, 45, -4, kEyeRow},
    {47, 42, 36, -5, kEyeRow, -1},
    {48, 41, 26, -5, kEyeRow, -1},
    // Outline of the lips: the upper lip from middle to corner, then the lower lip back.
    {52, 52, 0, kMouthHeight + 5},
    {53, 51, 6, kMouthHeight + 6},
    {54, 50, 15, kMouthHeight + 4.5},
    {55, 49, kMouthHalfWidth, kMouthHeight, kMouthRow},
    {56, 60, 16, kMouthHeight - 7.5},
    {57, 59, 8, kMouthHeight - 10},
    {58, 58, 0, kMouthHeight - 10.5},
    // Inner edge of the lips, in the same order.
    {63, 63, 0, kMouthHeight, kMouthRow, 1},
    {64, 62, 8, kMouthHeight, kMouthRow, 1},
    {65, 61, 21, kMouthHeight, kMouthRow, 1},
    {66, 68, 8, kMouthHeight, kMouthRow, -1},
    {67, 67, 0, kMouthHeight, kMouthRow, -1},
};

/// Skin vertex on the front of the face nearest to a place on one side (1 for left, -1 for right).
VertexIndex nearest(const HeadGrid& grid, const Positions& rest, const Place& place, int side) {
  constexpr double kFront = 20;  // least z of the front, mm
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

namespace {

constexpr int kFrames = 120;
constexpr double kFramesPerSecond = 30;

/// An expression that rises to a peak, holds and falls; times are in frames.
struct Action {
  const char* expression;
  double peak;
  int begin, full, release, end;
};

constexpr Action kActions[] = {
    // Talks: open and rounded vowels, with a frown of emphasis.
    {"jawOpen", 0.40, 4, 8, 8, 12},
    {"jawOpen", 0.22, 12, 15, 16, 20},
    {"mouthPucker", 0.70, 11, 16, 17, 23},
    {"jawOpen", 0.45, 21, 25, 26, 30},
    {"mouthSmileLeft", 0.35, 20, 25, 27, 32},
    {"mouthSmileRight", 0.35, 20, 25, 27, 32},
    {"jawOpen", 0.28, 30, 34, 35, 39},
    {"mouthPucker", 0.85, 30, 35, 36, 42},
    {"browDownLeft", 0.80, 26, 32, 38, 46},
    {"browDownRight", 0.80, 26, 32, 38, 46},
    {"jawOpen", 0.35, 40, 44, 44, 49},
    // Blinks, while talking and after the smile.
    {"eyeBlinkLeft", 1.00, 15, 18, 19, 23},
    {"eyeBlinkRight", 1.00, 15, 18, 19, 23},
    {"eyeBlinkLeft", 1.00, 75, 78, 79, 83},
    {"eyeBlinkRight", 1.00, 75, 78, 79, 83},
    // Smiles, the left half first.
    {"mouthSmileLeft", 1.00, 46, 55, 66, 78},
    {"mouthSmileRight", 0.90, 49, 58, 66, 78},
    {"eyeBlinkLeft", 0.20, 50, 57, 64, 72},
    {"eyeBlinkRight", 0.20, 50, 57, 64, 72},
    // Takes a breath and is surprised.
    {"cheekPuff", 0.70, 72, 78, 80, 85},
    {"jawOpen", 0.90, 83, 90, 99, 113},
    {"browInnerUp", 1.00, 82, 89, 101, 115},
    {"eyeWideLeft", 1.00, 83, 88, 100, 112},
    {"eyeWideRight", 1.00, 83, 88, 100, 112},
    {"mouthPucker", 0.35, 86, 92, 98, 108},
};

double strength(const Action& action, int frame) {
  const double rise = smooth_step((frame - action.begin) / double(action.full - action.begin));
  const double fall = smooth_step((frame - action.release) / double(action.end - action.release));
  return action.peak * std::min(rise, 1 - fall);
}

}  // namespace

WeightTrack parametric_performance() {
  WeightTrack track;
  track.names = parametric_head().expressions().names;
  track.weights = Eigen::MatrixXd::Zero(kFrames, static_cast<Eigen::Index>(track.names.size()));
  track.times = Eigen::VectorXd::LinSpaced(kFrames, 0, kFrames - 1) / kFramesPerSecond;
  for (const Action& action : kActions) {
    const auto found = std::find(track.names.begin(), track.names.end(), action.expression);
    const Eigen::Index column = found - track.names.begin();
    for (int f = 0; f < kFrames; ++f) {
      double& weight = track.weights(f, column);
      weight = std::max(weight, strength(action, f));
    }
  }
  return track;
}

}  // namespace mimetra::samples
