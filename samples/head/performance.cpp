#include "samples/head/head.h"

#include <algorithm>

#include "samples/head/curves.h"

namespace mimetra::samples {
namespace {

constexpr int kFrames = 120;
constexpr double kFramesPerSecond = 30;

/// An expression that comes, stays and goes, in frames.
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
