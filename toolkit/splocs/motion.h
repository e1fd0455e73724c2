#pragma once

#include "toolkit/splocs/decomposition_options.h"
#include "toolkit/splocs/motion_blocks.h"
#include "toolkit/splocs/reduction.h"

namespace mimetra {

/// A sequence's displacements from its rest pose, divided by their scale.
struct Motion {
  std::unique_ptr<BlockSource<double>> X;  ///< F x 3n
  KeptBlocks<double>* kept = nullptr;      ///< X where its blocks are kept
  double scale = 1;                        ///< in units of the mesh
  double norm2 = 0;                        ///< ||X||_F^2 over the whole mesh
};

/// Throws MismatchError where no vertex is further than kLeastMotion of the diameter from the
/// rest pose in any frame, std::invalid_argument that names the first frame with a coordinate that
/// is not finite; on every rank the same. Throws what reading throws, OutputError. With
/// MotionPlace::sequence the sequence outlives it.
Motion scaled_motion(const SequencePart& sequence, MotionScale scale, const Reduction& reduction,
                     MotionPlace place = MotionPlace::memory);

}  // namespace mimetra
