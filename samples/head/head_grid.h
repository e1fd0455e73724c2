#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra::samples {

/// Rows of the skull's surface at which it is cut open, in the parameter `v` of `HeadVertex`.
constexpr double kEyeRow = 5;
constexpr double kMouthRow = 7;
/// Rings behind the lips; the last one closes the pocket.
constexpr int kMouthRings = 5;
/// Teeth on either side of each jaw.
constexpr int kTeeth = 6;
/// Points around a tooth and its gum, see `HeadVertex`.
constexpr int kToothPoints = 9;
/// Vertices around an eyeball and the tongue.
constexpr int kBallColumns = 12;

/// Where a vertex of the sample lies, in the terms of the formulas that place it.
struct HeadVertex {
  enum class Part {
    skin,     ///< on the surface: `u`, `v`
    mouth,    ///< behind the lips: ring `ring` (1, 2, ...) behind the skin vertex `source`
    eyelid,   ///< behind an eyelid, likewise
    eyeball,  ///< `u` around the line of sight, `v` from the pupil (0) to the back (1)
    /// `u` along the jaw in teeth from its middle, whole between two of them and beyond kTeeth past
    /// the last; `v` the point around them, from the edge in front over the gum to the edge behind
    teeth,
    tongue,  ///< `u` around its length, `v` from the tip (0) to the root (1)
  };
  Part part = Part::skin;
  /// Around the head: 0 at the middle of the face, 1 and -1 at the ears (1 on the head's own left),
  /// 2 at the back.
  double u = 0;
  /// Down the head: 0 at the crown, kEyeRow, kMouthRow, 12 at the neck's end.
  double v = 0;
  /// Above (1) or below (-1) the cut of its row, of the upper or the lower jaw; 0 for all else.
  int rim = 0;
  VertexIndex source = -1;
  int ring = 0;
  /// 1 for the head's left eye, -1 for its right one, 0 for all else.
  int eye = 0;
};

/// The sample's vertices and faces: a grid of quadrilaterals around the head, cut open along the
/// mouth and the eyes, with a pocket behind the lips, rims behind the lids, two eyeballs, the teeth
/// of both jaws, a piece each, and a tongue. Mirror symmetric in its vertices.
struct HeadGrid {
  std::vector<HeadVertex> vertices;
  Polygons faces;
};

HeadGrid head_grid();

}  // namespace mimetra::samples
