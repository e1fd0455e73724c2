#pragma once

#include <memory>
#include <vector>

#include "toolkit/mesh/frame_source.h"
#include "toolkit/mesh/option.h"

namespace mimetra {

struct SimplifyOptions {
  /// Share of the vertices that are kept, in (0, 1].
  double share = 0.25;

  static constexpr Option kShare{"share", &SimplifyOptions::share, {.minimum = 1e-6, .maximum = 1}};
  static constexpr auto declared() { return std::tuple(kShare); }
};

/// A sequence's mesh with fewer vertices, which keep their places.
struct Simplification {
  /// Kept vertices in the given mesh's numbering, ascending.
  std::vector<VertexIndex> vertices;
  /// Triangles on the kept vertices, with the given texture coordinates, groups and materials.
  std::shared_ptr<const Connectivity> connectivity;
  /// Number of vertices that must be kept. They are on texture seams, share a place, are not
  /// manifold, or have no triangle.
  int locked = 0;
  /// Number of triangles that collapses have turned over in some frame despite the retries.
  int folded = 0;
};

/// Removes vertices by half-edge collapses, each of one vertex onto a neighbour, in OpenMesh's
/// decimater.
///
/// The cheapest collapse goes first. Its cost is the sum of squared distances to the planes of the
/// triangles that it replaces. The sum covers the rest pose and the most different frames. Moving
/// parts therefore keep more vertices. In these poses, no collapse turns a triangle against the
/// surface; none makes a sliver at rest.
///
/// If a triangle of the finished mesh is turned over in any frame, the mesh is made again, at most
/// twice. Those frames then join the poses, and the vertices around the triangle are locked.
///
/// The result has more vertices than requested if no further collapse is allowed. Throws
/// std::invalid_argument for options out of range, whatever reading throws, and Cancelled.
///
/// [Garland, Heckbert. Surface simplification using quadric error metrics. SIGGRAPH 1997;
///  Mohr, Gleicher. Deformation sensitive decimation. 2003]
Simplification simplify(const FrameSource& sequence, const SimplifyOptions& options = {},
                        const Context& context = {});

}  // namespace mimetra
