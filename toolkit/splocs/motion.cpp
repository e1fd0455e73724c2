#include "toolkit/splocs/motion.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "toolkit/mesh/diameter.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/parallel.h"
#include "toolkit/mesh/text.h"

namespace mimetra {
namespace {

/// Of a frame's displacement coordinates, in some vertices: one column each.
enum SpreadColumn {
  kMean,
  kSquares,   ///< sum of squared differences from the mean
  kFurthest,  ///< length of the longest displacement
  kCount,     ///< how many coordinates
  kInfinite,  ///< 1 where a coordinate is not a finite number, else 0
  kSpreadColumns
};

/// The sum of squares of two sets about their common mean follows from both without cancellation.
///
/// [Chan, Golub, LeVeque. Updating Formulae and a Pairwise Algorithm for Computing Sample
/// Variances. COMPSTAT 1982]
void join_spreads(Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  const Eigen::ArrayXd both = left.col(kCount) + right.col(kCount);
  const Eigen::ArrayXd difference = right.col(kMean) - left.col(kMean);
  const Eigen::ArrayXd share = right.col(kCount).array() / both;
  left.col(kSquares).array() +=
      right.col(kSquares).array() + difference.square() * share * left.col(kCount).array();
  left.col(kMean).array() += difference * share;
  left.col(kFurthest) = left.col(kFurthest).cwiseMax(right.col(kFurthest));
  left.col(kCount) = both;
  left.col(kInfinite) = left.col(kInfinite).cwiseMax(right.col(kInfinite));
}

/// Of the displacements of a block (F x 3m).
Eigen::MatrixXd spreads_of(const VertexBlocks<double>::Block& displacements) {
  Eigen::MatrixXd spreads(displacements.rows(), kSpreadColumns);
  for (Eigen::Index f = 0; f < displacements.rows(); ++f) {
    const auto row = displacements.row(f).array();
    const double mean = row.mean(), squares = (row - mean).square().sum();
    const Eigen::Index m = row.size() / 3;
    const double furthest2 =
        (row.segment(0, m).square() + row.segment(m, m).square() + row.segment(2 * m, m).square())
            .maxCoeff();
    const bool infinite = !std::isfinite(squares) && !row.allFinite();
    spreads.row(f) << mean, squares, std::sqrt(furthest2), static_cast<double>(row.size()),
        infinite ? 1.0 : 0.0;
  }
  return spreads;
}

/// The spread of each frame over the mesh (F x kSpreadColumns), on all ranks.
Eigen::MatrixXd spreads_of(const BlockSource<double>& X, const Reduction& reduction) {
  const auto of_run = [&](int run, Eigen::MatrixXd& spreads) {
    const IndexRange blocks = reduction.part().blocks_of(run);
    spreads = spreads_of(*X.block(blocks.first));
    for (int b = blocks.first + 1; b < blocks.end; ++b) {
      join_spreads(spreads, spreads_of(*X.block(b)));
    }
  };
  return reduction.everywhere(reduction.joined(X.rows(), kSpreadColumns, of_run, join_spreads));
}

void require_finite(const Eigen::MatrixXd& spreads) {
  for (Eigen::Index f = 0; f < spreads.rows(); ++f) {
    if (std::isfinite(spreads(f, kSquares))) continue;
    throw std::invalid_argument(
        "frame " + std::to_string(f) +
        (spreads(f, kInfinite) == 0
             ? " is so far from the rest pose that its energy is not a finite number"
             : " has a coordinate that is not a finite number"));
  }
}

/// \pre finite spreads
void require_motion(const Positions& rest, const Eigen::MatrixXd& spreads) {
  const double furthest = spreads.col(kFurthest).maxCoeff();
  const double size = diameter(rest);
  if (furthest > kLeastMotion * size) return;
  std::string found =
      "nothing moves: all " + std::to_string(spreads.rows()) + " frames are the rest pose";
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

}  // namespace

Motion scaled_motion(const SequencePart& sequence, MotionScale unit, const Reduction& reduction,
                     MotionPlace place) {
  const VertexPart& part = reduction.part();
  std::unique_ptr<KeptBlocks<double>> kept;
  if (place != MotionPlace::sequence) {
    kept = kept_displacements(sequence, part, place, reduction.context());
  }
  const Eigen::MatrixXd spreads =
      kept ? spreads_of(*kept, reduction) : spreads_of(SequenceBlocks(sequence, part), reduction);
  require_finite(spreads);
  require_motion(sequence.rest, spreads);
  const auto coordinates = static_cast<double>(sequence.rest.size());
  const auto frames = static_cast<double>(spreads.rows());
  double mean = 0;
  for (const double of_frame : spreads.col(kMean)) mean += of_frame / frames;
  double squares = 0;
  for (const auto& spread : spreads.rowwise()) {
    squares += spread[kSquares] + coordinates * (spread[kMean] - mean) * (spread[kMean] - mean);
  }
  const double variance = squares / coordinates / frames;
  const double scale = scale_of(unit, mean, variance);
  if (scale == 0) {
    throw MismatchError("nothing moves: all " + std::to_string(spreads.rows()) +
                        " frames are the rest pose, shifted by one amount along x, y and z");
  }
  const double norm2 = coordinates * frames * ((variance + mean * mean) / scale / scale);
  if (!std::isfinite(norm2)) {
    throw std::invalid_argument(
        "the frames are so far from the rest pose that their energy is not a finite number");
  }
  if (!kept) {
    return {std::make_unique<SequenceBlocks>(sequence, part, scale), nullptr, scale, norm2};
  }
  const auto divide = [&kept, scale](int b) {
    kept->change(b, [scale](KeptBlocks<double>::Block& block) { block /= scale; });
  };
  parallel_for(kept->count(), divide, reduction.context());
  KeptBlocks<double>* const blocks = kept.get();
  return {std::move(kept), blocks, scale, norm2};
}

}  // namespace mimetra
