#pragma once

#include <string>
#include <vector>

#include "toolkit/model/blendshape_model.h"

namespace mimetra {

/// What names of left and right halves tell about the sides that they move.
struct ExchangedSides {
  /// Left halves whose pair (known_pairs()) moves the sides the other way round.
  std::vector<std::string> left_halves;
  /// Those are most of all: the face is its own mirror image, or "left" is the viewer's.
  bool everywhere = false;
};

/// Left is up x front: front is where the moving surface looks, whichever way its triangles are
/// wound, and up leads from the expressions that are named after the jaw, mouth, lips or chin to
/// those named after brows and eyes. Where names tell no up or no side is the front, left is where
/// most halves have it, and `everywhere` stays false. A half is where its squared motion is; pairs
/// closer together than 2 % of the face tell nothing (halves of two rigs are 9 % and more apart).
ExchangedSides exchanged_sides(const Positions& neutral, const Triangles& triangles,
                               const ShapeBasis& expressions);

}  // namespace mimetra
