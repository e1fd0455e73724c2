#pragma once

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Distance, as a share of the source's diameter, beyond which two of its vertices have parted. It
/// is above the noise of a tracked scan and well below an open mouth. On one captured face with
/// noise of 1e-4, the sides of a seam were at most half of this share apart.
constexpr double kPartedShare = 1e-3;

/// Vertices that are one point of a surface, for a source and a target of the same connectivity.
/// The two sides of a UV seam are one point, but lips that open are not.
///
/// Welded vertices have exactly the same place in one of the two rest poses. In the other pose,
/// they are within kPartedShare of that mesh's diameter. In every frame of the source, each is
/// within kPartedShare of the source's diameter from the lowest of them. Vertices that part later
/// are split as by staying_together(). Vertices without a triangle are left alone, and so are
/// places where no triangle of the target has area.
///
/// `target_rest` is N x 3. Frames are read in blocks, and only if vertices coincide at rest. Throws
/// MismatchError if the numbers of vertices differ. Throws std::invalid_argument if a vertex of a
/// rest pose is not finite, and names it. Throws what reading throws, and Cancelled.
Weld closed_seams(const FrameSource& source, const Positions& target_rest,
                  const Context& context = {});

/// Vertices that are one point of a target with other faces than the source. If the meshes differ
/// only in their numbers (Pairing::is_one_to_one()), places are compared as above, with the places
/// of the carriers for the source. Otherwise, target vertices at one place are welded if their
/// carriers are near along the source's surface, within about a triangle of either mesh. This welds
/// the duplicates of flat shading. Of lips, it welds only the corners of a mouth. Vertices without
/// carriers follow the other vertices at their place.
///
/// `source` must lie over the target.
Weld closed_seams(const FrameSource& source, const Positions& target_rest,
                  const Triangles& target_triangles, const Pairing& pairing,
                  const Context& context = {});

}  // namespace mimetra
