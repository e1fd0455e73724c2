#pragma once

#include <string>
#include <vector>

#include "toolkit/mesh/frame_source.h"

namespace mimetra {

/// What the files of a format have a place for besides poses and triangles, declared once with the
/// format. What stands in files beside them (NAME.rest.ply, NAME.topology.ply) counts.
struct HeldParts {
  enum class Texture { none, vertices, corners };

  /// Faces of more than three corners.
  bool polygons = false;
  /// Texture coordinates: none, one for each vertex, or one for each corner of a face.
  Texture texture = Texture::none;
  /// Faces without texture coordinates where others have them.
  bool bare_faces = true;
  /// Groups, and which material a face has.
  bool groups = false;
  /// A rest pose that is no frame.
  bool rest = true;
  /// Vertices in their order; otherwise they are numbered anew.
  bool vertex_order = true;
  /// Times at all.
  bool times = true;
  /// Times that are not evenly apart, where other programs find them.
  bool uneven_times = true;
  /// Times as they are; otherwise in single precision.
  bool exact_times = true;
  /// Positions in double precision where single precision would round motion that one sees, or not
  /// at all there; otherwise rounded.
  bool exact_positions = true;

  bool operator==(const HeldParts&) const = default;
};

/// "polygons, UVs per corner, groups, rest pose": what `held` says, for lists of formats.
std::string description(const HeldParts& held);

/// What a format leaves out of a sequence, in words such as "texture coordinates"; none where it
/// holds all. Reads one frame where the rest pose may be equal to it.
std::vector<std::string> parts_left_out(const HeldParts& held, const FrameSource& sequence);

}  // namespace mimetra
