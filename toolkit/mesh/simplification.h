#pragma once

#include <memory>
#include <vector>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

struct SimplifyOptions {
  /// Of the vertices that are kept, in (0, 1].
  double share = 0.25;

  static constexpr Option kShare{"share", &SimplifyOptions::share, {.minimum = 1e-6, .maximum = 1}};
  static constexpr auto declared() { return std::tuple(kShare); }
};

/// A sequence's mesh with fewer vertices, which stay where they are.
struct Simplification {
  /// Those that are kept, ascending, in the given mesh's numbering.
  std::vector<VertexIndex> vertices;
  /// On these: triangles, with texture coordinates, groups and materials of the given ones.
  std::shared_ptr<const Connectivity> connectivity;
  /// Vertices that must be kept: on texture seams, where vertices lie at one place, where the mesh
  /// is no manifold, and those without a triangle.
  int locked = 0;
  /// Triangles that collapses have turned over in some frame, which is avoided where it can be.
  int folded = 0;
};

/// Fewer vertices by half-edge collapses, each of one vertex onto a neighbour, in OpenMesh's
/// decimater: the cheapest first by the distances to the planes of the triangles that went before,
/// summed over the rest pose and those frames that differ most, so that what moves keeps its
/// vertices. No collapse turns a triangle against the surface, or makes a sliver, in these poses;
/// where the finished mesh has a triangle that is turned over in any frame, it is made again with
/// such frames among the poses and the vertices around it locked, twice at most. It ends with more
/// vertices than asked for where no collapse is left. Throws std::invalid_argument for options out
/// of range, what reading throws, Cancelled.
///
/// [Garland, Heckbert. Surface simplification using quadric error metrics. SIGGRAPH 1997;
///  Mohr, Gleicher. Deformation sensitive decimation. 2003]
Simplification simplify(const FrameSource& sequence, const SimplifyOptions& options = {},
                        const Context& context = {});

}  // namespace mimetra
