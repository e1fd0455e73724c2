#pragma once

#include <vector>

#include "toolkit/mesh/tri_mesh.h"

namespace mimetra::samples {

/// Rows at which the skull's surface is cut open, as `v` of HeadVertex.
constexpr double kEyeRow = 5;
constexpr double kMouthRow = 7;
/// Number of rings behind the lips; the last one closes the pocket.
constexpr int kMouthRings = 5;
/// Number of teeth on each side of a jaw.
constexpr int kTeeth = 6;
/// Number of points around a tooth and its gum; see HeadVertex.
constexpr int kToothPoints = 9;
/// Number of vertices around an eyeball and the tongue.
constexpr int kBallColumns = 12;

/// Parameters of a vertex for the formulas that place it.
struct HeadVertex {
  enum class Part {
    skin,     ///< on the surface, at `u` and `v`
    mouth,    ///< behind the lips, in ring `ring` (1, 2, ...) behind the skin vertex `source`
    eyelid,   ///< behind an eyelid, also with `ring` and `source`
    eyeball,  ///< `u` around the line of sight, `v` from the pupil (0) to the back (1)
    /// `u` counts teeth along the jaw from its middle. It is an integer between two teeth, and
    /// exceeds kTeeth behind the last one. `v` is the number of the point around the tooth, from
    /// the edge in front over the gum to the edge behind.
    teeth,
    tongue,  ///< `u` around its length, `v` from the tip (0) to the root (1)
  };
  Part part = Part::skin;
  /// Parameter around the head: 0 at the middle of the face, 1 at the left ear, -1 at the right
  /// ear, 2 at the back.
  double u = 0;
  /// Parameter down the head: 0 at the crown, kEyeRow, kMouthRow, 12 at the end of the neck.
  double v = 0;
  /// 1 above the cut of its row or on the upper jaw, -1 below the cut or on the lower jaw, else 0.
  int rim = 0;
  VertexIndex source = -1;
  int ring = 0;
  /// 1 for the head's left eye, -1 for its right eye, else 0.
  int eye = 0;
};

/// Vertices and faces of the sample, mirror symmetric: a grid of quadrilaterals around the head,
/// cut open along the mouth and the eyes. It has a pocket behind the lips, rims behind the lids and
/// two eyeballs. The teeth of each jaw are one piece; the tongue is another.
struct HeadGrid {
  std::vector<HeadVertex> vertices;
  Polygons faces;
};

HeadGrid head_grid();

}  // namespace mimetra::samples
