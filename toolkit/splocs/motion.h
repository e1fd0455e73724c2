#pragma once

#include <memory>

#include "toolkit/splocs/decomposition_options.h"
#include "toolkit/splocs/decomposition_plan.h"
#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

/// Blocks with memory allocated, or in a file. \pre `place` is memory or scratch
template <typename Scalar>
std::unique_ptr<KeptBlocks<Scalar>> kept_blocks(MotionPlace place, Eigen::Index rows,
                                                const VertexPart& part);

/// Displacements of a part of a sequence from its rest pose, divided by `scale` (F x 3n), read
/// again for each use. Keeps a reference to the sequence.
std::unique_ptr<BlockSource<double>> read_displacements(const SequencePart& sequence,
                                                        const VertexPart& part, double scale = 1);

/// Displacements (F x 3n) without scaling, read once and kept. Throws OutputError, and whatever
/// reading throws. \pre `place` is memory or scratch
std::unique_ptr<KeptBlocks<double>> kept_displacements(const SequencePart& sequence,
                                                       const VertexPart& part, MotionPlace place,
                                                       const Context& = {});

/// Displacements of a sequence from its rest pose, divided by their scale.
struct Motion {
  std::unique_ptr<BlockSource<double>> X;  ///< F x 3n
  KeptBlocks<double>* kept = nullptr;      ///< X if its blocks are kept, otherwise null
  double scale = 1;                        ///< in the unit of the mesh
  double norm2 = 0;                        ///< ||X||_F^2 over the whole mesh
};

/// Displacements of a sequence, scaled; MotionPlace::sequence keeps a reference to the sequence.
/// Throws MismatchError if no vertex is ever further than kLeastMotion of the diameter from the
/// rest pose, or if the scale is 0. Throws std::invalid_argument that names the first frame with a
/// coordinate or an energy that is not finite. Both are the same on every rank. Also throws
/// OutputError, and whatever reading throws.
Motion scaled_motion(const SequencePart& sequence, MotionScale scale, const Reduction& reduction,
                     MotionPlace place = MotionPlace::memory);

}  // namespace mimetra
