#pragma once

#include "toolkit/splocs/decomposition_options.h"
#include "toolkit/splocs/reduction.h"

namespace mimetra {

/// Bytes that the factors of a mesh's sparse systems and its adjacency take: measured on faces of 3
/// to 7 thousand vertices, where fill-in grows little.
inline constexpr double kFactorsPerVertex = 2000;

/// Where a motion's blocks are between their uses.
enum class MotionPlace {
  memory,
  scratch,  ///< in a file without a name, in std::filesystem::temp_directory_path()
  sequence  ///< where they came from: they are read and made anew
};

/// How a decomposition keeps within the memory of its Context.
struct DecompositionPlan {
  MotionPlace place = MotionPlace::memory;
  /// That work at a time, each on a block of 192 vertices over all frames; 0 for all there are.
  int threads = 0;
  /// Among which a basis in time may be looked for: half the frames, or what memory allows; 0 where
  /// none is wanted.
  Eigen::Index poses = 0;
  /// At the peak, besides what the caller holds: arrays that grow with frames, vertices, components
  /// or poses, of which a motion may need fewer.
  double bytes = 0;
  /// In the file.
  double scratch_bytes = 0;
};

/// For the poses of the vertices that a rank owns, F x 3n, on a mesh of part.mesh_vertices(). The
/// context gives the most threads and the memory. If the motion does not fit, it is read again for
/// every pass if that is cheaper than to write it once and read it from a file
/// (docs/large-data.md), or if the file's disk has no room. Otherwise it is kept in the file.
///
/// Throws MismatchError if one thread alone takes more than the memory of the context.
DecompositionPlan planned_decomposition(const FrameSource& frames, const VertexPart& part,
                                        const DecompositionOptions& options, const Context& = {});

}  // namespace mimetra
