#pragma once

#include <memory>

#include "toolkit/splocs/decomposition_options.h"
#include "toolkit/splocs/decomposition_plan.h"
#include "toolkit/splocs/reduction.h"
#include "toolkit/splocs/vertex_blocks.h"

namespace mimetra {

/// Blocks with memory, or in a file. \pre the place is one of the two
template <typename Scalar>
std::unique_ptr<KeptBlocks<Scalar>> kept_blocks(MotionPlace place, Eigen::Index rows,
                                                const VertexPart& part);

/// Displacements of a part of a sequence from its rest pose, divided by `scale` (F x 3n), read anew
/// for each use. The sequence outlives them.
std::unique_ptr<BlockSource<double>> read_displacements(const SequencePart& sequence,
                                                        const VertexPart& part, double scale = 1);

/// The displacements as they are (F x 3n), read once and kept. Throws what reading throws,
/// OutputError. \pre as kept_blocks()
std::unique_ptr<KeptBlocks<double>> kept_displacements(const SequencePart& sequence,
                                                       const VertexPart& part, MotionPlace place,
                                                       const Context& = {});

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
