#pragma once

#include "toolkit/splocs/decomposition_options.h"
#include "toolkit/splocs/reduction.h"

namespace mimetra {

/// Bytes per vertex for the factors of a mesh's sparse systems and its adjacency. Measured on faces
/// of 3000 to 7000 vertices, where fill-in grows little.
inline constexpr double kFactorsPerVertex = 2000;

/// Place of a motion's blocks between their uses.
enum class MotionPlace {
  memory,
  scratch,  ///< in an unnamed file in std::filesystem::temp_directory_path()
  sequence  ///< in the sequence: blocks are read and computed again
};

/// Plan of a decomposition that stays within the memory of its Context.
struct DecompositionPlan {
  MotionPlace place = MotionPlace::memory;
  /// Threads that work at a time, each on a block of 192 vertices over all frames; 0 for all
  /// threads.
  int threads = 0;
  /// Most poses among which a basis in time may be searched: half the frames, or as many as memory
  /// allows. 0 without a basis.
  Eigen::Index poses = 0;
  /// Peak memory besides the caller's: arrays that grow with frames, vertices, components or poses.
  /// A motion may need fewer poses.
  double bytes = 0;
  /// Bytes of the file.
  double scratch_bytes = 0;
};

/// Plans the decomposition of the rank's vertices (F x 3n) on a mesh of part.mesh_vertices()
/// vertices. The context gives the maximum number of threads and the memory.
///
/// Motion that does not fit in memory is kept in a file. It is read again from the sequence for
/// every pass instead if that is cheaper (docs/large-data.md) or if the disk has no room. This
/// needs double precision and a sequence that can read single vertices.
///
/// Throws MismatchError if a single thread needs more than the memory of the context.
DecompositionPlan planned_decomposition(const FrameSource& frames, const VertexPart& part,
                                        const DecompositionOptions& options, const Context& = {});

}  // namespace mimetra
