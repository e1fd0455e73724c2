#pragma once

#include "toolkit/correspondence/pairing.h"
#include "toolkit/mesh/context.h"
#include "toolkit/mesh/weld.h"

namespace mimetra {

/// Vertices of a source farther apart than this share of its diameter have parted: above the noise
/// of a tracked scan (on one captured face, of a ten-thousandth, two sides of a seam were half of
/// it apart at most), well below an open mouth.
constexpr double kPartedShare = 1e-3;

/// Which vertices are one point of a surface that a source and a target of its connectivity share:
/// the two sides of a UV seam, but not lips that open. They are at the same place in one of the
/// rest poses, exactly, within kPartedShare of the other's diameter in that one, and of the lowest
/// of them in every frame of the source. Vertices that are at one place and no longer together
/// later are split as by staying_together(). Those of no triangle, or at a place where no triangle
/// of the target has area, are left alone.
///
/// `target_rest` N x 3. Frames are read in blocks, and only where vertices coincide at rest. Throws
/// MismatchError for another number of vertices, std::invalid_argument that names a vertex of a
/// rest pose which is not finite; what reading throws, Cancelled.
Weld closed_seams(const FrameSource& source, const Positions& target_rest,
                  const Context& context = {});

/// The same for a target of other faces (rest pose and triangles), which it shares with no source:
/// where numbers differ only, as if it did. Otherwise its vertices at one place are one where what
/// carries them is near along the source's surface, by about a triangle of either: duplicates of
/// flat shading are, lips are not, but at the corners of a mouth. A vertex without carriers goes
/// with those that it is at one place with. `source` is placed at the target.
Weld closed_seams(const FrameSource& source, const Positions& target_rest,
                  const Triangles& target_triangles, const Pairing& pairing,
                  const Context& context = {});

}  // namespace mimetra
