#include "toolkit/splocs/motion.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Mean of one frame's displacement coordinates, the sum of squared differences from it, and the
/// length of the longest displacement.
struct FrameSpread {
  double mean = 0;
  double squares = 0;
  double furthest = 0;
};

std::vector<FrameSpread> spreads(const MeshSequence& sequence, int threads) {
  const Eigen::Map<const Eigen::RowVectorXd> rest(sequence.rest().data(), sequence.rest().size());
  std::vector<FrameSpread> spreads(sequence.frames());
  parallel_for(sequence.frames(), threads, [&](int f) {
    const Eigen::RowVectorXd displacement = sequence.positions().row(f) - rest;
    const double mean = displacement.mean();
    const PositionsView of_vertices(displacement.data(), sequence.vertices(), 3);
    spreads[f] = {mean, (displacement.array() - mean).square().sum(),
                  std::sqrt(of_vertices.rowwise().squaredNorm().maxCoeff())};
  });
  return spreads;
}

void require_finite(const MeshSequence& sequence, const std::vector<FrameSpread>& spreads) {
  for (int f = 0; f < sequence.frames(); ++f) {
    if (std::isfinite(spreads[f].squares)) continue;
    const bool overflow = sequence.positions().row(f).allFinite();
    throw std::invalid_argument(
        "frame " + std::to_string(f) +
        (overflow ? " is so far from the rest pose that its energy is not a finite number"
                  : " has a coordinate that is not a finite number"));
  }
}

/// \pre finite spreads
void require_motion(const MeshSequence& sequence, const std::vector<FrameSpread>& spreads) {
  const double furthest = std::ranges::max(spreads, {}, &FrameSpread::furthest).furthest;
  const double size = sequence.diameter();
  if (furthest > kLeastMotion * size) return;
  std::string found =
      "nothing moves: all " + std::to_string(sequence.frames()) + " frames are the rest pose";
  if (furthest > 0) {
    found += " to " + readable(furthest) + ", " + readable(furthest / size) + " of its diameter";
  }
  throw MismatchError(found + "; expected motion above " + readable(kLeastMotion) +
                      " of its diameter, " + readable(size) +
                      ": give frames that deform (head motion that is taken out is none)");
}

/// Of displacement coordinates with this mean and variance.
double scale_of(MotionScale unit, double mean, double variance) {
  switch (unit) {
    case MotionScale::root_mean_square:
      return std::sqrt(variance + mean * mean);
    case MotionScale::standard_deviation:
      break;
  }
  return std::sqrt(variance);
}

VertexBlocks<double> scaled_blocks(const MeshSequence& sequence, double scale, int threads) {
  VertexBlocks<double> X(sequence.frames(), sequence.vertices());
  parallel_for(X.count(), threads, [&](int b) {
    X[b].resize(X.rows(), 3 * X.size(b));
    const auto rest = sequence.rest().middleRows(X.first(b), X.size(b));
    for (int f = 0; f < sequence.frames(); ++f) {
      VertexBlocks<double>::by_vertex(X[b], f) =
          (sequence.frame(f).middleRows(X.first(b), X.size(b)) - rest) / scale;
    }
  });
  return X;
}

}  // namespace

Motion scaled_motion(const MeshSequence& sequence, MotionScale unit, int threads) {
  const std::vector<FrameSpread> of_frames = spreads(sequence, threads);
  require_finite(sequence, of_frames);
  require_motion(sequence, of_frames);
  const auto coordinates = static_cast<double>(sequence.rest().size());
  double mean = 0;
  for (const FrameSpread& spread : of_frames) mean += spread.mean / sequence.frames();
  double squares = 0;
  for (const FrameSpread& spread : of_frames) {
    squares += spread.squares + coordinates * (spread.mean - mean) * (spread.mean - mean);
  }
  const double variance = squares / coordinates / sequence.frames();
  const double scale = scale_of(unit, mean, variance);
  if (scale == 0) {
    throw MismatchError("nothing moves: all " + std::to_string(sequence.frames()) +
                        " frames are the rest pose, shifted by one amount along x, y and z");
  }
  const double norm2 = coordinates * sequence.frames() * ((variance + mean * mean) / scale / scale);
  if (!std::isfinite(norm2)) {
    throw std::invalid_argument(
        "the frames are so far from the rest pose that their energy is not a finite number");
  }
  return {scaled_blocks(sequence, scale, threads), scale, norm2};
}

}  // namespace mimetra
